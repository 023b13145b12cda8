"""Lazy weighted A* and greedy search with preferred operators."""

from __future__ import annotations

import math
from heapq import heappop, heappush

from tamp.symbolic.search.expansion import Plan, SearchSpace
from tamp.symbolic.search.heuristics.goal_price import GoalPrice
from tamp.symbolic.search.heuristics.registry import Estimate
from tamp.symbolic.search.successors import State, Successors

PREFERRED_BOOST = 1000
"""How much longer preferred operators are preferred after progress (Richter and Helmert 2009)."""

END = -2
"""Stands for an operator where a goal state waits for its price to be the lowest."""

_Entry = tuple[float, int, float, State, State | None, int]
"""Priority, number among equals, cost, state, the state before, the operator."""


def lazy(search: SearchSpace, weight: float) -> Plan | None:
    """Lazy search: a state is evaluated when it is expanded, until then its parent's estimate
    stands for it.

    Each heuristic has two queues, the second for successors by preferred operators; all take turns,
    after progress those of the preferred get more. `weight` infinite is greedy search: costs do not
    count. A goal state whose goal rests on priced facts waits until nothing that is cheaper than it
    is left in a queue.
    """
    s = search.successors
    greedy = weight == math.inf
    kinds = range(len(search.heuristics))
    usual: list[list[_Entry]] = [[(0.0, 0, 0.0, s.initial, None, -1)] for _ in kinds]
    preferred: list[list[_Entry]] = [[] for _ in kinds]
    turns, turns_preferred = [0 for _ in kinds], [0 for _ in kinds]
    estimates: dict[State, tuple[float, ...]] = {}
    found: dict[State, tuple[Estimate, ...]] = {}
    done: dict[State, float] = {}
    lowest = [math.inf for _ in kinds]
    number = 0
    goal_price = GoalPrice(s)
    least, end = math.inf, None
    spent = {s.initial: 0.0}  # what the operators on the way have cost, prices aside
    while any(usual) or any(preferred):
        k = min((k for k in kinds if usual[k]), key=turns.__getitem__, default=None)
        p = min((k for k in kinds if preferred[k]), key=turns_preferred.__getitem__, default=None)
        if p is not None and not greedy and usual[p] and preferred[p][0][0] > 2.0 * usual[p][0][0]:
            p = None  # preferred, but by far too dear: a price was learned
        if p is not None and (k is None or turns_preferred[p] <= turns[k]):
            turns_preferred[p] += 1
            queue = preferred[p]
        elif k is not None:
            turns[k] += 1
            queue = usual[k]
        else:
            break
        _, _, cost, state, parent, operator = heappop(queue)
        if state == end and operator == END:
            return search.plan(state)
        if state in done and (greedy or cost >= done[state]):
            continue
        done[state] = cost
        search.best[state] = cost
        if parent is not None:
            search.parents[state] = (parent, operator)
            spent[state] = spent[parent] + s.operators[operator].cost
        closed = s.closure(state)
        if s.holds_goal(closed):
            price = goal_price(state)
            if price == 0.0:
                return search.plan(state)
            if (
                cost + price < least
            ):  # what the goal rests on here has a price: there may be a cheaper end
                least, end = cost + price, state
                number += 1
                for some in (usual[0], preferred[0]) if preferred[0] else (usual[0],):
                    heappush(some, (price if greedy else least, number, least, state, None, END))
            continue
        values = estimates.get(state)
        if values is None:
            found[state] = search.estimate(closed, None if parent is None else s.closure(parent))
            values = estimates[state] = tuple(estimate.value for estimate in found[state])
        if math.inf in values:
            continue
        search.count()
        for kind, value in enumerate(values):
            if value < lowest[kind]:
                lowest[kind] = value
                for other in kinds:
                    turns_preferred[other] -= PREFERRED_BOOST
        applicable = s.applicable(closed)
        helpful = _helpful(s, state, closed, applicable, found[state])
        for rank, operator in enumerate((*helpful, *applicable)):
            if rank >= len(helpful) and operator in helpful:
                continue
            if spent[state] + s.operators[operator].cost >= search.below:
                continue
            after = s.apply(operator, state, closed)
            known = done.get(after)
            if known is not None and (greedy or cost + s.cost[operator] >= known):
                continue
            reached = cost + s.step_cost(operator, state)
            if reached == math.inf or (known is not None and reached >= known):
                continue
            number += 1
            # Among equals: greedy search goes on from the state just expanded, weighted A* takes
            # the older.
            order = number if not greedy else rank - search.expanded * len(s.operators)
            step = s.cost[operator]
            dearer = reached - cost - step
            for kind, h in enumerate(values):
                extra = dearer and dearer - _paid(found[state][kind], operator)
                key = h + extra if greedy else cost + step + extra + weight * h
                heappush(usual[kind], (key, order, reached, after, state, operator))
                if rank < len(helpful) and extra <= step:
                    # Rank decides among preferred siblings, not cost. One that guards make dear
                    # waits elsewhere.
                    key = h if greedy else cost + weight * h
                    heappush(preferred[kind], (key, order, reached, after, state, operator))
    return None


def _paid(estimate: Estimate, operator: int) -> float:
    """The prices of the operator's guards that the parent's estimate contains: they shall not count
    twice.
    """
    return (
        estimate.paid(operator) if estimate.paid is not None and operator in estimate.plan else 0.0
    )


def _helpful(
    s: Successors,
    state: State,
    closed: State,
    applicable: list[int],
    estimates: tuple[Estimate, ...],
) -> dict[int, None]:
    """The applicable operators that the heuristics prefer, the best first."""
    helpful: dict[int, None] = {}
    for estimate in estimates:
        if estimate.plan:
            helpful.update(_preferred(s, state, closed, applicable, estimate.plan))
    return helpful


def _preferred(
    s: Successors, state: State, closed: State, applicable: list[int], plan: tuple[int, ...]
) -> dict[int, None]:
    """The applicable operators of a relaxed plan, those first that go well with the others.

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
