"""Escalation: the fallbacks of the adaptive algorithm when its rounds make no progress."""

from __future__ import annotations

import time
from dataclasses import dataclass

from tamp.symbolic.algorithms.incremental import (
    MAX_DRY_ROUNDS,
    plan_incrementally,
    start_incremental,
)
from tamp.symbolic.algorithms.knowledge import restore_objects
from tamp.symbolic.algorithms.optimistic.anything import distinguishes
from tamp.symbolic.algorithms.optimistic.optimistic_task import raise_depth_limit
from tamp.symbolic.algorithms.outcomes import end_result
from tamp.symbolic.algorithms.planning_run import Run, renew
from tamp.symbolic.algorithms.result import Outcome, Result
from tamp.system.deadline import OutOfTime

FAILURES_BEFORE_SECOND_OPINION = 1000
"""Failures of one thing without a success after which the incremental algorithm is asked; doubled
each time. At least as many as there are operators: it draws for all of them."""

DRAWS_PER_FAILURE = 2
"""Draws that it gets for each of those failures."""

ROUNDS_BEFORE_SECOND_OPINION = 10
"""Rounds after which it is asked as well, doubled each time, where rounds draw little and operators
are many: streams that give one value and end have each plan of a tree tried in turn, while calling
all of them is cheap."""

FEW_DRAWS_PER_ROUND = 20
"""Draws a round that are little; the incremental algorithm gets ten times as many."""

MANY_OPERATORS = 1000
"""Operators that are many."""

ROUNDS_BEFORE_DEEPER = 20
"""Rounds after which instances that were kept shallow go one level deeper, doubled each time."""

DRAWS_BEFORE_INFEASIBLE = 100
"""Draws for a look at real values before a task counts as infeasible whose values may have to
differ."""


@dataclass
class Escalation:
    """Counts of rounds in vain, and the limits at which something else is tried.

    Attributes:
        dry_rounds: Rounds in a row that drew nothing.
        failures: Of one thing without a success, before a second opinion.
        wandering_rounds: That draw little, before a second opinion.
        shallow_searches: Before shallow instances go one level deeper.
    """

    dry_rounds: int = 0
    failures: int = FAILURES_BEFORE_SECOND_OPINION
    wandering_rounds: int = ROUNDS_BEFORE_SECOND_OPINION
    shallow_searches: int = ROUNDS_BEFORE_DEEPER


def escalate(run: Run, escalation: Escalation, drew: bool) -> Result | None:
    """Instantiate more, or ask the incremental algorithm, where it is time to; say if that ends it.

    Args:
        run: The run, after a round in vain.
        escalation: When it is time to; counts on.
        drew: Whether the round drew anything.
    """
    escalation.dry_rounds = 0 if drew else escalation.dry_rounds + 1
    dry = escalation.dry_rounds >= MAX_DRY_ROUNDS
    limited = run.knowledge.depth_limit is not None
    if dry or (limited and run.effort.searches >= escalation.shallow_searches):
        escalation.shallow_searches *= 2
        if instantiate_more(run):
            escalation.dry_rounds = 0
        elif dry:
            return end_result(run, Outcome.EXHAUSTED)

    draws = 0
    failures = max(escalation.failures, len(run.optimistic.instantiated.operators))
    if _keeps_failing(run, failures):
        draws = DRAWS_PER_FAILURE * failures
        escalation.failures = 2 * failures
    elif escalation.dry_rounds == 0 and _draws_little(run, escalation.wandering_rounds):
        draws = 10 * FEW_DRAWS_PER_ROUND * escalation.wandering_rounds
        escalation.wandering_rounds *= 2

    result = _second_opinion(run, draws) if draws else None
    ends = result is not None and result.outcome in (Outcome.SOLVED, Outcome.INTERRUPTED)
    return result if ends else None


def instantiate_more(run: Run) -> bool:
    """Instantiate excluded objects, or else deeper; say if there was more to instantiate."""
    more = restore_objects(run.knowledge) or raise_depth_limit(run.knowledge, run.optimistic)
    if more:
        renew(run)
    return more


def look_at_real_values(run: Run) -> Result | None:
    """Look for a plan with two values of one call, which placeholders, one value each, hide.

    Where the goal is out of reach even if nothing is ever undone, and no condition wants values to
    differ, there is none. Else real values are looked at, a few; if these are all that there are,
    and plans with them fail in the states that they lead through, nothing is proven.
    """
    problem = run.task.problem
    hidden = run.optimistic.goal_is_reachable or distinguishes(run.task.task)
    if problem.by_value or not problem.streams or not hidden:
        # whoever has values equal that come from different calls looks more closely
        return None

    second = start_incremental(problem, run.make_rng, run.deadline, run.progress)
    second.brief = True
    second.streams.remember(run.streams)
    try:
        result = plan_incrementally(second, DRAWS_BEFORE_INFEASIBLE)
    except OutOfTime:
        return None

    result.skeleton = None
    exhausted = result.outcome is Outcome.EXHAUSTED
    run.knowledge.incomplete |= exhausted and second.binder.draws < DRAWS_BEFORE_INFEASIBLE
    return result if result.outcome in (Outcome.SOLVED, Outcome.INTERRUPTED) else None


def _second_opinion(run: Run, draws: int) -> Result:
    """Run the incremental algorithm for a while; each is told the time that the other took."""
    began = time.perf_counter()
    try:
        second = start_incremental(run.task.problem, run.make_rng, run.deadline, run.progress)
        second.streams.remember(run.streams)
        result = plan_incrementally(second, draws)
        result.skeleton = None
        result.effort.apart_seconds = max(
            0.0, run.deadline.elapsed() - (time.perf_counter() - began)
        )
        return result
    finally:
        run.effort.apart_seconds += time.perf_counter() - began


def _draws_little(run: Run, rounds: int) -> bool:
    """Check that so many rounds went from plan to plan in a large task and drew little."""
    few = run.binder.draws < FEW_DRAWS_PER_ROUND * rounds
    many = len(run.optimistic.instantiated.operators) >= MANY_OPERATORS
    return run.effort.searches >= rounds and few and many


def _keeps_failing(run: Run, failures: int) -> bool:
    """Check that even the cheapest plan rests on what failed that often without a success."""
    nodes = () if run.latest is None else run.latest.nodes
    records = [run.knowledge.experience.facts.get(node.fact) for node in nodes]
    return any(
        record and not record.successes and record.failures >= failures for record in records
    )
