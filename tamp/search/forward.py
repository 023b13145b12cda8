"""Forward search over states: A*, and lazy weighted A* and greedy search with preferred operators."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from heapq import heappop, heappush

from tamp.clock import Deadline
from tamp.errors import InputError
from tamp.pddl.structs import Fact
from tamp.search.heuristics import HEURISTICS, Heuristic
from tamp.search.operators import Grounded, Operator
from tamp.search.shorten import shorten
from tamp.search.successors import Price, State, Successors

BOOST = 1000
"""How much longer preferred operators are preferred after progress (Richter and Helmert 2009)."""


class Reason(Enum):
    """Why a search ended without a plan."""

    UNSOLVABLE = "proven: no plan exists"
    LIMIT = "the limit of expanded states was reached"
    TIME = "the time is up"


@dataclass(frozen=True, slots=True)
class Plan:
    """Operators that lead from the initial state to the goal, and what they cost with all prices."""

    operators: tuple[Operator, ...]
    cost: float


@dataclass(frozen=True, slots=True)
class Result:
    """What a search found.

    Attributes:
        plan: None when there is none, then `reason` says why.
        expanded: States whose successors were generated.
        evaluated: Calls of the heuristic.
    """

    plan: Plan | None
    reason: Reason | None
    expanded: int
    evaluated: int


_Entry = tuple[float, int, float, State, State | None, int]
"""Priority, number (the older first), cost, state, the state before, the operator."""


class _Stop(Exception):
    def __init__(self, reason: Reason) -> None:
        self.reason = reason


class _Search:
    """What all searches share: the cheapest known way to each state, the counts and the limits."""

    def __init__(
        self, successors: Successors, heuristic: Heuristic, limit: int | None, deadline: Deadline | None
    ) -> None:
        self.successors = successors
        self.heuristic = heuristic
        self.limit = limit
        self.deadline = deadline
        self.expanded = 0
        self.evaluated = 0
        self.best: dict[State, float] = {successors.initial: 0.0}
        self.parents: dict[State, tuple[State, int]] = {}

    def count(self) -> None:
        """Count an expansion; stop at a limit."""
        if self.limit is not None and self.expanded >= self.limit:
            raise _Stop(Reason.LIMIT)
        if self.deadline is not None and self.deadline.passed:
            raise _Stop(Reason.TIME)
        self.expanded += 1

    def plan(self, state: State) -> Plan:
        """The plan to a state along the parents, without what it does not need."""
        numbers: list[int] = []
        while state in self.parents:
            state, operator = self.parents[state]
            numbers.append(operator)
        numbers, cost = shorten(self.successors, numbers[::-1])
        return Plan(tuple(self.successors.operators[number] for number in numbers), cost)


def _eager(search: _Search, weight: float) -> Plan | None:
    """A* with reopening; ties are broken for the lower estimate, then for the younger state.

    `weight` infinite is greedy search: costs do not count, and no state is reopened.
    """
    greedy = weight == math.inf
    s = search.successors
    initial = s.initial
    search.evaluated += 1
    h = search.heuristic(s.closure(initial)).value
    estimates: dict[State, float] = {initial: h}
    queue: list[tuple[float, float, int, float, State]] = []
    if h < math.inf:
        queue.append((h, h, 0, 0.0, initial))
    number = 0
    while queue:
        _, h, _, cost, state = heappop(queue)
        if cost > search.best[state]:
            continue
        closed = s.closure(state)
        if s.holds_goal(closed):
            return search.plan(state)
        search.count()
        for operator in s.applicable(closed):
            after = s.apply(operator, state, closed)
            known = search.best.get(after, math.inf)
            if cost + s.cost[operator] >= known or (greedy and known < math.inf):
                continue
            reached = cost + s.step_cost(operator, state)
            if reached >= known:
                continue
            search.best[after] = reached
            search.parents[after] = (state, operator)
            h = estimates.get(after)
            if h is None:
                search.evaluated += 1
                h = estimates[after] = search.heuristic(s.closure(after), closed).value
            if h < math.inf:
                number -= 1
                heappush(queue, (h if greedy else reached + weight * h, h, number, reached, after))
    return None


def _lazy(search: _Search, weight: float) -> Plan | None:
    """Lazy search: a state is evaluated when it is expanded, until then its parent's estimate stands for it.

    Two queues, the second for successors by preferred operators, take turns; after progress the second gets more.
    `weight` infinite is greedy search: costs do not count.
    """
    s = search.successors
    greedy = weight == math.inf
    queues: tuple[list[_Entry], list[_Entry]] = ([(0.0, 0, 0.0, s.initial, None, -1)], [])
    turns = [0, 0]
    estimates: dict[State, float] = {}
    relaxed: dict[State, tuple[int, ...]] = {}
    done: dict[State, float] = {}
    lowest = math.inf
    number = 0
    while queues[0] or queues[1]:
        which = 1 if queues[1] and (not queues[0] or turns[1] <= turns[0]) else 0
        if which == 1 and queues[0] and not greedy and queues[1][0][0] > 2.0 * queues[0][0][0]:
            which = 0  # preferred, but by far too dear: a price was learned
        turns[which] += 1
        _, _, cost, state, parent, operator = heappop(queues[which])
        if state in done and (greedy or cost >= done[state]):
            continue
        done[state] = cost
        search.best[state] = cost
        if parent is not None:
            search.parents[state] = (parent, operator)
        closed = s.closure(state)
        if s.holds_goal(closed):
            return search.plan(state)
        h = estimates.get(state)
        if h is None:
            search.evaluated += 1
            estimate = search.heuristic(closed, None if parent is None else s.closure(parent))
            h = estimates[state] = estimate.value
            relaxed[state] = estimate.plan
        if h == math.inf:
            continue
        search.count()
        if h < lowest:
            lowest = h
            turns[1] -= BOOST
        applicable = s.applicable(closed)
        helpful = _preferred(s, state, closed, applicable, relaxed[state])
        for rank, operator in enumerate((*helpful, *applicable)):
            if rank >= len(helpful) and operator in helpful:
                continue
            after = s.apply(operator, state, closed)
            known = done.get(after)
            if known is not None and (greedy or cost + s.cost[operator] >= known):
                continue
            reached = cost + s.step_cost(operator, state)
            if reached == math.inf or (known is not None and reached >= known):
                continue
            number += 1
            usual, extra = s.cost[operator], reached - cost - s.cost[operator]
            heappush(
                queues[0], (h + extra if greedy else reached + weight * h, number, reached, after, state, operator)
            )
            if rank < len(helpful) and extra <= usual:
                # Rank decides among preferred siblings, not cost. One that guards make dear waits in the other queue.
                key = h if greedy else cost + weight * h
                heappush(queues[1], (key, number, reached, after, state, operator))
    return None


def _preferred(
    s: Successors, state: State, closed: State, applicable: list[int], plan: tuple[int, ...]
) -> dict[int, None]:
    """The applicable operators of a relaxed plan, those first that go well with the others.

    Best are those after which the fewest of the plan's operators are no longer applicable, then those after which the
    most become applicable. Without this, a search would drive from body to body while all orders look equally good.
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


SEARCHES: dict[str, Callable[[_Search, float], Plan | None]] = {
    "astar": lambda search, weight: _eager(search, 1.0),
    "wastar": _lazy,
    "greedy": lambda search, weight: _lazy(search, math.inf),
    "eager": lambda search, weight: _eager(search, math.inf),
}


def search(
    grounded: Grounded,
    *,
    search: str = "wastar",
    heuristic: str = "ff",
    weight: float = 5.0,
    price: Price | None = None,
    limit: int | None = None,
    deadline: Deadline | None = None,
) -> Result:
    """Search for a plan.

    Args:
        grounded: The task.
        search: A name of `SEARCHES`. "astar" with an admissible heuristic ("lmcut", "hmax", "blind") is optimal;
            "wastar" and "greedy" are lazy and use preferred operators, "eager" is plain greedy best-first search.
        heuristic: A name of `HEURISTICS`.
        weight: Of the estimate in "wastar".
        price: What the use of a static fact costs (by an operator resting on it, or to lift a guard); may be infinite.
            A mapping of those that cost something is faster than a function. Nothing by default.
        limit: Most states to expand.
        deadline: When to give up. It never changes the plan that is found, only whether one is.
    """
    if search not in SEARCHES:
        raise InputError(f"unknown search '{search}'", found=search, choices=SEARCHES)
    if heuristic not in HEURISTICS:
        raise InputError(f"unknown heuristic '{heuristic}'", found=heuristic, choices=HEURISTICS)
    if not grounded.goal.positive <= grounded.reachable | grounded.initial:
        return Result(None, Reason.UNSOLVABLE, 0, 0)
    successors = Successors(grounded, price if price is not None else {})
    run = _Search(successors, HEURISTICS[heuristic](successors), limit, deadline)
    try:
        plan = SEARCHES[search](run, weight)
        reason = None if plan else Reason.UNSOLVABLE
    except _Stop as stop:
        plan, reason = None, stop.reason
    return Result(plan, reason, run.expanded, run.evaluated)


def unreachable(grounded: Grounded) -> tuple[Fact, ...]:
    """The goal facts that hold in no state of the delete relaxation, sorted.

    A fact that must not hold and that nothing can make false is given as ("not", ...). Facts that stand for a
    subformula are explained in `grounded.meanings`.
    """
    goal = grounded.goal
    never = sorted(goal.positive - grounded.reachable - grounded.initial)
    deleted = {fact for o in grounded.operators for fact in o.deleted}
    deleted |= {fact for o in grounded.operators for effect in o.conditional for fact in effect.deleted}
    kept = sorted(("not", *fact) for fact in (goal.negative & grounded.initial) - deleted)
    return (*never, *kept)
