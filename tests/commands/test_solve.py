"""tamp-solve as a user meets it: what it prints where, what it writes, how it ends."""

from __future__ import annotations

import importlib.machinery
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import types
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from tamp.commands.solve import BAD_INPUT, INTERRUPTED, NO_PLAN, SOLVED, run
from tamp.geometric.samplers.placements import SurfacePlacements
from tamp.geometric.streams.registry import STREAMS
from tamp.plan.violation import Violation
from tamp.system.files import find_problem
from tamp.verification.report import Report
from tamp.verification.verify import verify

SOLVE = str(Path(sys.executable).with_name("tamp-solve"))
VERIFY = str(Path(sys.executable).with_name("tamp-verify"))

# The can stands in a closed box of walls. No test proves that nothing can be done, so `incremental` goes on trying.
ENCLOSED = """\
domain: cupboard
robot: {model: panda_mobile, base: [0, 0, 0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  table:  {furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0.0, 0.0], yaw: 90 deg}
  shelf:  {furniture: table, size: [1.2, 0.7, 0.72], at: [-1.6, 0.0, 0.0], yaw: 90 deg}
  can:    {cylinder: {radius: 0.03, height: 0.1}, on: table, at: [0.0, 0.0]}
  north:  {box: [0.3, 0.02, 0.3], on: table, at: [0.0, 0.15], fixed: true}
  south:  {box: [0.3, 0.02, 0.3], on: table, at: [0.0, -0.15], fixed: true}
  east:   {box: [0.02, 0.27, 0.3], on: table, at: [0.15, 0.0], fixed: true}
  west:   {box: [0.02, 0.27, 0.3], on: table, at: [-0.15, 0.0], fixed: true}
  lid:    {box: [0.34, 0.34, 0.02], at: [1.6, 0.0, 1.06], fixed: true}
goal: (on can shelf)
"""


def command(*words: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(words, cwd=cwd, capture_output=True, text=True, timeout=100, check=False)


@pytest.fixture(scope="module")
def solved(
    tmp_path_factory: pytest.TempPathFactory,
) -> tuple[Path, subprocess.CompletedProcess[str]]:
    """A plan by the name of a shipped problem from an empty folder, written into folders that do not exist yet."""
    folder = tmp_path_factory.mktemp("elsewhere")
    done = command(SOLVE, "cupboard", "one_object", "--out", "my plans/today/plan.json", cwd=folder)
    return folder / "my plans/today/plan.json", done


def test_the_summary(solved: tuple[Path, subprocess.CompletedProcess[str]]) -> None:
    plan, done = solved
    assert done.returncode == SOLVED, done.stderr
    lines = done.stdout.splitlines()
    assert lines[0] == "one_object: 1 goal, 1 movable of 3 bodies, panda_mobile"
    assert re.fullmatch(r"Solved in \d+\.\d\d s: 4 actions, \d+\.\d s of motion, cost 4", lines[1])
    place = r"\(-?\d\.\d\d, -?\d\.\d\d, -?\d+°\)"
    rows = [
        rf"   1  move +\(0\.00, 0\.00, 0°\) -> {place} +\d+\.\d s",
        r"   2  pick +soup_can +from table +\d+\.\d s",
        rf"   3  move +-> {place} +\d+\.\d s",
        r"   4  place +soup_can +on cupboard_top +\d+\.\d s",
    ]
    for row, line in zip(rows, lines[3:7], strict=True):
        assert re.fullmatch(row, line), line
    assert re.search(r"^  time     .*(ik|motion|search|timing) \d+ %", done.stdout, re.MULTILINE)
    assert re.search(r"sample-on \d+ of \d+", done.stdout)
    assert (
        lines[-1]
        == "my plans/today/plan.json written. Check it: tamp-verify 'my plans/today/plan.json'"
    )
    assert max(len(line) for line in lines) <= 120
    assert [file.name for file in plan.parent.iterdir()] == ["plan.json"]


def test_the_plan_file_conforms_to_its_schema(
    solved: tuple[Path, subprocess.CompletedProcess[str]], root: Path
) -> None:
    schema = json.loads((root / "tamp/plan/plan.schema.json").read_text())
    document = json.loads(solved[0].read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.Draft202012Validator(schema).validate(document)
    assert document["seed"] == 0 and document["goal"] == "(on soup_can cupboard_top)"
    named = {name for action in document["actions"] for name in action["arguments"]}
    assert named and named <= {*document["values"], *document["objects"]}
    assert {fact[0] for fact in document["certified"]} >= {"supported", "kin", "pick-motion"}


def test_tamp_verify_accepts_the_plan(
    solved: tuple[Path, subprocess.CompletedProcess[str]],
) -> None:
    done = command(VERIFY, str(solved[0]), cwd=solved[0].parent)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "plan.json holds: 4 actions" in done.stdout and not done.stderr


def test_json_is_pure_also_with_warnings_and_a_verdict(tmp_path: Path) -> None:
    text = find_problem("one_object").read_text()
    floating = (
        "  lamp: {sphere: 0.05, at: [0.0, 2.0, 2.0]}\n\ngoal:"  # movable, and on nothing: a warning
    )
    (tmp_path / "mine.yaml").write_text(text.replace("\ngoal:", floating))
    done = command(SOLVE, "mine.yaml", "--json", "--verify", "--out", "p.json", cwd=tmp_path)
    assert done.returncode == SOLVED, done.stdout + done.stderr
    document: dict[str, Any] = json.loads(done.stdout)
    assert not done.stderr
    assert document["outcome"] == "solved" and document["plan"] == "p.json"
    assert [action["name"] for action in document["actions"]] == ["move", "pick", "move", "place"]
    assert any("lamp" in warning for warning in document["warnings"])
    assert (
        document["verification"]["holds"] is True and document["verification"]["violations"] == []
    )
    assert json.loads((tmp_path / "p.json").read_text())["format"] == "tamp-plan"


def test_quiet_prints_nothing(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert run(["one_object", "--quiet", "--out", str(tmp_path / "plan.json")]) == SOLVED
    assert capfd.readouterr() == ("", "")
    assert (tmp_path / "plan.json").is_file()


def test_quiet_still_says_what_is_wrong(capfd: pytest.CaptureFixture[str]) -> None:
    assert run(["one_objct", "--quiet"]) == BAD_INPUT
    out, err = capfd.readouterr()
    assert out == "" and "unknown problem 'one_objct'" in err


def test_no_plan_exits_with_1_and_the_reason(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "plan.json"
    out.write_text("an older plan")
    assert run(["impossible_size", "--out", str(out)]) == NO_PLAN
    text = capsys.readouterr().out
    assert re.search(r"^No plan: infeasible\. .*pitcher.*0\.24", text, re.MULTILINE), text
    assert out.read_text() == "an older plan"
    assert run(["impossible_size", "--json", "--out", str(out)]) == NO_PLAN
    document = json.loads(capsys.readouterr().out)
    assert (
        document["outcome"] == "infeasible"
        and document["plan"] is None
        and document["actions"] == []
    )
    assert "pitcher" in document["explanation"][0]
    assert [cause["text"] for cause in document["causes"]] == document["explanation"]
    assert document["causes"][0]["kind"] == "no-value"
    assert "pitcher" in document["causes"][0]["objects"]


def test_verify_judges_before_anything_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "plan.json"
    assert run(["one_object", "--verify", "--out", str(out)]) == SOLVED
    text = capsys.readouterr().out
    assert re.search(r"^the plan holds: 4 actions", text, re.MULTILINE), text
    out.unlink()

    def refuse(document: dict[str, Any], *, classifiers: object) -> Report:
        assert document["format"] == "tamp-plan" and not out.exists()
        violation = Violation(
            "collision", "panda_hand and table penetrate", 1, "pick", 2.5, ("table",), 0.01
        )
        return Report("the plan", (violation,), 4, 12.0, 100, None, {}, (), 0.1)

    monkeypatch.setattr("tamp.verification.verify.verify", refuse)
    assert run(["one_object", "--verify", "--out", str(out)]) == NO_PLAN
    text = capsys.readouterr().out
    assert "collision    2 pick, 2.50 s: panda_hand and table penetrate" in text
    assert "does not hold, 1 violation" in text and f"{out} not written" in text
    assert not list(tmp_path.iterdir())


def test_an_interrupt_ends_with_130_and_what_is_known(tmp_path: Path) -> None:
    (tmp_path / "enclosed.yaml").write_text(ENCLOSED)
    words = [SOLVE, "enclosed.yaml", "--algorithm", "incremental", "--time", "60"]
    with subprocess.Popen(
        words, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline().startswith("enclosed: 1 goal")
        time.sleep(1.0)  # into the middle of planning
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    assert process.returncode == INTERRUPTED, out + err
    assert "Traceback" not in out + err
    assert re.search(r"^Interrupted after \d+\.\d s, no plan yet", out, re.MULTILINE), out
    assert "  search   " in out
    assert [file.name for file in tmp_path.iterdir()] == ["enclosed.yaml"]


@pytest.mark.parametrize("stream", ["sample-grasp", "inverse-kinematics", "plan-pick"])
def test_an_interrupt_inside_a_stream(
    stream: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*inputs: object, call: object) -> Iterator[object]:
        signal.raise_signal(signal.SIGINT)
        yield None

    monkeypatch.setitem(STREAMS, stream, replace(STREAMS[stream], function=interrupted))
    assert run(["one_object", "--json", "--out", str(tmp_path / "plan.json")]) == INTERRUPTED
    out, err = capsys.readouterr()
    document = json.loads(out)
    assert (
        document["outcome"] == "interrupted"
        and document["actions"] == []
        and document["plan"] is None
    )
    assert document["statistics"]["streams"] and not err
    assert not list(tmp_path.iterdir())


def test_an_interrupt_before_planning(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            "tamp.planner.problem_files.load_scene", lambda *_: signal.raise_signal(signal.SIGINT)
        )
        assert run(["one_object", "--out", str(tmp_path / "plan.json")]) == INTERRUPTED
    assert capsys.readouterr() == ("", "interrupted\n")


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ("--seed x", "error: --seed: no whole number: 'x'."),
        ("--time soon", "error: --time: no number: 'soon'."),
    ],
)
def test_a_value_that_is_no_number_is_said_in_words(
    words: str, says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["one_object", *words.split()]) == BAD_INPUT
    assert capsys.readouterr().err.startswith(says)


def test_a_domain_beside_the_problem_and_streams_from_elsewhere(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    source = Path(find_problem("one_object")).parent.parent / "domains"
    (tmp_path / "streams").mkdir()
    shutil.copy(source / "cupboard.pddl", tmp_path / "mine.pddl")
    shutil.copy(source / "cupboard.streams.pddl", tmp_path / "streams" / "other.pddl")
    text = find_problem("one_object").read_text().replace("domain: cupboard", "domain: mine.pddl")
    (tmp_path / "mine.yaml").write_text(text)
    monkeypatch.chdir(tmp_path)
    assert run(["mine.yaml"]) == BAD_INPUT  # there is no mine.streams.pddl
    assert "mine.streams.pddl: no such file" in capsys.readouterr().err
    assert (
        run(
            [
                "mine.yaml",
                "--streams",
                "streams/other.pddl",
                "--sampler",
                "on=surface",
                "--seed",
                "3",
            ]
        )
        == SOLVED
    )
    capsys.readouterr()
    document = json.loads((tmp_path / "plan.json").read_text())
    assert document["inputs"]["streams"]["path"] == str(tmp_path / "streams/other.pddl")
    assert document["inputs"]["domain"]["path"] == str(tmp_path / "mine.pddl")
    assert document["seed"] == 3 and document["options"]["samplers"]["on"] == "surface"
    assert verify(tmp_path / "plan.json").holds


def test_samplers_that_grounding_supplies(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    supplied = types.ModuleType("grounding.registry")
    supplied.__spec__ = importlib.machinery.ModuleSpec("grounding.registry", None)
    supplied.GROUNDINGS = {"on": {"flow": SurfacePlacements}}  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "grounding.registry", supplied)
    for word in ("flow", "flow:alone"):
        assert (
            run(["one_object", "--sampler", f"on={word}", "--out", str(tmp_path / "plan.json")])
            == SOLVED
        )
        assert json.loads((tmp_path / "plan.json").read_text())["options"]["samplers"]["on"] == word
    assert run(["one_object", "--sampler", "on=flaw"]) == BAD_INPUT
    assert (
        "unknown sampler 'flaw' for 'on'. Choices: surface, uniform, flow. Did you mean 'flow'?"
        in (capsys.readouterr().err)
    )


def test_names_in_upper_case_and_names_that_are_taken(tmp_path: Path) -> None:
    """PDDL knows no upper case; and what the planner calls its own values must not be a body's name."""
    text = (
        find_problem("one_object")
        .read_text()
        .replace("soup_can", "Mug")
        .replace("(on Mug", "(on mug")
    )
    others = "".join(
        f"  {name}: {{sphere: 0.03, on: floor, at: [{at}, 2.0]}}\n"
        for at, name in enumerate(("mug_start", "base_start", "p1", "B1"), start=-2)
    )
    metric = "metric: (minimize (total-cost))\n"
    (tmp_path / "mine.yaml").write_text(text.replace("\ngoal:", f"\n{others}\n{metric}goal:"))
    assert (
        run([str(tmp_path / "mine.yaml"), "--verify", "--out", str(tmp_path / "plan.json")])
        == SOLVED
    )
    grasped = [segment for segment in _segments(tmp_path / "plan.json") if "attach" in segment]
    assert [segment["attach"]["body"] for segment in grasped] == ["mug"]


def _segments(plan: Path) -> list[dict[str, Any]]:
    return [
        segment
        for action in json.loads(plan.read_text())["actions"]
        for segment in action["segments"]
    ]


@pytest.mark.parametrize("options", [(), ("--json",)])
def test_a_reader_that_stops_reading_loses_no_plan(
    options: tuple[str, ...], tmp_path: Path
) -> None:
    words = [SOLVE, "one_object", *options]
    with subprocess.Popen(
        words, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None and process.stderr is not None
        process.stdout.close()
        assert process.wait(60) == BAD_INPUT
        assert (
            process.stderr.read() == "error: the standard output cannot be written: Broken pipe\n"
        )
    assert (tmp_path / "plan.json").is_file()


@pytest.mark.parametrize("name", ["tamp-solve", "tamp-verify"])
def test_help_is_readable(name: str, tmp_path: Path) -> None:
    done = command(str(Path(sys.executable).with_name(name)), "--help", cwd=tmp_path)
    assert done.returncode == 0 and not done.stderr
    assert "Exit status: 0" in done.stdout and "--json" in done.stdout
    assert "{None}" not in done.stdout and "--no-" not in done.stdout
    assert max(len(line) for line in done.stdout.splitlines()) <= 120


@pytest.mark.parametrize(
    "name",
    [
        "tamp-solve",
        "tamp-verify",
        "tamp-execute",
        "tamp-export",
        "tamp-demo",
        "tamp-view",
        "tamp-bench",
    ],
)
def test_help_that_nobody_reads_is_no_error(name: str) -> None:
    ours, theirs = os.pipe()
    os.close(ours)
    with os.fdopen(theirs, "w") as closed:
        program = Path(sys.executable).with_name(name)
        ended = subprocess.run(
            [program, "--help"], stdout=closed, stderr=subprocess.PIPE, timeout=100, check=False
        )
    assert (ended.returncode, ended.stderr) == (0, b"")
