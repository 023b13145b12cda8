"""What is in the page, without a browser: test_in_browser.py looks at it in one."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

from tamp.errors import InputError
from tamp.view.document import page_document
from tamp.view.page import page, write_page
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
