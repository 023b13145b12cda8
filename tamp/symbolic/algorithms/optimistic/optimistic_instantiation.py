"""Optimistic instantiation of streams: every call succeeds, its outputs are placeholders."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence

from tamp.symbolic.algorithms.bound_stream import BoundStream, substitute
from tamp.symbolic.algorithms.optimistic.assumable_tests import atoms_of
from tamp.symbolic.algorithms.optimistic.fact_index import FactIndex, unify
from tamp.symbolic.algorithms.optimistic.optimistic_facts import (
    PLACEHOLDER_MARK,
    OptimisticFacts,
    OptimisticInstance,
    Placeholders,
    PlaceholdersOfCalls,
)
from tamp.symbolic.pddl.structs import Fact, Task

MAX_DEPTH = 8
"""Depth of instances that rest on instances, at first."""

MAX_INSTANCES = 2000
"""Optimistic instances at first; twenty objects in the cupboard take 1,800."""


def instantiate_streams(
    streams: Sequence[BoundStream],
    facts: Iterable[Fact],
    *,
    ended: frozenset[tuple[str, tuple[str, ...]]] = frozenset(),
    max_depth: int = MAX_DEPTH,
    max_generator_depth: int | None = None,
    max_instances: int = MAX_INSTANCES,
    placeholders: PlaceholdersOfCalls | None = None,
) -> OptimisticFacts:
    """Instantiate streams from facts and from what instances certify, to a fixpoint or a depth.

    Where every output feeds ten more calls, a few levels are too many: with `max_instances` there
    are no more of the level that was reached then, nor of deeper ones, but for tests, which feed
    nothing.

    Args:
        streams: Those worth instantiating (see `relevant`).
        facts: Known static facts, types as unary facts among them.
        ended: Calls (stream, inputs) that yield nothing new: they are left out.
        max_depth: Greatest depth of instances resting on instances.
        max_generator_depth: The same for those with outputs, which others rest on; by default as
            many.
        max_instances: Number of instances from which on they become shallower. The first level is
            always complete.
        placeholders: Those of calls instantiated before, and the facts about them, kept and added
            to: what was learned is kept under their names, so a name must always mean the same.
    """
    growth = _Instantiation(
        streams,
        ended,
        max_depth if max_generator_depth is None else min(max_generator_depth, max_depth),
        max_depth,
        max_instances,
        {} if placeholders is None else placeholders,
    )
    for fact in facts:
        growth.add_fact(fact, 0)
    growth.run_to_fixpoint()
    return growth.made


class _Instantiation:
    """The fixpoint of stream instances and facts: a queue of facts, each met once.

    Attributes:
        made: What was instantiated so far.
    """

    def __init__(
        self,
        streams: Sequence[BoundStream],
        ended: frozenset[tuple[str, tuple[str, ...]]],
        generator_depth: int,
        test_depth: int,
        max_instances: int,
        placeholders: PlaceholdersOfCalls,
    ) -> None:
        self.made = OptimisticFacts()
        self._streams = streams
        self._generator_depth, self._test_depth = generator_depth, test_depth
        self._max_instances = max_instances
        self._placeholders = placeholders
        self._counts = Counter(
            name.rstrip("0123456789") for call in placeholders.values() for name in call.outputs
        )

        self._seen: set[tuple[str, tuple[str, ...]]] = set(ended)
        self._depth: dict[Fact, int] = {}
        self._queue: list[Fact] = []
        self._index = FactIndex()
        self._by_predicate: dict[str, list[tuple[BoundStream, int]]] = defaultdict(list)
        for stream in streams:
            for position, atom in enumerate(stream.declaration.domain):
                self._by_predicate[atom.predicate].append((stream, position))

    def add_fact(self, fact: Fact, depth: int) -> None:
        """Put a fact into the queue, unless it was there."""
        if fact not in self._depth:
            self._depth[fact] = depth
            self._queue.append(fact)

    def run_to_fixpoint(self) -> None:
        """Instantiate until no fact of the queue makes a further instance possible."""
        for stream in self._streams:
            if not stream.declaration.domain and not stream.declaration.inputs:
                self._instantiate(stream, {})

        # the queue grows as it is gone through
        for fact in self._queue:
            # now, not before: so a call is found with the last of its facts, and levels come in
            # order
            self._index.add(fact)
            for stream, place in self._by_predicate.get(fact[0], ()):
                if self._depth[fact] >= self._limit(stream):
                    self.made.complete = False
                    continue
                domain = stream.declaration.domain
                binding = unify(domain[place], fact, {})
                if binding is not None:
                    others = (*domain[:place], *domain[place + 1 :])
                    for complete in list(self._index.join(others, binding)):
                        self._instantiate(stream, complete)

    def _limit(self, stream: BoundStream) -> int:
        """Return how deep instances of a stream may be, at the moment."""
        return self._test_depth if stream.is_test else self._generator_depth

    def _instantiate(self, stream: BoundStream, binding: Mapping[str, str]) -> None:
        """Add the instance of a stream for a binding of its inputs, unless it is there or deep."""
        declaration = stream.declaration
        inputs = tuple([binding.get(name, name) for name in declaration.inputs])
        key = (stream.name, inputs)
        if key in self._seen:
            return
        self._seen.add(key)

        call = self._placeholders.get(key)
        domain = (
            substitute(declaration.domain, declaration.inputs, inputs)
            if call is None
            else call.domain
        )

        depth = 1
        for fact in domain:
            if self._depth[fact] >= depth:
                depth = self._depth[fact] + 1
        if depth > self._limit(stream):
            self.made.complete = False
            return

        if call is None:
            call = self._placeholders[key] = self._named(stream, inputs, domain)
        if call.outputs:
            self.made.types.update(zip(call.outputs, stream.output_types, strict=True))
        made = OptimisticInstance(stream, inputs, call.outputs, domain, call.certified, depth)
        self.made.instances.append(made)
        if len(self.made.instances) >= self._max_instances:
            fewer = max(1, min(self._generator_depth, depth - 1))
            self.made.crowded |= fewer < self._generator_depth
            self._generator_depth = fewer
        self._certify(made)

    def _named(
        self, stream: BoundStream, inputs: tuple[str, ...], domain: tuple[Fact, ...]
    ) -> Placeholders:
        """Name the outputs of a call that was never instantiated before."""
        declaration = stream.declaration
        outputs: list[str] = []
        for name in declaration.outputs:
            prefix = PLACEHOLDER_MARK + name.lstrip("?").rstrip("0123456789")
            self._counts[prefix] += 1
            outputs.append(f"{prefix}{self._counts[prefix]}")

        variables = (*declaration.inputs, *declaration.outputs)
        certified = substitute(declaration.certified, variables, (*inputs, *outputs))
        return Placeholders(tuple(outputs), domain, certified)

    def _certify(self, made: OptimisticInstance) -> None:
        """Add what an instance certifies; note who else does, where one looks at the state."""
        producers = self.made.producers
        for fact in made.certified:
            if fact not in self._depth:
                producers[fact] = made
                self.add_fact(fact, made.depth)
            elif fact in producers and (made.stream.is_fluent or producers[fact].stream.is_fluent):
                self.made.alternatives.setdefault(fact, [producers[fact]]).append(made)


def relevant(
    streams: Iterable[BoundStream],
    predicates: Iterable[str],
    asked: Callable[[tuple[str, ...]], bool] | None = None,
) -> list[BoundStream]:
    """List the streams whose certified facts the predicates or other relevant streams can use.

    Args:
        streams: Those to choose from.
        predicates: Those that conditions mention.
        asked: Whether something of these types is asked for, whatever is certified of it (see
            `anything`).
    """
    needed = set(predicates)
    remaining = list(streams)
    chosen: list[BoundStream] = []
    progress = True
    while progress:
        progress = False
        for stream in list(remaining):
            used = any(atom.predicate in needed for atom in stream.declaration.certified)
            if used or (asked is not None and any(asked(types) for types in stream.output_types)):
                remaining.remove(stream)
                chosen.append(stream)
                needed.update(atom.predicate for atom in stream.declaration.domain)
                progress = True
    order = {stream.name: i for i, stream in enumerate(streams)}
    return sorted(chosen, key=lambda stream: order[stream.name])


def type_facts(task: Task) -> list[Fact]:
    """List types as unary facts, inherited ones too: (movable mug), (body mug), (object mug)."""
    facts: dict[Fact, None] = {}
    domain = task.domain
    for name, types in {**domain.constants, **task.objects}.items():
        for type_ in ("object", *domain.types):
            if type_ == "object" or any(domain.is_a(own, type_) for own in types):
                facts[type_, name] = None
    return list(facts)


def used_predicates(task: Task) -> set[str]:
    """Return the predicates that conditions of the task mention."""
    return {atom.predicate for atom in atoms_of(task)}
