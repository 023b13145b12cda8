"""Problems in PDDL from the command line: no scene, no robot, a plan that the judge accepts."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from tamp.commands.solve import BAD_INPUT, NO_PLAN, SOLVED, run
from tamp.commands.verify import main as judge
from tamp.errors import InputError
from tamp.symbolic.pddl.structs import Task
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.operators import InstantiatedTask
from tamp.system.deadline import STANDSTILL
from tamp.verification.verify import verify
from tests.planner.pddl_only.texts import DOMAIN, PROBLEM


def test_an_optimal_plan_is_found_shown_written_and_judged(
    files: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["d.pddl", "p.pddl", "--search", "astar", "--verify"]) == SOLVED
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "round: 2 goals, 5 objects, domain errands"
    assert lines[1] == "warning: d.pddl:6:28: predicate 'unused' is never used"
    assert lines[2].endswith("4 actions, cost 15 (optimal)")
    shown = [line.split("  ")[-1] for line in lines[4:8]]
    assert shown == ["(drive van home a)", "(drive van a b)", "(drive van b c)", "(tow van)"]
    assert lines[-3].startswith("the plan holds: 4 actions")
    plan = json.loads((files / "plan.json").read_text(encoding="utf-8"))
    assert [action["cost"] for action in plan["actions"]] == [3, 1, 1, 10]
    assert plan["cost"] == 15
    assert judge(["plan.json"]) == 0


@pytest.mark.parametrize("search", ["greedy", "eager", "wastar", "astar"])
def test_every_search_is_a_choice(search: str, files: Path) -> None:
    assert (
        run(["d.pddl", "p.pddl", "--search", search, "--heuristic", "landmarks", "--quiet"])
        == SOLVED
    )
    assert verify("plan.json").holds


def test_the_plan_file_conforms_to_its_schema(files: Path, root: Path) -> None:
    run(["d.pddl", "p.pddl", "--quiet"])
    schema = json.loads((root / "tamp/plan/symbolic-plan.schema.json").read_text(encoding="utf-8"))
    jsonschema.validate(json.loads(Path("plan.json").read_text(encoding="utf-8")), schema)


def test_json(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["d.pddl", "p.pddl", "--json", "--verify"]) == SOLVED
    shown = json.loads(capsys.readouterr().out)
    assert shown["outcome"] == "solved"
    assert shown["plan"] == "plan.json"
    assert shown["verification"]["holds"]
    assert shown["statistics"]["search"] == "greedy"


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("(served ?p)", "(unused van)", "(unused van): no action"),  # nothing makes it true
        (
            "(:goal (and",
            "(:goal (and (at van a) (broken van)",
            "(broken van) and (not (broken van)) cannot both",
        ),
    ],
)
def test_no_plan_is_proven(
    old: str, new: str, words: str, files: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    goal = PROBLEM.index("(:goal")
    (files / "p.pddl").write_text(
        PROBLEM[:goal] + PROBLEM[goal:].replace(old, new), encoding="utf-8"
    )
    assert run(["d.pddl", "p.pddl"]) == NO_PLAN
    shown = capsys.readouterr().out
    assert "No plan: infeasible" in shown
    assert words in shown
    assert not (files / "plan.json").exists()


def test_time_is_kept(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Forty places in a grid and blind search: more states than half a second has room for."""
    cars = " ".join(f"car{i}" for i in range(9))
    text = PROBLEM.replace("van - truck", f"van - truck {cars} - car")
    text = text.replace(
        "(at van home)", "(at van home)" + "".join(f" (at car{i} home)" for i in range(9))
    )
    text = text.replace("(not (broken van))", "(at car0 c) (at car8 c) (at car5 c) (at car4 c)")
    (files / "p.pddl").write_text(text, encoding="utf-8")
    assert (
        run(["d.pddl", "p.pddl", "--search", "astar", "--heuristic", "blind", "--time", "0.5"])
        == NO_PLAN
    )
    assert "No plan in 0." in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["p.pddl"], "a problem in PDDL needs its domain before it"),
        (["p.pddl", "d.pddl"], "p.pddl:1:9: expected (domain NAME)"),
        (["d.pddl", "q.pddl"], "q.pddl: no such file"),
        (["d.pddl", "p.pddl", "--search", "astr"], "unknown search 'astr'. Choices: astar"),
        (["d.pddl", "p.pddl", "--heuristic", "lmct"], "Did you mean 'lmcut'?"),
        (["one_object", "--search", "astar"], "are for problems in PDDL"),
    ],
)
def test_wrong_commands(
    arguments: list[str], words: str, files: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(arguments) == BAD_INPUT
    assert words in capsys.readouterr().err


def test_a_typo_is_placed_and_corrected(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (files / "p.pddl").write_text(PROBLEM.replace("(served ?p)", "(servd ?p)"), encoding="utf-8")
    assert run(["d.pddl", "p.pddl"]) == BAD_INPUT
    error = capsys.readouterr().err
    assert "p.pddl:7:42: unknown predicate 'servd'" in error
    assert "Did you mean 'served'?" in error


def plan_of(files: Path) -> dict[str, Any]:
    run(["d.pddl", "p.pddl", "--quiet", "--search", "astar"])
    return json.loads((files / "plan.json").read_text(encoding="utf-8"))


def test_the_judge_finds_what_is_wrong(files: Path) -> None:
    plan = plan_of(files)
    del plan["actions"][1]
    found = {(violation.kind, violation.index) for violation in verify(plan).violations}
    assert found == {("precondition", 1), ("cost", None)}
    plan = plan_of(files)
    del plan["actions"][-1]
    plan["cost"] = 5
    assert [str(v) for v in verify(plan).violations] == [
        "goal         (not (broken van)) does not hold"
    ]
    plan = plan_of(files)
    plan["actions"][0]["cost"] = 2
    assert [(v.kind, v.message) for v in verify(plan).violations] == [("cost", "it costs 3, not 2")]
    plan = plan_of(files)
    (files / "d.pddl").write_text(DOMAIN + "; changed", encoding="utf-8")
    assert [v.kind for v in verify(plan).violations] == ["hash"]


def test_the_judge_refuses_what_it_cannot_read(files: Path) -> None:
    plan = plan_of(files)
    plan["actions"][0]["name"] = "drife"
    with pytest.raises(InputError, match=r"unknown action 'drife'.*Did you mean 'drive'"):
        verify(plan)
    plan["actions"][0] |= {"name": "drive", "arguments": ["van", "home"]}
    with pytest.raises(InputError, match="'drive' takes 3 arguments, not 2"):
        verify(plan)
    plan["actions"][0]["arguments"] = ["van", "home", "nowhere"]
    with pytest.raises(InputError, match="unknown object 'nowhere'"):
        verify(plan)
    plan = plan_of(files)
    (files / "p.pddl").rename(files / "elsewhere.pddl")
    with pytest.raises(InputError, match=r"the plan's problem .* is missing"):
        verify(plan)
    assert verify(plan, problem="elsewhere.pddl").holds


def test_a_number_of_jobs_is_positive(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["d.pddl", "p.pddl", "--jobs", "0"]) == BAD_INPUT
    assert "--jobs: between 1 and" in capsys.readouterr().err


def test_kernels_that_are_compiled_are_told_of_and_are_no_time_of_the_search(
    files: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The clock stands still for a hundred seconds while the task is instantiated."""
    monkeypatch.setattr(STANDSTILL, "total", STANDSTILL.total)
    monkeypatch.setattr(STANDSTILL, "told", None)

    def compiled(task: Task) -> InstantiatedTask:
        assert STANDSTILL.told is not None
        STANDSTILL.told(0)
        STANDSTILL.total += 100.0
        return instantiate(task)

    monkeypatch.setattr("tamp.planner.pddl_only.solve.instantiate", compiled)
    assert run(["d.pddl", "p.pddl", "--time", "50"]) == SOLVED
    told = capsys.readouterr()
    assert "compiling kernels" in told.err
    assert re.search(r"^Solved in -\d+\.\d+ s", told.out, re.MULTILINE), told.out
