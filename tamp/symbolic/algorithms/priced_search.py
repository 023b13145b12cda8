"""Search of the optimistic task under prices that experience sets, and bounds of plans' costs."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from tamp.symbolic.algorithms.binding.skeleton_steps import with_nogoods
from tamp.symbolic.algorithms.experience.exploration_prices import exploration_prices
from tamp.symbolic.algorithms.experience.failing_states import avoid_failing_states
from tamp.symbolic.algorithms.experience.stream_statistics import Experience
from tamp.symbolic.algorithms.experience.success_posterior import Posterior
from tamp.symbolic.algorithms.optimistic.optimistic_task import OptimisticTask
from tamp.symbolic.algorithms.result import SearchStatistics
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.mutex import excluded
from tamp.symbolic.search.operators import InstantiatedTask
from tamp.symbolic.search.search import Plan, Reason, search
from tamp.system.deadline import Deadline

SEARCH_LIMIT = 2000
"""States that a search may expand in looking for a cheap plan; after that the first plan is
taken."""

FIRST_PLAN_WEIGHT = 5.0
"""Of the estimate in the search for a first plan."""


@dataclass(frozen=True, eq=False)
class PricedPlan:
    """A plan, the task in which it was found, and the prices that it was found under.

    Attributes:
        plan: Of the optimistic task.
        task: That task, guarded by what binding has learned.
        prices: Of its static facts, where they are not free.
        expanded: States that the search took which found it.
    """

    plan: Plan
    task: InstantiatedTask
    prices: Mapping[Fact, float]
    expanded: int = 0


def priced_search(
    optimistic: OptimisticTask,
    experience: Experience,
    posteriors: Mapping[str, Posterior],
    deadline: Deadline,
    audit: Callable[[], bool],
    effort: SearchStatistics,
    *,
    weight: float = FIRST_PLAN_WEIGHT,
    below: float = math.inf,
    brief: bool = False,
    seed: int = 0,
) -> PricedPlan | None:
    """Search for a plan that avoids what failed.

    Args:
        optimistic: The task to search in.
        experience: Says what failed.
        posteriors: What earlier runs say of streams, by name.
        deadline: When to give up.
        audit: Asked in a long search whether it is proven that there is no plan.
        effort: Is told of the states that were expanded.
        weight: Of the estimate: with less the plans are cheaper and the search is longer.
        below: What the actions of the plan must cost less than; when it is given, there is one try
            only.
        brief: End without a plan after SEARCH_LIMIT states.
        seed: Of the orders in which a search that stalls begins anew.
    """
    guarded, prices = with_nogoods(optimistic.instantiated, experience)
    task = avoid_failing_states(guarded, experience, optimistic.facts)
    prices |= exploration_prices(optimistic.facts, experience, posteriors) | experience.prices()

    unit = mean_action_cost(optimistic.instantiated)
    if unit > 1.0:
        prices = {fact: unit * price for fact, price in prices.items()}

    patience = experience.patience
    any_will_do = below == math.inf and not brief
    found = None
    if not (any_will_do and patience.skips()):
        found = search(
            task, price=prices, limit=SEARCH_LIMIT, deadline=deadline, weight=weight, below=below,
            audit=audit,
        )  # fmt: skip
        effort.expanded += found.expanded
        if any_will_do:
            patience.note(in_vain=found.reason is Reason.LIMIT)
    if found is None or (found.reason is Reason.LIMIT and any_will_do):
        # with many prices many plans look alike: then any plan will do
        found = search(task, search="greedy", price=prices, deadline=deadline, seed=seed)
        effort.expanded += found.expanded
    return None if found.plan is None else PricedPlan(found.plan, task, prices, found.expanded)


def mean_action_cost(task: InstantiatedTask) -> float:
    """Compute the operators' mean cost, the unit of prices where actions cost more than one."""
    operators = task.operators
    return sum(operator.cost for operator in operators) / len(operators) if operators else 1.0


def exclude_each_other(task: InstantiatedTask, deadline: Deadline) -> bool:
    """Check that goals are proven to exclude each other."""
    return excluded(task, deadline) is not None


def lower_bound(optimistic: OptimisticTask, limit: int, deadline: Deadline) -> float:
    """Bound any plan's cost from below, seeing `limit` states; 0 if instances are missing."""
    found = search(
        optimistic.instantiated, search="astar", heuristic="lmcut", limit=limit, deadline=deadline
    )
    return found.bound if optimistic.facts.complete else 0.0
