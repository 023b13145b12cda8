"""Lazy weighted A* and greedy search with preferred operators and deferred evaluation."""

from __future__ import annotations

import math

from tamp.symbolic.search.expansion import Plan, SearchSpace
from tamp.symbolic.search.heuristics.goal_price import GoalPrice
from tamp.symbolic.search.heuristics.registry import Estimate
from tamp.symbolic.search.open_lists import GOAL_ENTRY, Expanded, OpenLists, Plateau
from tamp.symbolic.search.successors import State, Successors


def lazy(search: SearchSpace, weight: float) -> Plan | None:
    """Search with deferred evaluation: a state is evaluated when it is expanded, not when found.

    Until then its parent's estimate stands for it. `weight` infinite is greedy search: costs do not
    count. A goal state whose goal rests on priced facts waits until nothing that is cheaper than it
    is left in an open list; one whose goal rests on facts of infinite price is none.
    """
    run = _LazySearch(search, weight)
    while (entry := run.open.pop()) is not None:
        _, order, cost, state, parent, operator = entry
        if run.is_goal(state, operator):
            return search.plan(state, run.goal_price)
        if run.is_closed(state, cost):
            continue

        closed = run.close(state, cost, parent, operator)
        price = run.goal_price(state) if search.successors.holds_goal(closed) else math.inf
        if price == 0.0:
            return search.plan(state, run.goal_price)
        if price < math.inf:
            run.keep_goal(state, cost, price)
            continue

        node = run.evaluate(state, closed, cost, parent)
        if math.inf not in node.values:
            run.place(node, parent, order)
            run.expand(node, closed)
    return None


class _LazySearch:
    """A lazy search under way: its open lists, its closed states and what was estimated of them."""

    def __init__(self, search: SearchSpace, weight: float) -> None:
        self._search = search
        self._successors = s = search.successors
        self._greedy = weight == math.inf
        self.open = OpenLists(s.initial, len(search.heuristics), weight)
        self.goal_price = GoalPrice(s)
        self._goal: State | None = None
        self._goal_cost = math.inf
        self._closed: dict[State, float] = {}
        self._spent = {s.initial: 0.0}  # what the operators on the way have cost, prices aside
        self._estimates: dict[State, tuple[Estimate, ...]] = {}
        self._plateaus: dict[State, Plateau] = {}

    def is_goal(self, state: State, operator: int) -> bool:
        """Check that an entry is the cheapest goal state, whose turn has come."""
        return operator == GOAL_ENTRY and state == self._goal

    def is_closed(self, state: State, cost: float) -> bool:
        """Check that a state was closed at no higher cost; greedy search reopens none."""
        closed_at = self._closed.get(state)
        return closed_at is not None and (self._greedy or cost >= closed_at)

    def close(self, state: State, cost: float, parent: State | None, operator: int) -> State:
        """Close a state: note the way to it; return it with its derived facts."""
        self._closed[state] = cost
        self._search.best[state] = cost
        if parent is not None:
            self._search.parents[state] = (parent, operator)
            spent = self._spent[parent] + self._successors.operators[operator].cost
            self._spent[state] = spent
        return self._successors.closure(state)

    def keep_goal(self, state: State, cost: float, price: float) -> None:
        """Have a goal state whose goal costs something wait for a cheaper one."""
        if cost + price < self._goal_cost:
            self._goal, self._goal_cost = state, cost + price
            self.open.push_goal(state, self._goal_cost, price)

    def evaluate(self, state: State, closed: State, cost: float, parent: State | None) -> Expanded:
        """Evaluate a state, once."""
        estimates = self._estimates.get(state)
        if estimates is None:
            before = None if parent is None else self._successors.closure(parent)
            estimates = self._estimates[state] = self._search.estimate(closed, before)
            if parent is None:
                self._search.first = estimates[0].value
        return Expanded(state, cost, estimates, tuple(one.value for one in estimates))

    def place(self, node: Expanded, parent: State | None, order: int) -> None:
        """Note where greedy search has come to: how far from the last progress."""
        if not self._greedy:
            return
        number = len(self._closed) - 1
        before = None if parent is None else self._plateaus[parent]
        self._plateaus[node.state] = (
            Plateau(number, number, 0, node.values)
            if before is None
            else before.after(number, order, node.values)
        )

    def expand(self, node: Expanded, closed: State) -> None:
        """Expand a state: push its successors, those by preferred operators first."""
        search, s, greedy = self._search, self._successors, self._greedy
        state, cost = node.state, node.cost
        search.count()
        if self.open.boost(node.values):
            search.progress = search.expanded
        applicable = s.applicable(closed)
        helpful = _helpful(s, state, closed, applicable, node.estimates)
        spent, plateau = self._spent[state], self._plateaus.get(state)

        for rank, operator in enumerate((*helpful, *applicable)):
            preferred = rank < len(helpful)
            if not preferred and operator in helpful:
                continue
            if spent + s.operators[operator].cost >= search.below:
                continue

            after, step = s.apply(operator, state, closed), s.cost[operator]
            closed_at = self._closed.get(after)
            if closed_at is not None and (greedy or cost + step >= closed_at):
                continue
            reached = cost + s.step_cost(operator, state)
            if reached == math.inf or (closed_at is not None and reached >= closed_at):
                continue

            # Among equals greedy search takes what is nearest to the newest progress, weighted A*
            # the older.
            order = None if plateau is None else plateau.order(rank)
            self.open.push(node, operator, after, reached, step, order, preferred)


def _helpful(
    s: Successors,
    state: State,
    closed: State,
    applicable: list[int],
    estimates: tuple[Estimate, ...],
) -> dict[int, None]:
    """Return the preferred operators, the applicable ones of the relaxed plans, the best first."""
    helpful: dict[int, None] = {}
    for estimate in estimates:
        if estimate.plan:
            helpful.update(_preferred(s, state, closed, applicable, estimate.plan))
    return helpful


def _preferred(
    s: Successors, state: State, closed: State, applicable: list[int], plan: tuple[int, ...]
) -> dict[int, None]:
    """Return the applicable operators of a relaxed plan, those first that go well with the others.

    Best are those after which the fewest of the plan's operators are no longer applicable, then
    those after which the most become applicable. Without this, a search would drive from body to
    body while all orders look equally good.
    """
    now = set(applicable)
    before, absent = s.before, s.absent
    ranked: list[tuple[int, int, int]] = []
    for operator in plan:
        if operator not in now:
            continue
        after = s.apply(operator, state, closed) | closed & s.derived_mask

        lost = gained = 0
        for other in plan:
            if other != operator:
                possible = before[other] & after == before[other] and not absent[other] & after
                if other in now:
                    lost += not possible
                else:
                    gained += possible
        ranked.append((lost, -gained, operator))

    ranked.sort()
    return dict.fromkeys(operator for _, _, operator in ranked)
