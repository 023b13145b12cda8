"""A* and greedy best-first search."""

from __future__ import annotations

import math
from heapq import heappop, heappush

from tamp.symbolic.search.expansion import Plan, SearchSpace
from tamp.symbolic.search.successors import State


def astar(search: SearchSpace) -> Plan | None:
    """Run A* with reopening; break ties for the lower estimate, then for the younger state.

    A state is evaluated when it is taken from the queue for the first time; until then its parent's
    estimate less the operator's cost stands for it, which is as admissible. Several heuristics
    count with their maximum.
    """
    s = search.successors
    estimates: dict[State, float] = {}
    queue: list[tuple[float, float, int, float, State, State]] = [
        (0.0, 0.0, 0, 0.0, s.initial, s.initial)
    ]
    number = 0

    while queue:
        f, guess, _, cost, state, parent = heappop(queue)
        if cost > search.best[state]:
            continue
        search.bound = max(search.bound, f)
        closed = s.closure(state)
        h = estimates.get(state)
        if h is None:
            before = None if state == parent else s.closure(parent)
            h = estimates[state] = max(max(e.value for e in search.estimate(closed, before)), guess)
            if cost + h >= search.below:
                continue
            if cost + h > f:
                number -= 1
                heappush(queue, (cost + h, h, number, cost, state, parent))
                continue
        if s.holds_goal(closed):
            return search.plan(state)
        search.count()
        for operator in s.applicable(closed):
            after = s.apply(operator, state, closed)
            best = search.best.get(after, math.inf)
            if cost + s.cost[operator] >= best:
                continue
            step = s.step_cost(operator, state)
            reached = cost + step
            if reached >= best:
                continue
            search.best[after] = reached
            search.parents[after] = (state, operator)
            to_go = estimates.get(after)
            if to_go is None:
                to_go = max(0.0, h - step)
            if reached + to_go < search.below:
                number -= 1
                heappush(queue, (reached + to_go, to_go, number, reached, after, state))

    search.bound = search.below
    return None


def best_first(search: SearchSpace) -> Plan | None:
    """Run greedy best-first search: costs do not count, the state of the lowest estimate is next,
    then the younger one.

    States are evaluated as they are generated. Several heuristics count with their sum.
    """
    s = search.successors
    queue: list[tuple[float, int, State]] = []
    number = 0

    def push(state: State, parent: State | None) -> None:
        nonlocal number
        h = sum(estimate.value for estimate in search.estimate(s.closure(state), parent))
        if h < math.inf:
            number -= 1
            heappush(queue, (h, number, state))

    push(s.initial, None)
    while queue:
        _, _, state = heappop(queue)
        closed = s.closure(state)
        if s.holds_goal(closed):
            return search.plan(state)
        search.count()
        for operator in s.applicable(closed):
            after = s.apply(operator, state, closed)
            if after in search.best:
                continue
            reached = search.best[state] + s.step_cost(operator, state)
            if reached < math.inf:
                search.best[after] = reached
                search.parents[after] = (state, operator)
                push(after, closed)
    return None
