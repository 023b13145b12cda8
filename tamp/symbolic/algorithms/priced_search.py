"""Search of the optimistic task under prices that experience sets, and bounds of plans' costs."""

from __future__ import annotations

import math
import time

from tamp.symbolic.algorithms.binding.skeleton_steps import with_nogoods
from tamp.symbolic.algorithms.experience.elsewhere import elsewhere
from tamp.symbolic.algorithms.experience.exploration_prices import doubts
from tamp.symbolic.algorithms.experience.stream_statistics import Experience
from tamp.symbolic.algorithms.optimistic.optimistic_task import Imagination
from tamp.symbolic.algorithms.result import StreamTask
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.mutex import excluded
from tamp.symbolic.search.operators import InstantiatedTask
from tamp.symbolic.search.search import Reason, search
from tamp.symbolic.search.search import Result as Found
from tamp.system.deadline import Deadline

SEARCH_LIMIT = 2000
"""States that a search may expand in looking for a cheap plan; after that the first plan is
taken."""


class PricedSearch(Imagination):
    """The optimistic task, and searches in it that avoid what failed.

    Attributes:
        brief: Whether searches end without a plan where they have seen SEARCH_LIMIT states.
    """

    brief = False

    def __init__(self, problem: StreamTask, deadline: Deadline, pruned: bool) -> None:
        self.deadline = deadline
        super().__init__(problem, pruned)
        self.experience = Experience()
        self.doubtful = False
        self._audited: InstantiatedTask | None = None
        self.prices: dict[Fact, float] = {}
        self.searched = self.instantiated

    def search(self, *, weight: float = 5.0, below: float = math.inf) -> Found:
        """Search for a plan of the optimistic task, priced by experience.

        Args:
            weight: Of the estimate: with less the plans are cheaper and the search is longer.
            below: What the actions of the plan must cost less than; when it is given, there is one
                try only.
        """
        started = time.perf_counter()
        try:
            return self._search(weight, below)
        finally:
            self.effort.search_seconds += time.perf_counter() - started

    def _search(self, weight: float, below: float) -> Found:
        self.effort.searches += 1
        if self.doubtful and self.excluded():
            return Found(None, Reason.UNSOLVABLE, 0, 0, math.inf)

        instantiated, prices = with_nogoods(self.instantiated, self.experience)
        self.searched = instantiated = elsewhere(instantiated, self.experience, self.optimism)
        prices |= (
            doubts(self.optimism, self.experience, self.problem.known) | self.experience.prices()
        )

        unit = self._usual_cost()
        if unit > 1.0:
            prices = {fact: unit * price for fact, price in prices.items()}
        self.prices = prices

        found = search(
            instantiated, price=prices, limit=SEARCH_LIMIT, deadline=self.deadline, weight=weight,
            below=below, audit=self.excluded,
        )  # fmt: skip
        self.effort.expanded += found.expanded
        if found.reason is Reason.LIMIT and below == math.inf and not self.brief:
            # with many prices many plans look alike: then any plan will do
            found = search(instantiated, search="greedy", price=prices, deadline=self.deadline)
            self.effort.expanded += found.expanded
        return found

    def excluded(self) -> bool:
        """Check that goals are proven to exclude each other in the optimistic task."""
        if self._audited is self.instantiated:
            return False
        self._audited = self.instantiated
        return excluded(self.instantiated, self.deadline) is not None

    def lower_bound(self, limit: int) -> float:
        """Bound any plan's cost from below, seeing `limit` states; 0 if guesses are missing."""
        self.recall()
        started = time.perf_counter()
        found = search(
            self.instantiated,
            search="astar",
            heuristic="lmcut",
            limit=limit,
            deadline=self.deadline,
        )
        self.effort.search_seconds += time.perf_counter() - started
        return found.bound if self.optimism.complete else 0.0

    def _usual_cost(self) -> float:
        """Compute the operators' mean cost, the unit of prices where actions cost more than one."""
        operators = self.instantiated.operators
        return sum(operator.cost for operator in operators) / len(operators) if operators else 1.0
