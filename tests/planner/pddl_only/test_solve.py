"""A search, its plan replayed, and how it ended."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from tamp.errors import InputError
from tamp.planner.pddl_only import solve as module
from tamp.planner.pddl_only.problem import SymbolicProblem
from tamp.planner.pddl_only.solve import (
    DEFAULT_SEARCH,
    FALLBACK_SEARCHES,
    SymbolicSolution,
    choose,
    solve_symbolic,
)
from tamp.symbolic.algorithms.cause import CauseKind
from tamp.symbolic.algorithms.result import Outcome
from tamp.symbolic.pddl.structs import Atom
from tamp.symbolic.search.operators import NO_FACTS, Operator


@pytest.mark.parametrize(
    ("asked", "chosen"),
    [
        ((None, None), ("greedy", "ff+landmarks")),
        (("eager", None), ("eager", "ff+landmarks")),
        (("astar", None), ("astar", "lmcut")),
        (("astar", "hadd"), ("astar", "hadd")),
        ((None, "blind"), ("greedy", "blind")),
    ],
)
def test_an_optimal_search_has_an_admissible_estimate_unless_another_is_named(
    asked: tuple[str | None, str | None], chosen: tuple[str, str]
) -> None:
    assert choose(*asked) == chosen


@pytest.mark.parametrize(
    ("asked", "said"),
    [(("fastest", None), "unknown search 'fastest'"), ((None, "lmct"), "Did you mean 'lmcut'")],
)
def test_unknown_names_are_refused(asked: tuple[str | None, str | None], said: str) -> None:
    with pytest.raises(InputError, match=said):
        choose(*asked)


@pytest.mark.parametrize(
    ("search", "heuristic", "optimal"),
    [
        ("greedy", None, False),
        ("astar", None, True),
        ("astar", "blind", True),
        ("astar", "hmax", True),
        ("astar", "hadd", False),
        ("astar", "lmcut+hadd", False),
    ],
)
def test_only_what_is_proven_is_called_optimal(
    errands: SymbolicProblem, search: str, heuristic: str | None, optimal: bool
) -> None:
    solution = solve_symbolic(errands, search=search, heuristic=heuristic)
    assert solution.solved and solution.optimal is optimal and solution.refuted == 0
    assert solution.cost >= 15.0 and (solution.cost == 15.0 or not optimal)
    assert solution.search == search and solution.causes == ()


def test_a_goal_that_nothing_reaches_is_infeasible_with_its_cause(errands: SymbolicProblem) -> None:
    goal = Atom("unused", ("van",))
    solution = solve_symbolic(replace(errands, task=replace(errands.task, goal=goal)))
    assert solution.outcome is Outcome.INFEASIBLE and solution.plan == () and not solution.solved
    assert "(unused van)" in solution.explanation[0]
    assert solution.causes[0].kind is CauseKind.UNREACHABLE


def test_without_time_there_is_no_plan(errands: SymbolicProblem) -> None:
    solution = solve_symbolic(errands, max_time=1e-9)
    assert solution.outcome is Outcome.TIMEOUT and solution.plan == ()


def test_the_users_interruption_is_an_outcome(
    errands: SymbolicProblem, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: Any, **__: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(module, "search", interrupted)
    assert solve_symbolic(errands).outcome is Outcome.INTERRUPTED


def refuting(monkeypatch: pytest.MonkeyPatch, times: int) -> list[int]:
    """Let so many plans be refuted; the numbers of those that are looked at."""
    seen: list[int] = []

    def refutation(task: Any, plan: Any) -> str | None:
        seen.append(len(seen))
        return f"wrong {len(seen)}" if len(seen) <= times else None

    monkeypatch.setattr(module, "refutation", refutation)
    return seen


@pytest.mark.parametrize("times", [1, 2])
def test_where_a_plan_does_not_hold_another_search_goes_on(
    errands: SymbolicProblem, monkeypatch: pytest.MonkeyPatch, times: int
) -> None:
    seen = refuting(monkeypatch, times)
    solution = solve_symbolic(errands, search="astar")
    assert solution.solved and solution.refuted == times and len(seen) == times + 1
    assert (solution.search, solution.heuristic) == FALLBACK_SEARCHES[times - 1]
    assert not solution.optimal
    assert solution.explanation == tuple(f"wrong {n}" for n in range(1, times + 1))
    assert all(cause.kind is CauseKind.REFUTED for cause in solution.causes)


def test_plans_that_are_all_refuted_are_none(
    errands: SymbolicProblem, monkeypatch: pytest.MonkeyPatch
) -> None:
    refuting(monkeypatch, 99)
    solution = solve_symbolic(errands)
    assert solution.outcome is Outcome.EXHAUSTED and solution.plan == ()
    assert solution.refuted == 1 + len(FALLBACK_SEARCHES) == len(solution.causes)


@pytest.mark.parametrize(("search", "shortened"), [(None, True), ("eager", False)])
def test_only_the_default_searchs_plan_is_shortened(
    errands: SymbolicProblem, monkeypatch: pytest.MonkeyPatch, search: str | None, shortened: bool
) -> None:
    asked: list[Any] = []

    def cheaper(task: Any, instantiated: Any, found: Any, deadline: Any) -> Any:
        asked.append(found)
        return found

    monkeypatch.setattr(module, "cheaper_plan", cheaper)
    assert solve_symbolic(errands, search=search).solved and DEFAULT_SEARCH == "greedy"
    assert bool(asked) is shortened


@pytest.mark.parametrize(
    ("costs", "bound", "gap"),
    [((3.0, 1.0), 3.0, 0.25), ((3.0, 1.0), 4.0, 0.0), ((3.0,), 5.0, 0.0), ((), 0.0, 0.0)],
)
def test_the_gap_is_the_share_of_the_cost_above_the_bound(
    errands: SymbolicProblem, costs: tuple[float, ...], bound: float, gap: float
) -> None:
    plan = tuple(Operator("go", (), NO_FACTS, NO_FACTS, NO_FACTS, NO_FACTS, one) for one in costs)
    made = SymbolicSolution(errands, Outcome.SOLVED, "astar", "lmcut", plan=plan, bound=bound)
    assert (made.cost, made.gap) == (sum(costs), gap)
