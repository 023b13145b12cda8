"""tamp-view and the showing options of tamp-solve, as a user meets them."""

from __future__ import annotations

import json
import socket
import webbrowser
from pathlib import Path
from typing import Any

import pytest

from tamp.commands import solve as solving
from tamp.commands.view import main
from tamp.view import server
from tests.view.images import pixels

SMALL = ["--size", "64x48"]


def test_a_plan_becomes_a_page_a_picture_and_a_film(
    stored_plan: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page, png, gif = (tmp_path / name for name in ("a.html", "b.png", "c.gif"))
    words = [
        "--html",
        str(page),
        "--png",
        str(png),
        "--video",
        str(gif),
        *SMALL,
        "--speed",
        "100",
        "--at",
        "2",
        "--at",
        "5",
    ]
    assert main([str(stored_plan), *words]) == 0
    assert pixels(png).shape == (48, 128, 3)
    assert pixels(gif).shape == (48, 64, 3)
    assert '"place soup_can on cupboard_top"' in page.read_text(encoding="utf-8")
    said = capsys.readouterr().out
    assert all(f"{file} written" in said for file in (page, png, gif))


def test_a_scene_is_shown_by_name(tmp_path: Path) -> None:
    page = tmp_path / "scene.html"
    assert main(["shelves", "--html", str(page)]) == 0
    text = page.read_text(encoding="utf-8")
    assert "<title>shelves</title>" in text and '"actions":[]' in text


def test_the_browser_is_opened_at_the_served_page(
    stored_plan: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    opened: list[str] = []
    monkeypatch.setattr(webbrowser, "get", lambda *_: None)
    monkeypatch.setattr(webbrowser, "open", opened.append)
    monkeypatch.setattr(server.PageServer, "serve_forever", interrupted)
    assert main([str(stored_plan)]) == 0
    (address,) = opened
    assert f"{address} shows it until Ctrl-C." in capsys.readouterr().out
    opened.clear()
    assert main([str(stored_plan), "--no-browser"]) == 0
    assert opened == []


def interrupted(*_: Any) -> None:
    raise KeyboardInterrupt


def no_browser(*_: Any) -> None:
    raise webbrowser.Error


def test_bad_input_is_one_line_and_exit_code_two(
    stored_plan: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(webbrowser, "get", no_browser)
    plan = str(stored_plan)
    other = json.loads(stored_plan.read_text(encoding="utf-8"))
    other["inputs"]["problem"]["sha256"] = "0" * 64
    changed = tmp_path / "changed.json"
    changed.write_text(json.dumps(other), encoding="utf-8")
    newer = tmp_path / "newer.json"
    newer.write_text(json.dumps(other | {"version": 2}), encoding="utf-8")
    spoilt = tmp_path / "spoilt.json"
    other = json.loads(stored_plan.read_text(encoding="utf-8"))
    other["record"]["samples"][0]["refusals"] = 3
    spoilt.write_text(json.dumps(other), encoding="utf-8")
    broken = tmp_path / "broken.json"
    broken.write_text('{"format":', encoding="utf-8")
    out = str(tmp_path / "out")
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        cases = [
            ([plan], "no browser was found to open. Write a page with --html FILE"),
            (
                [plan, "--no-browser", "--port", port],
                f"cannot listen on port {port}: Address already in use. Give another",
            ),
            (
                [str(changed), "--html", out],
                "is not the one that the plan was made from. Plan again with tamp-solve",
            ),
            ([str(newer), "--html", out], "newer.json: version: version 2 is not known, only 1"),
            ([str(broken), "--html", out], "broken.json:1:11: not JSON"),
            (
                [str(spoilt), "--html", out],
                "spoilt.json: record.samples[0].refusals: an array is expected, not a number",
            ),
            ([str(tmp_path / "none.json"), "--html", out], "no such file"),
            (["for_objects", "--html", out], "Did you mean 'four_objects'?"),
            (["one_object", "--problem", plan, "--html", out], "--problem goes with a plan"),
            (
                ["one_object", "--video", out + ".gif", *SMALL],
                "nothing moves without a plan. A picture is made by --png",
            ),
            (
                [plan, "--video", out + ".mp4"],
                "no moving picture is written as '.mp4'. Choices: .gif, .webp",
            ),
            ([plan, "--png", out + ".jpg"], "a picture is written as .png"),
            (
                [plan, "--png", out + ".png", "--size", "big"],
                "--size wants WIDTHxHEIGHT, not 'big'",
            ),
            (
                [plan, "--png", out + ".png", "--size", "8x8"],
                "--size: 8x8 is not between 16x16 and 4096x4096",
            ),
            (
                [plan, "--video", out + ".gif", "--speed", "0"],
                "--speed: 0 is not between 0 and 1000",
            ),
            ([plan, "--png", out + ".png", "--at", "nan"], "--at: nan is no time in a plan"),
            ([plan, "--html", str(tmp_path)], "the output is a folder"),
        ]
        for words, expected in cases:
            assert main(words) == 2, words
            said = capsys.readouterr().err
            assert expected in said and said.count("\n") == 1, said
    assert not list(tmp_path.glob("out*"))


def test_solve_writes_page_and_picture_beside_the_plan(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plan, page, png = (tmp_path / name for name in ("plan.json", "plan.html", "plan.png"))
    assert (
        solving.run(["one_object", "--out", str(plan), "--html", str(page), "--png", str(png)])
        == solving.SOLVED
    )
    assert pixels(png).shape == (600, 2400, 3)
    assert json.loads(plan.read_text(encoding="utf-8"))["record"]["samples"]
    assert f"{page} written" in capsys.readouterr().out
    shown = tmp_path / "again.html"
    assert main([str(plan), "--html", str(shown)]) == 0
    first, second = (file.read_text(encoding="utf-8") for file in (page, shown))
    assert first == second  # what was stored shows what was seen


def test_solve_shows_what_was_tried_when_there_is_no_plan(tmp_path: Path) -> None:
    page = tmp_path / "none.html"
    code = solving.run(
        ["impossible_size", "--out", str(tmp_path / "plan.json"), "--html", str(page), "--quiet"]
    )
    assert code == solving.NO_PLAN
    assert '"head":"No plan: infeasible' in page.read_text(encoding="utf-8")


def test_solve_refuses_early(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], root: Path
) -> None:
    monkeypatch.setattr(webbrowser, "get", no_browser)
    monkeypatch.chdir(tmp_path)
    for words, expected in [
        (["one_object", "--view"], "no browser was found to open"),
        (["one_object", "--video", "out.avi"], "no moving picture is written as '.avi'"),
        (
            ["domain.pddl", "problem.pddl", "--html", "x.html"],
            "--html is for problems with a scene",
        ),
    ]:
        assert solving.run(words) == solving.BAD_INPUT
        assert expected in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_meshes_from_elsewhere_are_given_away_only_when_that_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    corners = "".join(f"v {x} {y} {z}\n" for x in (0, 0.05) for y in (0, 0.05) for z in (0, 0.1))
    faces = "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n"
    (tmp_path / "hidden.obj").write_text(corners + faces, encoding="utf-8")
    here = tmp_path / "here"
    here.mkdir()
    problem, page = here / "p.yaml", here / "p.html"
    for mesh, inside in (("../hidden.obj", False), ("link.obj", False), ("objects/mug.obj", True)):
        if mesh == "link.obj":
            (here / mesh).symlink_to("../hidden.obj")
        problem.write_text(
            "domain: cupboard\nrobot: {model: panda_mobile, base: [0, 0, 0]}\n"
            "room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}\nbodies:\n"
            "  table: {furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0, 0]}\n"
            f"  thing: {{mesh: {mesh}, on: table{', scale: 0.85' if inside else ''}}}\ngoal: (on thing table)\n",
            encoding="utf-8",
        )
        assert main([str(problem), "--html", str(page)]) == (0 if inside else 2), (
            capsys.readouterr().err
        )
        assert page.exists() == inside
        if not inside:
            assert "--allow-outside" in capsys.readouterr().err
            assert (
                solving.run([str(problem), "--html", str(page), "--out", str(here / "x.json")]) == 2
            )
            assert not page.exists() and not (here / "x.json").exists()
            assert main([str(problem), "--html", str(page), "--allow-outside"]) == 0
            page.unlink()


def test_a_mesh_that_is_only_drawn_does_not_leave_the_folder_either(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    here = tmp_path / "here"
    here.mkdir()
    (tmp_path / "hidden.obj").write_text(
        "v 0 0 0\nv 0.05 0 0\nv 0 0.05 0\nv 0 0 0.05\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    )
    (here / "thing.urdf").write_text(
        '<robot name="thing"><link name="l">'
        '<visual><geometry><mesh filename="../hidden.obj"/></geometry></visual>'
        '<collision><geometry><box size="0.05 0.05 0.1"/></geometry></collision></link></robot>'
    )
    problem, page = here / "p.yaml", here / "p.html"
    problem.write_text(
        "domain: cupboard\nrobot: {model: panda_mobile, base: [0, 0, 0]}\n"
        "room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}\nbodies:\n"
        "  table: {furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0, 0]}\n"
        "  thing: {mesh: thing.urdf, on: table}\ngoal: (on thing table)\n"
    )
    plan = here / "plan.json"
    assert solving.run([str(problem), "--out", str(plan)]) == 0

    for command in (
        lambda: main([str(problem), "--html", str(page)]),
        lambda: main([str(plan), "--html", str(page)]),
        lambda: solving.run([str(problem), "--html", str(page), "--out", str(here / "other.json")]),
    ):
        capsys.readouterr()
        assert command() == 2
        said = capsys.readouterr().err
        assert "hidden.obj" in said and "--allow-outside" in said
        assert not page.exists()

    assert main([str(plan), "--html", str(page), "--allow-outside"]) == 0
    kept = (tmp_path / "hidden.obj").read_bytes()
    assert main([str(plan), "--html", str(tmp_path / "hidden.obj"), "--allow-outside"]) == 2
    assert (tmp_path / "hidden.obj").read_bytes() == kept


def test_a_pause_of_hours_makes_no_endless_picture(
    stored_plan: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plan = json.loads(stored_plan.read_text(encoding="utf-8"))
    segment = plan["actions"][1]["segments"][-1]
    rows = segment["opening"] if segment["part"] == "gripper" else segment["positions"]
    segment["times"].append(segment["times"][-1] + 20_000.0)
    rows.append(rows[-1])
    file, picture = tmp_path / "plan.json", tmp_path / "x.gif"
    file.write_text(json.dumps(plan), encoding="utf-8")
    words = [str(file), "--video", str(picture), *SMALL, "--speed", "20"]
    assert main(words) == 0
    assert "without 19,990 s of pauses" in capsys.readouterr().out
    segment["times"][-1] = 1e11
    rows[-1] = (
        [number + 0.1 for number in rows[-1]] if isinstance(rows[-1], list) else rows[-1] + 0.01
    )
    file.write_text(json.dumps(plan), encoding="utf-8")
    picture.unlink()
    assert main(words) == 2 and not picture.exists()
    assert "no moving picture can show" in capsys.readouterr().err
