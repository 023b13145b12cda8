"""Cheaper and cheaper plans, until one is proven to be the cheapest or the time is up."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tamp.commands.solve import SOLVED, run
from tamp.planner.pddl_only import anytime as module
from tamp.planner.pddl_only.anytime import SEARCH_LADDER, optimize_symbolic
from tamp.planner.pddl_only.problem import SymbolicProblem
from tamp.planner.pddl_only.solve import SymbolicSolution
from tamp.symbolic.algorithms.result import Outcome
from tamp.symbolic.pddl.structs import Atom
from tamp.symbolic.search.operators import NO_FACTS, Operator
from tamp.symbolic.search.search import Reason, SearchResult
from tests.planner.pddl_only.texts import SHOP, SHOPPING


def test_cheaper_plans_are_looked_for_until_one_is_the_cheapest(
    files: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (files / "shop.pddl").write_text(SHOP, encoding="utf-8")
    (files / "shopping.pddl").write_text(SHOPPING, encoding="utf-8")
    assert run(["shop.pddl", "shopping.pddl", "--optimize", "--json"]) == SOLVED
    document = json.loads(capsys.readouterr().out)
    steps = document["optimization"]
    assert document["optimal"] and document["cost"] == steps["bound"] == 9.0 and steps["gap"] == 0.0
    costs = [step["cost"] for step in steps["improvements"]]
    assert costs[-1] == 9.0 and costs == sorted(set(costs), reverse=True)
    assert run(["shop.pddl", "shopping.pddl", "--optimize"]) == SOLVED
    lines = capsys.readouterr().out.splitlines()
    assert any("no plan below" in line and "gap" in line for line in lines)
    assert any("cost 9 (optimal)" in line for line in lines)


def improving(problem: SymbolicProblem, max_time: float = 20.0) -> tuple[SymbolicSolution, Any]:
    told: list[SymbolicSolution] = []
    return optimize_symbolic(problem, max_time=max_time, improved=told.append), told


def test_each_plan_that_is_told_is_cheaper_and_the_last_one_is_proven(
    shopping: SymbolicProblem,
) -> None:
    found, told = improving(shopping)
    costs = [one.cost for one in told]
    assert costs == sorted({*costs}, reverse=True) and costs[-1] == found.cost == 9.0
    assert [cost for _, cost in found.history] == costs
    assert found.optimal and found.bound == 9.0 and found.gap == 0.0
    assert all(one.bound <= 9.0 for one in told)


def test_what_has_no_plan_is_not_improved(shopping: SymbolicProblem) -> None:
    nothing = replace(shopping.task, initial=frozenset(), goal=Atom("have", ("nothing",)))
    found, told = improving(replace(shopping, task=nothing))
    assert found.outcome is Outcome.INFEASIBLE and told == [] and found.history == ()
    late, told = improving(shopping, max_time=1e-9)
    assert late.outcome is Outcome.TIMEOUT and told == []


DEAR = ("buy-ticket", "get a", "take b", "take c", "take d")


def first(monkeypatch: pytest.MonkeyPatch, problem: SymbolicProblem) -> SymbolicSolution:
    """Let the first plan be one that costs 15."""
    costs = {"buy-ticket": 5.0, "get": 1.0, "take": 3.0}
    plan = tuple(
        Operator(name, tuple(rest), NO_FACTS, NO_FACTS, NO_FACTS, NO_FACTS, costs[name])
        for name, *rest in (text.split() for text in DEAR)
    )
    made = SymbolicSolution(
        problem, Outcome.SOLVED, "greedy", "ff", plan=plan, seconds={"total": 0.0, "search": 0.0}
    )
    monkeypatch.setattr(module, "solve_symbolic", lambda problem, max_time: made)
    return made


def test_a_dear_plan_is_improved_until_it_is_the_cheapest(
    shopping: SymbolicProblem, monkeypatch: pytest.MonkeyPatch
) -> None:
    dear = first(monkeypatch, shopping)
    found, told = improving(shopping)
    assert told[0].plan == dear.plan and len(told) >= 2
    assert found.cost == 9.0 and found.optimal and found.refuted == 0
    assert (found.search, found.heuristic) in {(one, two) for one, two, _ in SEARCH_LADDER}
    assert found.expanded > dear.expanded and found.seconds["search"] > 0.0


def test_a_refuted_plan_ends_its_search_and_is_not_kept(
    shopping: SymbolicProblem, monkeypatch: pytest.MonkeyPatch
) -> None:
    dear = first(monkeypatch, shopping)
    monkeypatch.setattr(module, "refutation", lambda task, plan: "wrong" if plan else None)
    found, told = improving(shopping)
    assert found.plan == dear.plan and len(told) == 1
    assert found.refuted == len(SEARCH_LADDER) and not found.optimal and found.bound < found.cost


def test_a_plan_as_cheap_as_the_bound_needs_no_search(
    shopping: SymbolicProblem, monkeypatch: pytest.MonkeyPatch
) -> None:
    first(monkeypatch, shopping)
    asked: list[str] = []

    def searched(task: Any, **options: Any) -> SearchResult:
        asked.append(options["search"])
        return SearchResult(None, Reason.LIMIT, 1, 1, bound=20.0)

    monkeypatch.setattr(module, "search", searched)
    found, _ = improving(shopping)
    assert asked == ["astar"] and found.bound == found.cost == 15.0 and found.optimal


def test_an_interruption_keeps_the_best_plan(
    shopping: SymbolicProblem, monkeypatch: pytest.MonkeyPatch
) -> None:
    dear = first(monkeypatch, shopping)

    def interrupted(best: SymbolicSolution) -> None:
        raise KeyboardInterrupt

    found = optimize_symbolic(shopping, max_time=20.0, improved=interrupted)
    assert found.solved and found.plan == dear.plan and not found.optimal
