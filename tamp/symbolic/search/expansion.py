"""The search space: the cheapest known way to each state, counts of expansions, limits."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum

from tamp.symbolic.search.heuristics.registry import Estimate, Heuristic
from tamp.symbolic.search.operators import Operator
from tamp.symbolic.search.plan_shortening import GoalPricing, eliminate_actions, free_goal
from tamp.symbolic.search.successors import State, Successors
from tamp.system.deadline import Deadline


class Reason(Enum):
    """The reason why a search ended without a plan."""

    UNSOLVABLE = "proven: no plan exists"
    LIMIT = "the limit of expanded states was reached"
    TIME = "the time is up"


AUDIT_AFTER_STATES = 500
"""States after which a search asks whether pairs of facts prove that there is no plan: most plans
are found before.
"""


@dataclass(frozen=True, slots=True)
class Plan:
    """Operators that lead from the initial state to the goal, and what they cost with all
    prices.
    """

    operators: tuple[Operator, ...]
    cost: float


class SearchLimitReached(Exception):
    """Ends a search before it has come to an end by itself."""

    def __init__(self, reason: Reason) -> None:
        self.reason = reason


class TooSlow(Exception):
    """Ends a search in plain Python that another loop takes over, from the beginning."""


class SearchSpace:
    """A search under way: its closed states with their parents, its counts and its limits.

    Attributes:
        best: The cost of the cheapest known way to each state.
        parents: For each state the one before it on that way, and the operator between them.
        bound: What no plan costs less than, as far as A* knows.
        first: What the first heuristic says of the initial state, in the lazy searches.
        progress: Expanded states when an estimate had its last new low, there.
        endurance: Expanded states without one after which it is given up.
        patience: Expanded states after which, again and again, it is asked whether it is too slow.
        too_slow: What is asked then.
    """

    patience = 50
    too_slow: Callable[[], bool] | None = None
    endurance: int | None = None

    def __init__(
        self,
        successors: Successors,
        heuristics: Sequence[Heuristic],
        limit: int | None,
        deadline: Deadline | None,
        below: float = math.inf,
        audit: Callable[[], bool] | None = None,
    ) -> None:
        self.successors = successors
        self.heuristics = tuple(heuristics)
        self.limit = limit
        self.deadline = deadline
        self.below = below
        self.audit = audit
        self.bound = 0.0
        self.first = 0.0
        self.progress = 0
        self.expanded = 0
        self.evaluated = 0
        self.best: dict[State, float] = {successors.initial: 0.0}
        self.parents: dict[State, tuple[State, int]] = {}

    def count(self) -> None:
        """Count an expansion; stop at a limit."""
        if self.limit is not None and self.expanded >= self.limit:
            raise SearchLimitReached(Reason.LIMIT)
        if self.endurance is not None and self.expanded >= self.progress + self.endurance:
            raise SearchLimitReached(Reason.LIMIT)
        if self.deadline is not None and self.deadline.passed:
            raise SearchLimitReached(Reason.TIME)
        self.expanded += 1
        if self.too_slow is not None and self.expanded % self.patience == 0 and self.too_slow():
            raise TooSlow
        if self.expanded == AUDIT_AFTER_STATES and self.audit is not None and self.audit():
            raise SearchLimitReached(Reason.UNSOLVABLE)

    def estimate(self, closed: State, parent: State | None) -> tuple[Estimate, ...]:
        """Evaluate a state by all heuristics; `parent` is the state before it, both with derived
        facts.
        """
        self.evaluated += 1
        return tuple(heuristic(closed, parent) for heuristic in self.heuristics)

    def plan(self, state: State, goal_price: GoalPricing = free_goal) -> Plan:
        """Extract the plan to a state along the parents, then eliminate the actions that it does
        not need; what is left costs no more with the goal's price.
        """
        numbers: list[int] = []
        while state in self.parents:
            state, operator = self.parents[state]
            numbers.append(operator)
        numbers, cost = eliminate_actions(self.successors, numbers[::-1], goal_price)
        return Plan(tuple(self.successors.operators[number] for number in numbers), cost)
