"""Optimistic instantiation of streams: every call succeeds, its outputs are placeholders."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from tamp.symbolic.algorithms.bound_stream import BoundStream, substitute
from tamp.symbolic.algorithms.optimistic.assumable_tests import atoms_of
from tamp.symbolic.algorithms.optimistic.fact_index import FactIndex, unify
from tamp.symbolic.pddl.structs import Atom, Fact, Task

MARK = "#"
"""Placeholders begin with it: "#p3" stands for any pose that its stream may yield."""


LEVELS = 8
"""Depth of guesses that rest on guesses, at first."""

ENOUGH = 2000
"""Guesses at first; twenty objects in the cupboard take 1,800."""


@dataclass(eq=False, slots=True)  # not frozen: there are thousands, made three times faster
class Guess:
    """One optimistic stream call; never changed.

    Attributes:
        stream: Its stream.
        inputs: Real objects or placeholders.
        outputs: Placeholders of its own.
        domain: The facts that it rests on.
        certified: The facts that it would make true.
        level: One more than the deepest guess that it rests on.
    """

    stream: BoundStream
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    domain: tuple[Fact, ...]
    certified: tuple[Fact, ...]
    level: int

    @property
    def call(self) -> tuple[str, tuple[str, ...]]:
        """Return the stream's name and the inputs."""
        return self.stream.name, self.inputs

    @property
    def has_real_inputs(self) -> bool:
        """Return whether all inputs are real, so that what its function says of them is final."""
        return not any(name.startswith(MARK) for name in self.inputs)


class Named(NamedTuple):
    """A call's placeholders, the facts that it rests on, and those that it would make true."""

    outputs: tuple[str, ...]
    domain: tuple[Fact, ...]
    certified: tuple[Fact, ...]


@dataclass
class Optimism:
    """All guesses: which static facts could become true, and by which call.

    Attributes:
        makers: Fact to the guess that certifies it, the first one of several.
        several: Fact to all guesses that certify it, where one of them looks at the state: one may
            fail in a state in which another does not.
        guesses: All of them.
        types: Placeholder to its types.
        assumed: The predicates of tests that are taken to hold wherever they are asked for, instead
            of being imagined one by one: there are as many as pairs of poses. Each with its stream
            and the atom that it certifies.
        complete: Whether nothing was left out for being deep or one too many: what is not here
            cannot become true.
    """

    makers: dict[Fact, Guess] = field(default_factory=dict[Fact, Guess])
    several: dict[Fact, list[Guess]] = field(default_factory=dict[Fact, list[Guess]])
    guesses: list[Guess] = field(default_factory=list[Guess])
    types: dict[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    assumed: Mapping[str, tuple[BoundStream, Atom]] = field(
        default_factory=dict[str, tuple[BoundStream, Atom]]
    )
    complete: bool = True

    def maker(self, fact: Fact) -> Guess | None:
        """Return the call that certifies a fact; of an assumed one it is made up when asked for."""
        known = self.makers.get(fact)
        if known is not None or fact[0] not in self.assumed:
            return known
        stream, atom = self.assumed[fact[0]]
        declaration = stream.declaration
        binding = dict(zip(atom.terms, fact[1:], strict=True))
        inputs = tuple(binding[name] for name in declaration.inputs)
        domain = substitute(declaration.domain, declaration.inputs, inputs)
        certified = substitute(declaration.certified, declaration.inputs, inputs)
        made = self.makers[fact] = Guess(stream, inputs, (), domain, certified, 0)
        return made

    def promise(self, placeholder: str) -> Fact:
        """Return a fact that the call which gives a placeholder certifies of it."""
        return next(
            fact
            for fact, guess in self.makers.items()
            if placeholder in guess.outputs and placeholder in fact
        )


def imagine(
    streams: Sequence[BoundStream],
    facts: Iterable[Fact],
    *,
    dead: frozenset[tuple[str, tuple[str, ...]]] = frozenset(),
    levels: int = LEVELS,
    deepest: int | None = None,
    enough: int = ENOUGH,
    names: dict[tuple[str, tuple[str, ...]], Named] | None = None,
) -> Optimism:
    """Instantiate streams from facts and each other's promises, to a fixpoint or `levels` deep.

    Where every output feeds ten more calls, a few levels are too many: with `enough` guesses there
    are no more of the level that was reached then, nor of deeper ones, but for tests, which feed
    nothing.

    Args:
        streams: Those worth instantiating (see `relevant`).
        facts: Known static facts, types as unary facts among them.
        dead: Calls (stream, inputs) that are known to yield nothing.
        levels: Greatest depth of guesses resting on guesses.
        deepest: The same for those with outputs, which others rest on; by default as many.
        enough: Number of guesses from which on they become shallower. The first level is always
            complete.
        names: The placeholders of calls imagined before, and the facts about them, kept and added
            to: what was learned is kept under their names, so a name must always mean the same.
    """
    optimism = Optimism()
    index = FactIndex()
    named: dict[tuple[str, tuple[str, ...]], Named] = {} if names is None else names
    counts = Counter(name.rstrip("0123456789") for call in named.values() for name in call.outputs)
    seen: set[tuple[str, tuple[str, ...]]] = set(dead)
    level_of: dict[Fact, int] = {}
    queue: list[Fact] = []
    for fact in facts:
        if fact not in level_of:
            level_of[fact] = 0
            queue.append(fact)

    total, growing = 0, levels if deepest is None else min(deepest, levels)

    by_predicate: dict[str, list[tuple[BoundStream, int]]] = defaultdict(list)
    for stream in streams:
        for position, atom in enumerate(stream.declaration.domain):
            by_predicate[atom.predicate].append((stream, position))

    def guess(stream: BoundStream, binding: Mapping[str, str]) -> None:
        declaration = stream.declaration
        inputs = tuple([binding.get(name, name) for name in declaration.inputs])
        key = (stream.name, inputs)
        if key in seen:
            return
        seen.add(key)

        call = named.get(key)
        domain = (
            substitute(declaration.domain, declaration.inputs, inputs)
            if call is None
            else call.domain
        )

        level = 1
        for fact in domain:
            if level_of[fact] >= level:
                level = level_of[fact] + 1
        nonlocal growing, total
        if level > (levels if stream.is_test else growing):
            optimism.complete = False
            return

        total += 1
        if total >= enough:
            growing = max(1, min(growing, level - 1))

        if call is None:
            outputs: list[str] = []
            for name in declaration.outputs:
                prefix = MARK + name.lstrip("?").rstrip("0123456789")
                counts[prefix] += 1
                outputs.append(f"{prefix}{counts[prefix]}")
            variables = (*declaration.inputs, *declaration.outputs)
            certified = substitute(declaration.certified, variables, (*inputs, *outputs))
            call = named[key] = Named(tuple(outputs), domain, certified)
        if call.outputs:
            optimism.types.update(zip(call.outputs, stream.output_types, strict=True))

        made = Guess(stream, inputs, call.outputs, domain, call.certified, level)
        optimism.guesses.append(made)

        for fact in call.certified:
            if fact not in level_of:
                optimism.makers[fact] = made
                level_of[fact] = level
                queue.append(fact)
            elif fact in optimism.makers and (
                stream.is_fluent or optimism.makers[fact].stream.is_fluent
            ):
                optimism.several.setdefault(fact, [optimism.makers[fact]]).append(made)

    for stream in streams:
        if not stream.declaration.domain and not stream.declaration.inputs:
            guess(stream, {})
    position = 0
    while position < len(queue):
        fact = queue[position]
        position += 1
        # now, not before: so a call is found with the last of its facts, and levels come in order
        index.add(fact)
        for stream, place in by_predicate.get(fact[0], ()):
            if level_of[fact] >= (levels if stream.is_test else growing):
                optimism.complete = False
                continue
            domain = stream.declaration.domain
            binding = unify(domain[place], fact, {})
            if binding is not None:
                rest = (*domain[:place], *domain[place + 1 :])
                for complete in list(index.join(rest, binding)):
                    guess(stream, complete)
    return optimism


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
    return {atom.predicate for atom, _ in atoms_of(task)}
