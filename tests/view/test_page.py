"""What is in the page, without a browser: test_in_browser.py looks at it in one."""

from __future__ import annotations

import base64
import http.client
import json
import re
import urllib.error
import urllib.request
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.view.document import page_document
from tamp.view.page import page, write_page
from tamp.view.server import PageServer
from tamp.view.story import PlanningSummary, planning_summary
from tamp.view.timeline import Timeline

VOID = {"meta", "link", "input", "br"}


class Reader(HTMLParser):
    """Checks that elements are closed in order, and collects the scripts and what is asked of the network."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.scripts: list[str] = []
        self.addresses: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.addresses += [value or "" for name, value in attrs if name in ("src", "href")]
        if tag not in VOID:
            self.open.append(tag)
        if tag == "script":
            self.scripts.append("")

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] == "script":
            self.scripts[-1] += data


def read(text: str) -> Reader:
    reader = Reader()
    reader.feed(text)
    reader.close()
    assert reader.open == []
    return reader


def test_the_page_is_whole_and_asks_for_nothing(document: dict[str, Any]) -> None:
    text = page(document)
    reader = read(text)
    assert text.startswith("<!DOCTYPE html>")
    assert reader.addresses == ["data:,"]
    assert "default-src 'none'" in text and not re.search(r"https?://", text)
    data, script = reader.scripts
    assert json.loads(data) == json.loads(json.dumps(document))
    assert "class Drawer" in script
    assert not re.findall(r"@[A-Z]+@", text)


def test_the_page_is_small(document: dict[str, Any]) -> None:
    assert len(page(document)) < 1_500_000  # four_objects takes 0.9 MB of the 5 that it may


def test_names_cannot_leave_their_place(timeline: Timeline) -> None:
    evil = '</script><script>alert("1")</script><!--'
    scene = replace(timeline.scene, name=evil)
    text = page(page_document(replace(timeline, scene=scene), PlanningSummary(evil)))
    reader = read(text)
    assert len(reader.scripts) == 2
    assert json.loads(reader.scripts[0])["title"] == evil


def unpacked(text: str, kind: str) -> np.ndarray:
    return np.frombuffer(base64.b64decode(text), dtype=kind)


def test_motion_and_shapes_survive_the_packing(
    document: dict[str, Any], timeline: Timeline
) -> None:
    assert unpacked(document["times"], "<f4") == pytest.approx(timeline.times, abs=1e-5)
    assert unpacked(document["rows"], "<f4").reshape(-1, 11) == pytest.approx(
        timeline.rows, abs=1e-5
    )
    can = next(body for body in document["bodies"] if body["name"] == "soup_can")
    (mesh,) = can["meshes"]
    grid = unpacked(mesh["vertices"], "<u2").reshape(-1, 3)
    vertices = np.array(mesh["low"]) + grid * np.array(mesh["step"])
    shape = timeline.scene.bodies["soup_can"].parts[0].shape
    height = vertices[:, 2].max() - vertices[:, 2].min()
    assert height == pytest.approx(getattr(shape, "height"), abs=1e-5)  # noqa: B009
    assert unpacked(mesh["faces"], "<u4").max() == len(vertices) - 1
    assert [stay["held"] for stay in can["stays"]] == [False, True, False]
    assert [action["text"] for action in document["actions"]][1] == "pick soup_can from table"


def test_the_story_tells_streams_skeletons_and_time(document: dict[str, Any]) -> None:
    story = document["story"]
    assert re.match(r"4 actions, \d+\.\d s of motion, found in \d+\.\d\d s · seed 0", story["head"])
    assert story["skeletons"][-1]["text"] == "4 actions: became the plan"
    assert story["skeletons"][-1]["lines"][1] == "2. pick soup_can"
    rows = {row[0]: row for row in story["streams"]}
    _, _, calls, share, seconds = rows["inverse-kinematics"]
    assert int(calls) > 0 and share.endswith("%") and seconds.endswith(" s")
    assert [row[0] for row in story["time"]] == [
        "total",
        "search",
        "timing",
        "explaining",
        "other tries",
    ]
    assert re.fullmatch(r"1 skeleton · \d+ search(es)? · \d+ states expanded", story["search"])


@pytest.mark.parametrize(
    "spoil",
    [
        lambda plan: plan.update(statistics=3),
        lambda plan: plan["statistics"]["streams"]["sample-on"].update(calls="many"),
        lambda plan: plan["record"].update(skeletons=[{"actions": []}]),
    ],
)
def test_a_spoilt_story_is_an_input_error(stored_plan: Path, spoil: Any) -> None:
    plan = json.loads(stored_plan.read_text(encoding="utf-8"))
    spoil(plan)
    with pytest.raises(InputError, match=r"plan\.json"):
        planning_summary(plan, stored_plan)


def test_the_server_answers_with_the_page_and_nothing_else() -> None:
    with PageServer(b"<!DOCTYPE html>hello") as server:
        thread = Thread(target=server.serve_forever, daemon=True)
        thread.start()
        with urllib.request.urlopen(server.address, timeout=10) as answer:
            assert (
                answer.status == 200
                and answer.headers["Content-Type"] == "text/html; charset=utf-8"
            )
            assert answer.read() == b"<!DOCTYPE html>hello"
        with pytest.raises(urllib.error.HTTPError, match="404"):
            urllib.request.urlopen(f"{server.address}etc/passwd", timeout=10)
        assert server.address.startswith("http://127.0.0.1:")
        with pytest.raises(InputError, match="cannot listen on port"):
            PageServer(b"", server.server_address[1])
        server.shutdown()
        thread.join(10)
    with pytest.raises(InputError, match="cannot listen on port 70000"):
        PageServer(b"", 70000)


def test_a_page_that_cannot_be_written(document: dict[str, Any], tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(InputError, match="cannot write the page"):
        write_page(document, tmp_path / "file" / "out.html")


def test_a_name_may_be_a_mark_of_the_template(document: dict[str, Any]) -> None:
    marks = "@DATA@ @SCRIPT@ </script><script>alert(1)</script> \u202e\x1b"
    reader = read(page({**document, "title": marks}))
    found = json.loads(next(script for script in reader.scripts if script.startswith("{")))
    assert found["title"] == "@DATA@ @SCRIPT@ </script><script>alert(1)</script> \\u202e\\x1b"
    assert len(reader.scripts) == 2 and found["bodies"] == document["bodies"]


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:{port}", "", "127.0.0.1.evil.example:{port}"]
)
def test_the_server_is_asked_by_its_own_name_only(host: str) -> None:
    with PageServer(b"<!DOCTYPE html>secret") as server:
        Thread(target=server.serve_forever, daemon=True).start()
        port = server.server_address[1]
        for name, status in (
            (host.format(port=port), 421),
            (f"localhost:{port}", 200),
            (f"127.0.0.1:{port}", 200),
        ):
            connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
            connection.request("GET", "/", headers={"Host": name})
            answer = connection.getresponse()
            assert answer.status == status and (b"secret" in answer.read()) == (status == 200)
            connection.close()
        server.shutdown()
