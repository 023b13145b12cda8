"""A greedy plan of a small task is shortened where another search finds half of it; it holds by the book."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from random import Random

import pytest

from benchmarks.classical_domains import GENERATORS
from benchmarks.side_by_side import conditions
from tamp.planner.pddl_only import cheaper_plan, solve
from tamp.planner.pddl_only.problem import load_symbolic
from tamp.symbolic.search.replay import violation
from tamp.system.deadline import OutOfTime

HANOI = """
(define (domain robot-hanoi) (:requirements :typing)
  (:types disc peg - thing)
  (:predicates (on ?d - disc ?t - thing) (clear ?t - thing) (smaller ?d ?t - disc) (standing ?d - disc ?p - peg)
               (robot ?p - peg) (held ?d - disc) (free))
  (:action move :parameters (?a ?b - peg) :precondition (robot ?a) :effect (and (robot ?b) (not (robot ?a))))
  (:action pick :parameters (?d - disc ?t - thing ?p - peg)
    :precondition (and (robot ?p) (free) (on ?d ?t) (clear ?d) (standing ?d ?p))
    :effect (and (held ?d) (clear ?t) (not (on ?d ?t)) (not (free)) (not (standing ?d ?p)) (not (clear ?d))))
  (:action put-on-peg :parameters (?d - disc ?p - peg) :precondition (and (robot ?p) (held ?d) (clear ?p))
    :effect (and (free) (on ?d ?p) (standing ?d ?p) (clear ?d) (not (held ?d)) (not (clear ?p))))
  (:action put-on-disc :parameters (?d ?t - disc ?p - peg)
    :precondition (and (robot ?p) (held ?d) (clear ?t) (smaller ?d ?t) (standing ?t ?p))
    :effect (and (free) (on ?d ?t) (standing ?d ?p) (clear ?d) (not (held ?d)) (not (clear ?t)))))
"""


def hanoi(discs: int) -> str:
    """All discs, carried by a robot that goes from peg to peg, go from the first peg to the last."""
    names = [f"d{i}" for i in range(discs)]
    tower = [f"(on {up} {low})" for up, low in pairwise(names)]
    init = ["(robot a) (free) (clear d0) (clear b) (clear c)", f"(on {names[-1]} a)", *tower]
    init += [f"(standing {name} a)" for name in names]
    init += [f"(smaller {names[i]} {names[j]})" for j in range(discs) for i in range(j)]
    return f"""(define (problem hanoi) (:domain robot-hanoi) (:objects {" ".join(names)} - disc a b c - peg)
      (:init {" ".join(init)}) (:goal (and (on {names[-1]} c) {" ".join(tower)})))"""


@pytest.fixture
def four_discs(tmp_path: Path) -> solve.SymbolicProblem:
    domain, problem = tmp_path / "domain.pddl", tmp_path / "problem.pddl"
    domain.write_text(HANOI)
    problem.write_text(hanoi(4))
    return load_symbolic(domain, problem)


def test_hanoi_takes_no_more_than_it_must(four_discs: solve.SymbolicProblem) -> None:
    """Fifteen carries: a pick and a put each, and a way to each place but the first."""
    solution = solve.solve_symbolic(four_discs)
    assert solution.solved and len(solution.plan) <= 60
    assert violation(four_discs.task, [(o.name, o.arguments) for o in solution.plan]) is None


def test_the_first_plan_stands_where_there_is_no_time_for_another(
    four_discs: solve.SymbolicProblem, monkeypatch: pytest.MonkeyPatch
) -> None:
    def late(*arguments: object, **options: object) -> object:
        raise OutOfTime

    monkeypatch.setattr(cheaper_plan, "search", late)
    assert len(solve.solve_symbolic(four_discs).plan) > 60


def test_a_dear_plan_is_worth_more_states(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A lift that stops wherever it can: half of its ways are for nothing."""
    domain, problem = tmp_path / "domain.pddl", tmp_path / "problem.pddl"
    for file, text in zip((domain, problem), GENERATORS["miconic"](14, Random(1)), strict=True):
        file.write_text(text)
    task = load_symbolic(domain, problem)
    monkeypatch.setattr(cheaper_plan, "SHORTENING_WORK", 1)
    monkeypatch.setattr(cheaper_plan, "COSTLY_PLAN_FACTOR", math.inf)
    greedy = solve.solve_symbolic(task)
    monkeypatch.setattr(cheaper_plan, "COSTLY_PLAN_FACTOR", 1.5)
    cheaper = solve.solve_symbolic(task)
    assert cheaper.solved and cheaper.cost <= 0.8 * greedy.cost
    assert violation(task.task, [(o.name, o.arguments) for o in cheaper.plan]) is None


def test_a_plan_as_cheap_as_its_estimate_is_taken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ten switches, one after the other: there is nothing to look for."""
    domain, problem = tmp_path / "domain.pddl", tmp_path / "problem.pddl"
    for file, text in zip((domain, problem), conditions(10), strict=True):
        file.write_text(text)

    def asked(*arguments: object, **options: object) -> object:
        raise AssertionError("nothing is cheaper")

    monkeypatch.setattr(cheaper_plan, "search", asked)
    assert solve.solve_symbolic(load_symbolic(domain, problem)).cost == 11


def test_a_large_task_is_left_as_it_is(
    four_discs: solve.SymbolicProblem, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cheaper_plan, "SHORTENING_WORK", 100)
    assert len(solve.solve_symbolic(four_discs).plan) > 60
