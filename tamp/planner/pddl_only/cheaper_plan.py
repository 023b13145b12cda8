"""A cheaper plan than greedy search's, by weighted A*, as long as that is quickly done."""

from __future__ import annotations

from dataclasses import replace

from tamp.symbolic.pddl.structs import Task
from tamp.symbolic.search.operators import InstantiatedTask
from tamp.symbolic.search.replay import REFUTED_TEXT, violation
from tamp.symbolic.search.search import Plan, Reason, SearchResult, search
from tamp.system.deadline import Deadline, OutOfTime

SHORTENING_WORK = 500_000
"""What a search for a shorter plan goes through at most, in states times preconditions of all
operators: a tenth of a second."""

STRAIGHT_SEARCH_STATES = 600
"""Expanded states of a greedy search that went straight to the goal: then some times as many, each
of which may take ten times as long, are worth a plan that takes no detours:"""

STATES_AFTER_STRAIGHT_FACTOR = 4

COSTLY_PLAN_FACTOR = 1.5
"""Cost of a plan, as a multiple of the initial state's estimate, from which on a cheaper one is
looked for as long as the search makes progress. One that costs no more than the estimate is left
alone."""

COSTLY_PLAN_STATES_FACTOR = 5
"""How many times as many states as the first plan took are then seen at most."""

STALLED_STATES_PER_ACTION = 2
"""States without progress after which that is given up, for each action of the first plan."""

MIN_STATES_PER_ACTION = 2
"""States for each action of the first plan below which no search for another one is begun."""

SHORTENING_WEIGHTS = (2.0, 5.0)
"""Of the estimates in the search for a shorter plan: the next where the last has found none."""


def cheaper_plan(
    task: Task, instantiated: InstantiatedTask, found: SearchResult, deadline: Deadline
) -> SearchResult:
    """Look for a cheaper plan than greedy search's, as long as that is quickly done.

    Windows of a plan cannot be cut where each step enables the next; another search finds a plan of
    half the length (weighted A*, cf. Richter, Thayer, Ruml, The joy of forgetting, 2010).
    """
    if found.plan is None:
        return found
    length, cost = len(found.plan.operators), sum(one.cost for one in found.plan.operators)
    if cost <= found.estimate:
        return found
    limits = dict.fromkeys(SHORTENING_WEIGHTS, _worthwhile_states(instantiated, found))
    endurance = None
    if cost >= COSTLY_PLAN_FACTOR * found.estimate:
        limits[SHORTENING_WEIGHTS[0]] = max(
            limits[SHORTENING_WEIGHTS[0]], COSTLY_PLAN_STATES_FACTOR * found.expanded
        )
        endurance = max(STALLED_STATES_PER_ACTION * length, limits[SHORTENING_WEIGHTS[1]])

    for weight, limit in limits.items():
        if limit < MIN_STATES_PER_ACTION * length:
            break
        try:
            better = search(
                instantiated, search="wastar", weight=weight, limit=limit, endurance=endurance,
                deadline=deadline, below=cost - 1e-9,
            )  # fmt: skip
        except OutOfTime:
            break
        counts = {
            "expanded": found.expanded + better.expanded,
            "evaluated": found.evaluated + better.evaluated,
        }
        if better.plan is not None and refutation(task, better.plan) is None:
            return replace(better, **counts)
        found = replace(found, **counts)
        if better.reason is Reason.UNSOLVABLE:
            break  # nothing is cheaper
    return found


def _worthwhile_states(instantiated: InstantiatedTask, found: SearchResult) -> int:
    """Return how many states a search for a cheaper plan is worth, whatever that costs."""
    entries = max(1, sum(1 + len(operator.positive) for operator in instantiated.operators))
    limit = SHORTENING_WORK // entries
    if found.expanded <= STRAIGHT_SEARCH_STATES:
        limit = max(
            limit,
            min(STATES_AFTER_STRAIGHT_FACTOR * found.expanded, 10 * SHORTENING_WORK // entries),
        )
    return limit


def refutation(task: Task, plan: Plan | None) -> str | None:
    """Replay a plan by the book and word what is wrong with it, as a line for people; None where
    it holds.
    """
    if plan is None:
        return None
    reason = violation(task, [(operator.name, operator.arguments) for operator in plan.operators])
    return None if reason is None else f"{REFUTED_TEXT}: {reason}"
