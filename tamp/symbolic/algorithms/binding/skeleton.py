"""A skeleton: an action plan over variables, and the stream calls that give them values."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from functools import cached_property

from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.pddl.structs import Fact

Term = str | int
"""A real object's name, or the number of a variable."""

LiftedFact = tuple[str, tuple[Term, ...]]


@dataclass(frozen=True, slots=True)
class Usage:
    """A test's fact that a step needs because `present` holds in the state before it."""

    fact: Fact
    present: frozenset[Fact]


@dataclass(frozen=True, slots=True)
class Step:
    """One action of an optimistic plan.

    Attributes:
        name: The action's.
        arguments: Real objects or placeholders.
        state: The fluent facts before it.
        read: The fluent facts that it rests on, those behind derived ones and effects that take
            place among them.
        added: The facts that it makes true.
        deleted: The facts of the state that it makes false.
        static: The static facts that it rests on.
        derived: Those of them that derivations rest on.
        usages: The tests that the state asks for.
        cost: Its cost.
    """

    name: str
    arguments: tuple[str, ...]
    state: frozenset[Fact]
    read: frozenset[Fact]
    added: frozenset[Fact]
    deleted: frozenset[Fact]
    static: frozenset[Fact]
    derived: frozenset[Fact]
    usages: tuple[Usage, ...]
    cost: float = 1.0


@dataclass(eq=False)
class CallNode:
    """One stream call of a skeleton.

    Attributes:
        stream: Whose call it is.
        guess: The symbolic inputs and outputs that stand behind the variables, as (inputs,
            outputs).
        inputs: Terms.
        outputs: Variables.
        step: The first step that needs it.
        fluents: The facts that its function is shown, with what each is called symbolically.
        fact: The first symbolic fact that it certifies: what is blamed when it fails.
        given: Facts that its function is shown as well, in every state.
        needs: The calls that certify what it is called for: they come before it.
    """

    stream: BoundStream
    guess: tuple[tuple[str, ...], tuple[str, ...]]
    inputs: tuple[Term, ...]
    outputs: tuple[int, ...]
    step: int
    fact: Fact
    fluents: tuple[tuple[LiftedFact, Fact], ...] = ()
    given: frozenset[Fact] = frozenset()
    needs: list[CallNode] = field(default_factory=list["CallNode"])


@dataclass(eq=False)
class Skeleton:
    """An action plan over variables, and the stream calls that give them values.

    Attributes:
        steps: The optimistic plan.
        actions: Name and terms of each action.
        nodes: The calls, in an order that fails early.
        certified: The static facts that the plan rests on, over terms.
    """

    steps: tuple[Step, ...]
    actions: tuple[tuple[str, tuple[Term, ...]], ...]
    nodes: tuple[CallNode, ...]
    certified: tuple[LiftedFact, ...]
    rounds: int = 0
    memory: dict[int, tuple[tuple[object, ...], tuple[str, ...]]] = field(
        default_factory=dict[int, tuple[tuple[object, ...], tuple[str, ...]]]
    )

    def recall(self, earlier: Skeleton) -> None:
        """Warm-start from the values that another skeleton had last, where a call is the same here.

        Each is tried first where its inputs are those that it was drawn for.
        """
        places = earlier.calls
        for call, place in self.calls.items():
            value = earlier.memory.get(places.get(call, -1))
            if value is not None:
                self.memory.setdefault(place, value)

    @cached_property
    def calls(self) -> dict[tuple[object, ...], int]:
        """Return the place of each call by its stream and what it means in the optimistic task.

        Those that look alike are counted.
        """
        counts: Counter[tuple[object, ...]] = Counter()
        places: dict[tuple[object, ...], int] = {}
        for place, node in enumerate(self.nodes):
            call = (node.stream.name, node.guess)
            places[*call, counts[call]] = place
            counts[call] += 1
        return places

    @property
    def signature(self) -> tuple[tuple[str, tuple[str, ...]], ...]:
        """Return what tells it from other skeletons."""
        return tuple((step.name, step.arguments) for step in self.steps)

    @cached_property
    def makers(self) -> dict[int, int]:
        """Return for each variable the place of the call that puts it out."""
        return {variable: i for i, node in enumerate(self.nodes) for variable in node.outputs}

    @cached_property
    def users(self) -> list[list[int]]:
        """List for each call the later ones that take, or are shown, what it puts out."""
        makers = self.makers
        users: list[list[int]] = [[] for _ in self.nodes]
        for index, node in enumerate(self.nodes):
            seen = {makers[term] for term in node.inputs if isinstance(term, int)}
            for (_, terms), _ in node.fluents:
                seen.update(
                    makers[term] for term in terms if isinstance(term, int) and term in makers
                )
            for maker in seen:
                users[maker].append(index)
        return users
