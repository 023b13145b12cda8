"""A symbolic solution in words and as files."""

from __future__ import annotations

import hashlib
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tamp.errors import InputError
from tamp.planner.pddl_only.problem import SymbolicProblem
from tamp.planner.pddl_only.report import (
    document,
    headline,
    improvement,
    plan_text,
    summary,
    write_symbolic_plan,
)
from tamp.planner.pddl_only.solve import SymbolicSolution
from tamp.symbolic.algorithms.cause import Cause, CauseKind
from tamp.symbolic.algorithms.result import Outcome
from tamp.symbolic.pddl.structs import And
from tamp.symbolic.search.operators import NO_FACTS, Operator


def step(cost: float, *words: str) -> Operator:
    return Operator(words[0], words[1:], NO_FACTS, NO_FACTS, NO_FACTS, NO_FACTS, cost)


@pytest.fixture
def solved(errands: SymbolicProblem) -> SymbolicSolution:
    """Two actions that cost 3.5 together."""
    return SymbolicSolution(
        replace(errands, warnings=("d.pddl:6: odd",)), Outcome.SOLVED, "greedy", "ff",
        plan=(step(3.0, "drive", "van", "home", "a"), step(0.5, "tow", "van")),
        expanded=1, evaluated=1234, operators=7, facts=1, seconds={"total": 1.234, "search": 0.1},
    )  # fmt: skip


def test_one_line_tells_of_the_problem(errands: SymbolicProblem) -> None:
    assert headline(errands) == "round: 2 goals, 5 objects, domain errands"
    assert isinstance(errands.task.goal, And)
    one = replace(errands, task=replace(errands.task, goal=errands.task.goal.parts[0]))
    assert headline(one) == "round: 1 goal, 5 objects, domain errands"


def test_a_plan_is_told_step_by_step(solved: SymbolicSolution) -> None:
    assert summary(solved).splitlines() == [
        "warning: d.pddl:6: odd",
        "Solved in 1.23 s: 2 actions, cost 3.5",
        "",
        "   1  (drive van home a)",
        "   2  (tow van)",
        "",
        "  search   greedy with ff · 1 state expanded, 1,234 evaluated · 7 operators and 1 fact",
    ]
    assert "cost 3.5 (optimal)" in summary(replace(solved, optimal=True))
    nothing = summary(replace(solved, plan=()))
    assert "0 actions, cost 0" in nothing and "  the goal holds at the start" in nothing


def test_mistakes_that_were_mended_are_warnings_beside_a_plan(solved: SymbolicSolution) -> None:
    told = summary(replace(solved, causes=(Cause("a plan did not hold", CauseKind.REFUTED),)))
    assert told.splitlines()[1] == "warning: a plan did not hold"


@pytest.mark.parametrize(
    ("outcome", "causes", "lines"),
    [
        (Outcome.TIMEOUT, ("why",), ["No plan in 1.2 s"]),
        (Outcome.INFEASIBLE, ("why", "and why"), ["No plan: infeasible:", "  why", "  and why"]),
        (Outcome.EXHAUSTED, (), ["No plan: everything there was to try failed."]),
        (Outcome.INTERRUPTED, (), ["Interrupted before a plan was found."]),
    ],
)
def test_without_a_plan_it_is_told_how_it_ended(
    solved: SymbolicSolution, outcome: Outcome, causes: tuple[str, ...], lines: list[str]
) -> None:
    found = tuple(Cause(text, CauseKind.UNREACHABLE) for text in causes)
    told = summary(replace(solved, outcome=outcome, plan=(), causes=found)).splitlines()
    assert told[1:-2] == lines


def test_an_improvement_is_told_with_what_is_left_open(solved: SymbolicSolution) -> None:
    better = replace(solved, history=((0.5, 9.0), (12.345, 3.5)), bound=2.8)
    assert improvement(better) == "  12.35 s  2 actions, cost 3.5, no plan below 2.8, gap 20 %"


def test_programs_read_the_same(solved: SymbolicSolution) -> None:
    told: dict[str, Any] = json.loads(json.dumps(document(solved)))
    assert (told["outcome"], told["message"], told["problem"]) == ("solved", "Solved", "round")
    assert told["actions"][1] == {"name": "tow", "arguments": ["van"], "cost": 0.5}
    assert told["cost"] == 3.5 and told["optimal"] is False and told["warnings"]
    assert told["timing"] == {"total": 1.234, "search": 0.1}
    assert "optimization" not in told and "refuted" not in told["statistics"]

    more = document(replace(solved, history=((0.5, 9.0), (1.0, 3.5)), bound=2.8, refuted=2))
    assert more["optimization"]["bound"] == 2.8
    assert more["optimization"]["gap"] == pytest.approx(0.2)
    assert [one["cost"] for one in more["optimization"]["improvements"]] == [9.0, 3.5]
    assert more["statistics"]["refuted"] == 2


def test_the_plan_file_names_its_inputs_by_what_is_in_them(
    solved: SymbolicSolution, tmp_path: Path
) -> None:
    file = write_symbolic_plan(solved, tmp_path / "new" / "plan.json")
    assert file.read_text(encoding="utf-8") == plan_text(solved)
    written = json.loads(plan_text(solved))
    for role, path in (("problem", "p.pddl"), ("domain", "d.pddl")):
        content = (tmp_path / path).read_bytes()
        assert written["inputs"][role]["sha256"] == hashlib.sha256(content).hexdigest()
        assert written["inputs"][role]["path"] == str((tmp_path / path).resolve())
    assert written["options"] == {"search": "greedy", "heuristic": "ff"} and written["cost"] == 3.5


def test_no_plan_no_file_and_inputs_that_are_gone_are_told(
    solved: SymbolicSolution, tmp_path: Path
) -> None:
    file = tmp_path / "plan.json"
    with pytest.raises(InputError, match="there is no plan to write"):
        write_symbolic_plan(replace(solved, outcome=Outcome.TIMEOUT), file)
    (tmp_path / "d.pddl").unlink()
    with pytest.raises(InputError, match=r"d\.pddl: it cannot be read any more"):
        write_symbolic_plan(solved, file)
    assert not file.exists()


def test_a_plan_in_a_files_place_cannot_be_written(
    solved: SymbolicSolution, tmp_path: Path
) -> None:
    (tmp_path / "taken").write_text("")
    with pytest.raises(InputError, match="cannot write the plan"):
        write_symbolic_plan(solved, tmp_path / "taken" / "plan.json")
