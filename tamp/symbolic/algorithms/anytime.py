"""Anytime planning: cheaper skeletons first, then other values for a part of the plan at a time."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Any

from tamp.symbolic.algorithms.adaptive import (
    FIRST_TRIES,
    ROUND_DRAWS,
    plan_adaptively,
    start_adaptive,
)
from tamp.symbolic.algorithms.binding.skeleton import Skeleton
from tamp.symbolic.algorithms.knowledge import restore_objects
from tamp.symbolic.algorithms.outcomes import solved_result
from tamp.symbolic.algorithms.planning_run import (
    Run,
    bind_skeleton,
    renew,
    search_plan,
    skeleton_of,
)
from tamp.symbolic.algorithms.priced_search import lower_bound
from tamp.symbolic.algorithms.result import Outcome, Progress, Result, StreamTask
from tamp.system.deadline import Deadline, OutOfTime

MAX_BOUND_STATES = 30
"""States that are expanded for the lower bound."""

CHEAPER_PLAN_WEIGHTS = (2.0, 1.0)
"""Of the estimate in searches for cheaper plans, in turn."""

MAX_VAIN_SEARCHES = 10
"""Searches for a cheaper plan that may come to nothing between two plans that are better."""

ACTIONS_DRAWN_ANEW = 4
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
    run = start_adaptive(problem, make_rng, deadline, progress)
    first = plan_adaptively(run)
    if first.outcome is not Outcome.SOLVED:
        return first
    better(first)

    bound = _lower_bound(run)
    bounded(bound)

    best, vain = first, 0
    while best.skeleton is not None and best.actions and not deadline.passed:
        cost = sum(action.cost for action in best.actions)
        skeleton, memory = best.skeleton, dict(best.skeleton.memory)
        found = None
        if cost > bound + 1e-9 and vain < MAX_VAIN_SEARCHES:
            vain += 1
            found = _cheaper(run, CHEAPER_PLAN_WEIGHTS[vain % len(CHEAPER_PLAN_WEIGHTS)], cost)

        if found is None:
            found = _redrawn(run, skeleton, choose)
        if found is not None and better(found):
            best, vain = found, 0
        else:
            skeleton.memory = memory
        progress(run.effort)

    if deadline.passed:
        raise OutOfTime
    return best


def _lower_bound(run: Run) -> float:
    """Bound any plan's cost from below, with nothing left out of the optimistic task."""
    if restore_objects(run.knowledge):
        renew(run)
    with run.effort.searching():
        return lower_bound(run.optimistic, MAX_BOUND_STATES, run.deadline)


def _cheaper(run: Run, weight: float, cost: float) -> Result | None:
    """Find and bind a plan that costs less."""
    found = search_plan(run, weight=weight, below=cost - 1e-9)
    if found is None:
        return None
    skeleton = skeleton_of(run, found)
    tries, draws = FIRST_TRIES + skeleton.rounds, ROUND_DRAWS * (1 + skeleton.rounds)
    values = bind_skeleton(run, skeleton, tries, draws)
    skeleton.rounds += 1
    return None if values is None else solved_result(run, skeleton, values)


def _redrawn(run: Run, skeleton: Skeleton, choose: Random) -> Result | None:
    """Bind the plan anew with other values for what a few of its actions in a row need."""
    first = choose.randrange(1 - ACTIONS_DRAWN_ANEW, max(1, len(skeleton.steps)))
    chosen = {
        number
        for number, node in enumerate(skeleton.nodes)
        if not node.stream.is_test and first <= node.step < first + ACTIONS_DRAWN_ANEW
    }
    if not chosen:
        return None
    values = bind_skeleton(run, skeleton, 1, len(skeleton.nodes), fresh=chosen)
    return None if values is None else solved_result(run, skeleton, values)
