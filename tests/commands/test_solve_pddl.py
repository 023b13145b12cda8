"""The steps of tamp-solve for a problem in PDDL: each decides by what the one before it made."""

from __future__ import annotations

import json
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tamp.commands import solve_pddl as module
from tamp.commands.solve_options import Arguments, Budget, parsed
from tamp.commands.solve_pddl import Ended, judge, load, plan, solve_pddl, write
from tamp.errors import InputError
from tamp.plan.violation import Violation
from tamp.planner.pddl_only.solve import SymbolicSolution
from tamp.symbolic.algorithms.result import Outcome
from tamp.system.progress import Progress
from tamp.verification.report import Report

DOMAIN = """(define (domain doors) (:predicates (at ?x) (door ?x ?y))
  (:action go :parameters (?x ?y) :precondition (and (at ?x) (door ?x ?y))
    :effect (and (at ?y) (not (at ?x)))))"""
PROBLEM = """(define (problem three) (:domain doors) (:objects a b c)
  (:init (at a) (door a b) (door b c)) (:goal (at {goal})))"""
HOLDS = Report("p", (), 2, 0.0, 0, None, {}, (), 0.1)
FAILS = replace(HOLDS, violations=(Violation("goal", "it does not hold"),))


class Said(Progress):
    """A progress that keeps its lines."""

    def __init__(self) -> None:
        super().__init__(quiet=True)
        self.lines: list[str] = []

    def line(self, text: str) -> None:
        self.lines.append(text)


@pytest.fixture
def options_of(tmp_path: Path) -> Any:
    """Makes the options of a problem whose goal is to be in a room."""

    def made(goal: str = "c", *words: str) -> Arguments:
        (tmp_path / "doors.pddl").write_text(DOMAIN)
        (tmp_path / "three.pddl").write_text(PROBLEM.format(goal=goal))
        files = [str(tmp_path / name) for name in ("doors.pddl", "three.pddl")]
        return parsed([*files, "--out", str(tmp_path / "plan.json"), *words])

    return made


def budget() -> Budget:
    return Budget(10.0, time.monotonic())


def solution(options: Arguments) -> SymbolicSolution:
    return plan(options, load(options), budget(), Said())


def test_a_problem_alone_wants_its_domain(options_of: Any) -> None:
    options = options_of()
    with pytest.raises(InputError, match="alone: a problem in PDDL needs its domain before it"):
        load(replace(options, files=options.files[1:]))


def test_a_scene_in_the_domains_place_is_refused(options_of: Any) -> None:
    options = options_of()
    with pytest.raises(InputError, match=r"found 'scene\.yaml' in the domain's place"):
        load(replace(options, files=("scene.yaml", options.files[1])))


def test_an_unknown_search_is_refused_before_files_are_read(options_of: Any) -> None:
    options = options_of()
    pddl = replace(options.pddl, search="fastest")
    with pytest.raises(InputError, match="fastest"):
        load(replace(options, pddl=pddl, files=("gone.pddl", "gone.pddl")))


def test_the_plan_goes_through_both_doors(options_of: Any) -> None:
    found = solution(options_of())
    assert found.outcome is Outcome.SOLVED
    assert [(one.name, *one.arguments) for one in found.plan] == [
        ("go", "a", "b"),
        ("go", "b", "c"),
    ]


def test_optimizing_tells_of_each_better_plan(options_of: Any) -> None:
    options, said = options_of("c", "--optimize"), Said()
    found = plan(options, load(options), budget(), said)
    assert found.solved and len(found.plan) == 2 and len(said.lines) >= 1


def test_the_judge_is_asked_where_it_is_wanted_and_there_is_a_plan(
    options_of: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    options = options_of("c", "--verify")
    found = solution(options)
    verdict = judge(options, found)
    assert verdict is not None and verdict.holds
    assert judge(options_of("c"), found) is None
    assert judge(options, replace(found, outcome=Outcome.TIMEOUT)) is None
    monkeypatch.setattr(module.guard, "asked", lambda: True)
    assert judge(options, found) is None


def test_only_a_plan_that_the_judge_does_not_refuse_is_written(options_of: Any) -> None:
    options = options_of()
    found = solution(options)
    assert write(options, found, FAILS).written is None and not options.out.exists()
    assert write(options, replace(found, outcome=Outcome.INFEASIBLE), None).written is None
    assert write(options, found, HOLDS).written == options.out and options.out.exists()
    assert write(options, found, None).written == options.out


def test_the_document_says_where_the_plan_is_and_what_the_judge_said(options_of: Any) -> None:
    found = solution(options_of())
    said = json.loads(Ended(found, FAILS, None).json())
    assert said["plan"] is None and said["verification"]["holds"] is False
    said = json.loads(Ended(found, None, Path("p.json")).json())
    assert said["plan"] == "p.json" and "verification" not in said
    assert not Ended(found, None, None).interrupted
    assert Ended(replace(found, outcome=Outcome.INTERRUPTED), None, None).interrupted


@pytest.mark.parametrize("goal", ["c", "a"])
def test_a_plan_is_written_even_where_nothing_is_to_be_done(options_of: Any, goal: str) -> None:
    options, said = options_of(goal), Said()
    assert solve_pddl(options, budget(), said) is True
    assert options.out.exists() and "written. Check it" in said.lines[-1]


def test_without_a_plan_nothing_is_written(options_of: Any) -> None:
    options = options_of()
    unreachable = PROBLEM.replace("(door b c)", "").format(goal="c")
    Path(options.files[1]).write_text(unreachable)
    assert solve_pddl(options, budget(), Said()) is False and not options.out.exists()


def test_an_output_over_an_input_is_refused(options_of: Any) -> None:
    options = options_of()
    with pytest.raises(InputError):
        solve_pddl(replace(options, out=Path(options.files[1])), budget(), Said())
    assert Path(options.files[1]).read_text() == PROBLEM.format(goal="c")
