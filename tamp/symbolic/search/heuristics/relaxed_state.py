"""The relaxed task of a state and its exploration: costs of facts and their best supporters."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from tamp.symbolic.search.heuristics.loops.interface import Kernels
from tamp.symbolic.search.heuristics.loops.rows import CsrRows, Integers, Reals
from tamp.symbolic.search.successors import State


@dataclass(frozen=True, slots=True)
class RelaxedState:
    """The relaxed task for the states in which the same guards are triggered and negative
    conditions violated.

    Attributes:
        kernels: Those that its lists are made for.
        before: Preconditions of each relaxed operator.
        costs: Their costs.
        effects: Their effects: facts, complements of facts, paid guards.
        needed: For each fact, complement or guard, the relaxed operators that wait for it.
        paid: Guards that can be paid for.
        prices: What they cost.
        raised: For each operator the prices of guards that its cost contains.
        guarded: For each operator the guards, with their prices, that it waits for.
    """

    kernels: Kernels
    before: CsrRows
    costs: Reals
    effects: CsrRows
    needed: CsrRows
    paid: tuple[int, ...] = ()
    prices: tuple[float, ...] = ()
    raised: Mapping[int, float] = field(default_factory=dict[int, float])
    guarded: Mapping[int, list[tuple[int, float]]] = field(
        default_factory=dict[int, list[tuple[int, float]]]
    )

    @property
    def operators(self) -> int:
        """Count the relaxed operators."""
        return len(self.before.starts) - 1

    @property
    def facts(self) -> int:
        """Count the facts, complements and guards."""
        return len(self.needed.starts) - 1


@dataclass(slots=True)
class TriggeredGuards:
    """The changes that triggered guards and violated negative conditions make in the relaxed task.

    Attributes:
        waiting: For each guard, its facts and price, the relaxed operators that wait for it.
        dearer: Relaxed operators that pay for a guard.
        by: How much.
        raised: For each operator the prices of guards that its cost contains.
        blocked: For each operator the guards that it waits for.
    """

    waiting: dict[tuple[State, float], list[int]] = field(
        default_factory=dict[tuple[State, float], list[int]]
    )
    dearer: list[int] = field(default_factory=list[int])
    by: list[float] = field(default_factory=list[float])
    raised: dict[int, float] = field(default_factory=dict[int, float])
    blocked: dict[int, list[tuple[State, float]]] = field(
        default_factory=dict[int, list[tuple[State, float]]]
    )


@dataclass(frozen=True, slots=True)
class RelaxedExploration:
    """The result: costs of facts, and for each the relaxed operator that reaches it best (-1: it
    holds, or is paid).
    """

    costs: Reals
    supporters: Integers
    relaxed_state: RelaxedState
    goals: list[int]

    @property
    def goal_costs(self) -> list[float]:
        """Return what each fact of the goal costs."""
        return [float(self.costs[goal]) for goal in self.goals]

    def paid(self, operator: int) -> float:
        """Sum the prices of an operator's guards that a relaxed plan with it pays, rather than
        removes their facts.
        """
        it = self.relaxed_state
        waited = it.guarded.get(operator, ())
        return it.raised.get(operator, 0.0) + sum(
            price for guard, price in waited if self.supporters[guard] < 0
        )

    @property
    def dead(self) -> bool:
        """Check for a dead end: the goal is out of reach even in the relaxation."""
        return math.inf in self.goal_costs
