"""Optimistic facts: what streams would make true if each call succeeded, and by which call."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from tamp.symbolic.algorithms.bound_stream import BoundStream, substitute
from tamp.symbolic.pddl.structs import Atom, Fact

PLACEHOLDER_MARK = "#"
"""Placeholders begin with it: "#p3" stands for any pose that its stream may yield."""


@dataclass(eq=False, slots=True)  # not frozen: there are thousands, made three times faster
class OptimisticInstance:
    """One optimistic stream call; never changed.

    Attributes:
        stream: Its stream.
        inputs: Real objects or placeholders.
        outputs: Placeholders of its own.
        domain: The facts that it rests on.
        certified: The facts that it would make true.
        depth: One more than the deepest instance that it rests on.
    """

    stream: BoundStream
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    domain: tuple[Fact, ...]
    certified: tuple[Fact, ...]
    depth: int

    @property
    def call(self) -> tuple[str, tuple[str, ...]]:
        """Return the stream's name and the inputs."""
        return self.stream.name, self.inputs

    @property
    def has_real_inputs(self) -> bool:
        """Return whether all inputs are real, so that what its function says of them is final."""
        return not any(name.startswith(PLACEHOLDER_MARK) for name in self.inputs)


class Placeholders(NamedTuple):
    """A call's placeholders, the facts that it rests on, and those that it would make true."""

    outputs: tuple[str, ...]
    domain: tuple[Fact, ...]
    certified: tuple[Fact, ...]


PlaceholdersOfCalls = dict[tuple[str, tuple[str, ...]], Placeholders]
"""Of each call that was ever instantiated: a placeholder always means the same."""


@dataclass
class OptimisticFacts:
    """All optimistic instances: which static facts could become true, and by which call.

    Attributes:
        producers: Fact to the instance that certifies it, the first one of several.
        alternatives: Fact to all instances that certify it, where one of them looks at the state:
            one may fail in a state in which another does not.
        instances: All of them.
        types: Placeholder to its types.
        lazily_tested: The predicates of tests that are taken to hold wherever they are asked for,
            instead of being instantiated one by one: there are as many as pairs of poses. Each with
            its stream and the atom that it certifies.
        complete: Whether nothing was left out for being deep or one too many: what is not here
            cannot become true.
        crowded: Whether deeper ones were left out for there being so many, whatever their depth.
    """

    producers: dict[Fact, OptimisticInstance] = field(
        default_factory=dict[Fact, OptimisticInstance]
    )
    alternatives: dict[Fact, list[OptimisticInstance]] = field(
        default_factory=dict[Fact, list[OptimisticInstance]]
    )
    instances: list[OptimisticInstance] = field(default_factory=list[OptimisticInstance])
    types: dict[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    lazily_tested: Mapping[str, tuple[BoundStream, Atom]] = field(
        default_factory=dict[str, tuple[BoundStream, Atom]]
    )
    complete: bool = True
    crowded: bool = False

    def producer(self, fact: Fact) -> OptimisticInstance | None:
        """Return the call that certifies a fact; a lazy test's is made up when asked for."""
        made = self.producers.get(fact)
        if made is not None or fact[0] not in self.lazily_tested:
            return made

        stream, atom = self.lazily_tested[fact[0]]
        declaration = stream.declaration
        binding = dict(zip(atom.terms, fact[1:], strict=True))
        inputs = tuple(binding[name] for name in declaration.inputs)
        domain = substitute(declaration.domain, declaration.inputs, inputs)
        certified = substitute(declaration.certified, declaration.inputs, inputs)
        made = self.producers[fact] = OptimisticInstance(stream, inputs, (), domain, certified, 0)
        return made

    def certified_fact_of(self, placeholder: str) -> Fact:
        """Return a fact that the call which gives a placeholder certifies of it."""
        return next(
            fact
            for fact, instance in self.producers.items()
            if placeholder in instance.outputs and placeholder in fact
        )
