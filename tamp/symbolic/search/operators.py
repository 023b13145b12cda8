"""The instantiated task, its variables replaced by objects: operators, guards, axioms, a goal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from tamp.symbolic.pddl.structs import Fact

Facts = frozenset[Fact]
NO_FACTS: Facts = frozenset()

ANY_OBJECT = "(any)"
"""The predicate of static facts that say that an object is there, of which no condition says
anything else.
"""


class Guard(NamedTuple):
    """Facts under which an operator costs more, or may not be applied.

    A named tuple, not a dataclass: there are many (operators times poses of other bodies), made
    three times faster.

    Attributes:
        facts: Fluent facts; the guard is *triggered* in the states that contain all of them.
        waived_by: The static fact, a test stream's result, whose truth makes the guard harmless;
            its price is paid when the guard is triggered. None: nothing waives it, the operator is
            inapplicable while the facts hold.
    """

    facts: Facts
    waived_by: Fact | None


@dataclass(frozen=True, slots=True)
class ConditionalEffect:
    """An effect that takes place when its condition holds in the state before the operator."""

    positive: Facts
    negative: Facts
    added: Facts
    deleted: Facts
    static: Facts = NO_FACTS


@dataclass(frozen=True, slots=True)
class Operator:
    """An action with objects for its parameters. Facts are fluent or derived, those in `static` are
    static.

    Attributes:
        name: The action's name.
        arguments: The objects of the action's own parameters.
        positive: Must hold before; may contain derived facts.
        negative: Must not hold before.
        added: Hold afterwards; adding wins over deleting.
        deleted: Do not hold afterwards.
        cost: The action's own cost, without prices.
        static: The static facts among the preconditions.
        guards: Triggered ones raise the cost or forbid the operator.
        conditional: Further effects with conditions of their own.
    """

    name: str
    arguments: tuple[str, ...]
    positive: Facts
    negative: Facts
    added: Facts
    deleted: Facts
    cost: float = 1.0
    static: Facts = NO_FACTS
    guards: Sequence[Guard] = ()
    conditional: tuple[ConditionalEffect, ...] = ()

    def __str__(self) -> str:
        return f"({' '.join((self.name, *self.arguments))})"


@dataclass(frozen=True, slots=True)
class Axiom:
    """`head` holds in every state where the body does. Bodies look at their own stratum only
    positively.
    """

    head: Fact
    positive: Facts
    negative: Facts
    static: Facts = NO_FACTS
    stratum: int = 0


@dataclass(frozen=True, slots=True)
class Goal:
    """The goal: what must hold at the end. `static` are the static facts that it names itself, all
    of them true.
    """

    positive: Facts
    negative: Facts = NO_FACTS
    static: Facts = NO_FACTS


@dataclass(frozen=True, slots=True)
class Meaning:
    """The subformula that an auxiliary fact stands for.

    Attributes:
        text: In PDDL or in words, to show to people.
        terms: Of its atoms from left to right, variables too.
    """

    text: str
    terms: tuple[str, ...] = ()


@dataclass(frozen=True)
class InstantiatedTask:
    """A task without variables.

    Attributes:
        initial: The fluent facts of the initial state.
        goal: Unreachable goal facts are kept in it, see `unreachable`.
        operators: Sorted by name and arguments; only those applicable in some state of the delete
            relaxation.
        axioms: Sorted by stratum; only those that an operator or the goal may need.
        reachable: Fluent and derived facts that hold in some state of the delete relaxation.
        meanings: For the auxiliary facts that stand for a subformula ("or 1" ...), by name.
    """

    initial: Facts
    goal: Goal
    operators: tuple[Operator, ...]
    axioms: tuple[Axiom, ...]
    reachable: Facts
    meanings: Mapping[str, Meaning]
