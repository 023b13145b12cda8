"""The search space: when a search is stopped and why, and the plan along the parents."""

from __future__ import annotations

import math

import pytest

from tamp.symbolic.search.expansion import (
    AUDIT_AFTER_STATES,
    Plan,
    Reason,
    SearchLimitReached,
    SearchSpace,
    TooSlow,
)
from tamp.symbolic.search.heuristics.registry import Estimate
from tamp.symbolic.search.successors import Successors
from tamp.system.deadline import Deadline
from tests.symbolic.search.packed.room import facts, operator, task

WAYS = [
    operator("ab", "a", "b", deleted="a", cost=2.0), operator("idle", "b", "z", cost=5.0),
    operator("bg", "b", "g", cost=3.0), operator("rest", "z", "y"),
]  # fmt: skip


def space(limit: int | None = None, deadline: Deadline | None = None) -> SearchSpace:
    return SearchSpace(Successors(task(WAYS, "g", "a"), {}), [], limit, deadline)


def counted(run: SearchSpace, most: int = 2_000) -> tuple[int, Reason | None]:
    """How many states are counted until it stops, and why."""
    try:
        for _ in range(most):
            run.count()
    except SearchLimitReached as stop:
        return run.expanded, stop.reason
    return run.expanded, None


def test_a_limit_of_states_and_the_time() -> None:
    assert counted(space(limit=7)) == (7, Reason.LIMIT)
    assert counted(space(limit=0)) == (0, Reason.LIMIT)
    assert counted(space(deadline=Deadline(0.0))) == (0, Reason.TIME)
    assert counted(space(deadline=Deadline(math.inf)), most=50) == (50, None)


def test_a_search_without_a_new_low_for_so_many_states_is_given_up() -> None:
    run = space()
    run.endurance = 3
    assert counted(run) == (3, Reason.LIMIT)
    run.progress = 2  # a new low at the second state
    assert counted(run) == (5, Reason.LIMIT)


@pytest.mark.parametrize("proven", [True, False])
def test_a_long_search_asks_once_whether_there_is_a_plan_at_all(proven: bool) -> None:
    asked: list[int] = []

    def audit() -> bool:
        asked.append(run.expanded)
        return proven

    run = space(limit=AUDIT_AFTER_STATES + 9)
    run.audit = audit
    last = AUDIT_AFTER_STATES if proven else AUDIT_AFTER_STATES + 9
    assert counted(run) == (last, Reason.UNSOLVABLE if proven else Reason.LIMIT)
    assert asked == [AUDIT_AFTER_STATES]


def test_it_is_asked_again_and_again_whether_it_is_too_slow() -> None:
    asked: list[int] = []

    def too_slow() -> bool:
        asked.append(run.expanded)
        return run.expanded >= 3 * run.patience

    run = space()
    run.patience, run.too_slow = 4, too_slow
    with pytest.raises(TooSlow):
        counted(run)
    assert asked == [4, 8, 12]


def test_all_heuristics_are_asked_and_the_state_counts_once() -> None:
    successors = Successors(task(WAYS, "g", "a"), {})
    heuristics = [lambda closed, parent, add=add: Estimate(closed + add) for add in (0.0, 0.5)]
    run = SearchSpace(successors, heuristics, None, None)
    assert [one.value for one in run.estimate(3, None)] == [3.0, 3.5]
    assert run.evaluated == 1 and run.best == {successors.initial: 0.0}


def test_the_plan_follows_the_parents_and_leaves_out_what_it_does_not_need() -> None:
    run = space()
    a, b, bz, bzg = (run.successors.mask(facts(text)) for text in ("a", "b", "b z", "b z g"))
    run.parents = {b: (a, 0), bz: (b, 1), bzg: (bz, 2)}
    assert run.plan(bzg) == Plan((WAYS[0], WAYS[2]), 5.0)
    assert run.plan(a, lambda state: 1.0) == Plan((), 0.0)
