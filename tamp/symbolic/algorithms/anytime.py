"""Anytime planning: cheaper skeletons first, then other values for a part of the plan at a time."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Any

from tamp.symbolic.algorithms.adaptive import FIRST_TRIES, ROUND_BUDGET, Adaptive
from tamp.symbolic.algorithms.binding.skeleton import Skeleton
from tamp.symbolic.algorithms.result import Outcome, Progress, Result, StreamTask
from tamp.system.deadline import Deadline, OutOfTime

BOUND_LIMIT = 30
"""States that are expanded for the lower bound."""

WEIGHTS = (2.0, 1.0)
"""Of the estimate in searches for cheaper plans, in turn."""

VAIN = 10
"""Searches for a cheaper plan that may come to nothing between two plans that are better."""

WINDOW = 4
"""Actions whose values are drawn anew at a time: a body's way from place to place."""

Better = Callable[[Result], bool]
"""Told each plan; says whether it is the best so far."""


def solve_anytime(
    problem: StreamTask,
    make_rng: Callable[[str], Any],
    deadline: Deadline,
    progress: Progress,
    better: Better,
    bounded: Callable[[float], None],
    choose: Random,
) -> Result:
    """Plan as `solve_adaptive` does, then improve the plan until the time is up.

    Args:
        problem: The task and its streams.
        make_rng: A random generator from a string (see Streams).
        deadline: When to end.
        progress: Told between rounds.
        better: Told every plan; what it calls better is built upon.
        bounded: Told a lower bound of the cost, after the first plan: no plan of the optimistic
            task is cheaper, whatever values the streams find for it.
        choose: Says which part of the plan is next.

    Returns:
        What ended the search for the first plan; after that nothing but the time ends it, by
        OutOfTime.
    """
    run = Adaptive(problem, make_rng, deadline, progress)
    first = run.solve()
    if first.outcome is not Outcome.SOLVED:
        return first
    better(first)

    bound = run.lower_bound(BOUND_LIMIT)
    bounded(bound)

    best, vain = first, 0
    while run.bound is not None and best.actions and not deadline.passed:
        cost = sum(action.cost for action in best.actions)
        found = None
        if cost > bound + 1e-9 and vain < VAIN:
            vain += 1
            found = _cheaper(run, WEIGHTS[vain % len(WEIGHTS)], cost)

        skeleton, memory = run.bound[0], dict(run.bound[0].memory)
        if found is None:
            found = _redrawn(run, skeleton, choose)
        if found is not None and better(found[0]):
            best, run.bound, vain = found[0], found[1], 0
        else:
            skeleton.memory = memory
        progress(run.effort)
    if deadline.passed:
        raise OutOfTime
    return best


_Found = tuple[Result, tuple[Skeleton, dict[int, str]]]


def _cheaper(run: Adaptive, weight: float, cost: float) -> _Found | None:
    """Find and bind a plan that costs less."""
    plan = run.search(weight=weight, below=cost - 1e-9).plan
    if plan is None:
        return None
    skeleton = run.skeleton(plan)
    values = run.bind(skeleton, FIRST_TRIES + skeleton.rounds, ROUND_BUDGET * (1 + skeleton.rounds))
    skeleton.rounds += 1
    return _found(run, skeleton, values)


def _redrawn(run: Adaptive, skeleton: Skeleton, choose: Random) -> _Found | None:
    """Bind the plan anew with other values for what a few of its actions in a row need."""
    first = choose.randrange(1 - WINDOW, max(1, len(skeleton.steps)))
    chosen = {
        number
        for number, node in enumerate(skeleton.nodes)
        if not node.stream.is_test and first <= node.step < first + WINDOW
    }
    return _found(
        run, skeleton, run.bind(skeleton, 1, len(skeleton.nodes), fresh=chosen) if chosen else None
    )


def _found(run: Adaptive, skeleton: Skeleton, values: dict[int, str] | None) -> _Found | None:
    return None if values is None else (run.solved(skeleton, values), (skeleton, values))
