"""Heuristics by name: estimates of the cost from a state to the goal."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from tamp.symbolic.search.heuristics.landmarks import Landmarks
from tamp.symbolic.search.heuristics.lmcut import LandmarkCuts
from tamp.symbolic.search.heuristics.relaxation import Relaxation
from tamp.symbolic.search.successors import State, Successors


@dataclass(frozen=True, slots=True)
class Estimate:
    """A heuristic's answer.

    Attributes:
        value: The estimated cost to the goal, infinite in a dead end.
        plan: The operators of a relaxed plan, where the heuristic makes one; those applicable are
            preferred.
        paid: Says of an operator of that plan which prices of its guards the value contains.
    """

    value: float
    plan: tuple[int, ...] = ()
    paid: Callable[[int], float] | None = None


class Heuristic(Protocol):
    """Estimates the cost to the goal from a state."""

    def __call__(self, closed: State, parent: State | None = None) -> Estimate:
        """Estimate; `closed` is the state with its derived facts, `parent` the one before it on the
        way.
        """
        ...


def ff(successors: Successors) -> Heuristic:
    """Estimate by the cost of a relaxed plan (Hoffmann and Nebel 2001) along hadd's best
    supporters.
    """
    relaxation = Relaxation(successors, steps=True)

    def estimate(closed: State, parent: State | None = None) -> Estimate:
        exploration = relaxation.explore(closed, additive=True)
        if exploration.dead:
            return Estimate(math.inf)
        value, plan = relaxation.plan(exploration)
        return Estimate(value, tuple(plan), exploration.paid)

    return estimate


def hadd(successors: Successors) -> Heuristic:
    """Estimate by the sum of the goals' costs, each fact's cost the sum of its preconditions'
    (Bonet and Geffner 2001).
    """
    relaxation = Relaxation(successors, steps=True)

    def estimate(closed: State, parent: State | None = None) -> Estimate:
        exploration = relaxation.explore(closed, additive=True)
        return Estimate(sum(exploration.goal_costs, start=0.0))

    return estimate


def hmax(successors: Successors) -> Heuristic:
    """Estimate by the most expensive goal's cost, each fact's cost the maximum of its
    preconditions': admissible.
    """
    relaxation = Relaxation(successors, steps=False)

    def estimate(closed: State, parent: State | None = None) -> Estimate:
        exploration = relaxation.explore(closed, additive=False)
        return Estimate(max(exploration.goal_costs, default=0.0))

    return estimate


def blind(successors: Successors) -> Heuristic:
    """Estimate zero in goal states, elsewhere the cheapest operator's cost: admissible."""
    cheapest = min((successors.cost[i] for i in successors.alive), default=math.inf)

    def estimate(closed: State, parent: State | None = None) -> Estimate:
        return Estimate(0.0 if successors.holds_goal(closed) else cheapest)

    return estimate


def lmcut(successors: Successors) -> Heuristic:
    """Estimate by the sum of disjoint landmark cuts' costs: admissible, and the most informed of
    the admissible ones here (with conditional effects hmax may tell more).
    """
    cuts = LandmarkCuts(Relaxation(successors, steps=False))

    def estimate(closed: State, parent: State | None = None) -> Estimate:
        return Estimate(cuts.value(closed))

    return estimate


def landmarks(successors: Successors) -> Heuristic:
    """Estimate by the cost of the landmarks that were not true on the way to the state, or are
    needed again.
    """
    marks = Landmarks(successors)

    def estimate(closed: State, parent: State | None = None) -> Estimate:
        if not marks.possible:
            return Estimate(math.inf)
        remaining = marks.remaining(closed, parent)
        return Estimate(marks.cost(remaining))

    return estimate


HEURISTICS: dict[str, Callable[[Successors], Heuristic]] = {
    "ff": ff, "hadd": hadd, "landmarks": landmarks, "hmax": hmax, "lmcut": lmcut, "blind": blind,
}  # fmt: skip

ADMISSIBLE = frozenset(("hmax", "lmcut", "blind"))
"""Those that never say more than the goal costs: A* with one of them finds cheapest plans."""
