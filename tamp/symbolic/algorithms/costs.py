"""Costs that Python computes: functions of stream outputs, named in actions' costs."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, cast

from tamp.errors import InputError
from tamp.symbolic.algorithms.bound_stream import Objects
from tamp.symbolic.algorithms.optimistic.optimistic_facts import PLACEHOLDER_MARK
from tamp.symbolic.pddl.structs import Action, Atom, Fact, Function

COST_BEFORE_ASKED = 1.0
"""What a placeholder's cost is taken for until the function was asked once."""


@dataclass(frozen=True)
class BoundFunction:
    """A declared function and the Python function that computes it: numbers, zero or more."""

    declaration: Function
    function: Callable[..., Any]


class Costs(Mapping[Fact, float]):
    """Costs of function facts: given, computed, and for placeholders the mean of the computed.

    Args:
        functions: Computed ones.
        objects: Where the values of names are.
        given: Costs that the problem states; they come first.
    """

    def __init__(
        self, functions: tuple[BoundFunction, ...], objects: Objects, given: Mapping[Fact, float]
    ) -> None:
        self._functions = {bound.declaration.name: bound for bound in functions}
        self._objects = objects
        self._given = given
        self._computed: dict[Fact, float] = {}
        self._sums: dict[str, tuple[float, int]] = {}

    def __contains__(self, fact: object) -> bool:
        try:
            name, *_ = cast(Fact, fact)
        except (TypeError, ValueError):
            return False
        return fact in self._given or name in self._functions

    def __getitem__(self, fact: Fact) -> float:
        if fact in self._given:
            return self._given[fact]
        name = fact[0]
        if name not in self._functions:
            raise KeyError(fact)
        if any(word.startswith(PLACEHOLDER_MARK) for word in fact[1:]):
            total, count = self._sums.get(name, (0.0, 0))
            return total / count if count else COST_BEFORE_ASKED
        if fact not in self._computed:
            self._computed[fact] = cost = self._ask(fact)
            total, count = self._sums.get(name, (0.0, 0))
            self._sums[name] = (total + cost, count + 1)
        return self._computed[fact]

    def __iter__(self) -> Iterator[Fact]:
        return iter({**self._given, **self._computed})

    def __len__(self) -> int:
        return len({**self._given, **self._computed})

    def of(self, action: Action, arguments: tuple[str, ...]) -> float:
        """Return the cost of an action with real arguments."""
        if not isinstance(action.cost, Atom):
            return float(action.cost)
        binding = dict(
            zip((parameter.name for parameter in action.parameters), arguments, strict=True)
        )
        return self[
            (action.cost.predicate, *(binding.get(term, term) for term in action.cost.terms))
        ]

    def _ask(self, fact: Fact) -> float:
        bound = self._functions[fact[0]]
        value = bound.function(*(self._objects.values[word] for word in fact[1:]))
        try:
            cost = float(value)
        except (TypeError, ValueError):
            cost = math.nan
        if not (0.0 <= cost < math.inf):
            raise InputError(
                f"function '{fact[0]}' gave {value!r}: a cost is a number, zero or more"
            )
        return cost
