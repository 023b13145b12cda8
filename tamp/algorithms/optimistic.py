"""Streams instantiated optimistically: every call is assumed to succeed, its outputs are placeholders."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from tamp.algorithms.stream import BoundStream, ground
from tamp.pddl.structs import And, Atom, Exists, Fact, Forall, Formula, Not, Or, Task

MARK = "#"
"""Placeholders begin with it: "#p3" stands for any pose that its stream may yield."""


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
    def is_grounded(self) -> bool:
        """Whether all inputs are real, so that what its function says of them is final."""
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
        makers: Fact to the guess that certifies it.
        types: Placeholder to its types.
        assumed: The predicates of tests that are taken to hold wherever they are asked for, instead of being imagined
            one by one: there are as many as pairs of poses. Each with its stream and the atom that it certifies.
    """

    makers: dict[Fact, Guess] = field(default_factory=dict[Fact, Guess])
    types: dict[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    assumed: Mapping[str, tuple[BoundStream, Atom]] = field(default_factory=dict[str, tuple[BoundStream, Atom]])

    def maker(self, fact: Fact) -> Guess | None:
        """The call that certifies a fact; that of an assumed one is made up when it is asked for."""
        known = self.makers.get(fact)
        if known is not None or fact[0] not in self.assumed:
            return known
        stream, atom = self.assumed[fact[0]]
        declaration = stream.declaration
        binding = dict(zip(atom.terms, fact[1:], strict=True))
        inputs = tuple(binding[name] for name in declaration.inputs)
        domain = ground(declaration.domain, declaration.inputs, inputs)
        certified = ground(declaration.certified, declaration.inputs, inputs)
        made = self.makers[fact] = Guess(stream, inputs, (), domain, certified, 0)
        return made


def imagine(
    streams: Sequence[BoundStream],
    facts: Iterable[Fact],
    *,
    dead: frozenset[tuple[str, tuple[str, ...]]] = frozenset(),
    levels: int = 8,
    limit: int = 50_000,
    names: dict[tuple[str, tuple[str, ...]], Named] | None = None,
) -> Optimism:
    """Instantiate streams from known facts and from each other's promises, to a fixpoint or `levels` deep.

    Args:
        streams: Those worth instantiating (see `relevant`).
        facts: Known static facts, types as unary facts among them.
        dead: Calls (stream, inputs) that are known to yield nothing.
        levels: Greatest depth of guesses resting on guesses.
        limit: Greatest number of guesses.
        names: The placeholders of calls imagined before, and the facts about them, kept and added to: what was learned
            is kept under their names, so a name must always mean the same.
    """
    optimism = Optimism()
    index = _Index()
    named: dict[tuple[str, tuple[str, ...]], Named] = {} if names is None else names
    counts = Counter(name.rstrip("0123456789") for call in named.values() for name in call.outputs)
    seen: set[tuple[str, tuple[str, ...]]] = set(dead)
    level_of: dict[Fact, int] = {}
    queue: list[Fact] = []
    for fact in facts:
        if index.add(fact):
            level_of[fact] = 0
            queue.append(fact)
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
        domain = ground(declaration.domain, declaration.inputs, inputs) if call is None else call.domain
        level = 1
        for fact in domain:
            if level_of[fact] >= level:
                level = level_of[fact] + 1
        if level > levels or len(seen) > limit:
            return
        if call is None:
            outputs: list[str] = []
            for name in declaration.outputs:
                prefix = MARK + name.lstrip("?").rstrip("0123456789")
                counts[prefix] += 1
                outputs.append(f"{prefix}{counts[prefix]}")
            variables = (*declaration.inputs, *declaration.outputs)
            certified = ground(declaration.certified, variables, (*inputs, *outputs))
            call = named[key] = Named(tuple(outputs), domain, certified)
        if call.outputs:
            optimism.types.update(zip(call.outputs, stream.output_types, strict=True))
        made = Guess(stream, inputs, call.outputs, domain, call.certified, level)
        for fact in call.certified:
            if index.add(fact):
                optimism.makers[fact] = made
                level_of[fact] = level
                queue.append(fact)

    for stream in streams:
        if not stream.declaration.domain and not stream.declaration.inputs:
            guess(stream, {})
    position = 0
    while position < len(queue):
        fact = queue[position]
        position += 1
        for stream, place in by_predicate.get(fact[0], ()):
            domain = stream.declaration.domain
            binding = _unify(domain[place], fact, {})
            if binding is not None:
                rest = (*domain[:place], *domain[place + 1 :])
                for complete in list(index.join(rest, binding)):
                    guess(stream, complete)
    return optimism


def relevant(streams: Iterable[BoundStream], predicates: Iterable[str]) -> list[BoundStream]:
    """The streams whose certified facts the given predicates, or other relevant streams, can use."""
    needed = set(predicates)
    remaining = list(streams)
    chosen: list[BoundStream] = []
    progress = True
    while progress:
        progress = False
        for stream in list(remaining):
            if any(atom.predicate in needed for atom in stream.declaration.certified):
                remaining.remove(stream)
                chosen.append(stream)
                needed.update(atom.predicate for atom in stream.declaration.domain)
                progress = True
    order = {stream.name: i for i, stream in enumerate(streams)}
    return sorted(chosen, key=lambda stream: order[stream.name])


def type_facts(task: Task) -> list[Fact]:
    """Types as unary facts, an object's own and those above: (movable mug), (body mug), (object mug)."""
    facts: dict[Fact, None] = {}
    domain = task.domain
    for name, types in {**domain.constants, **task.objects}.items():
        for type_ in ("object", *domain.types):
            if type_ == "object" or any(domain.is_a(own, type_) for own in types):
                facts[type_, name] = None
    return list(facts)


def assumable(streams: Iterable[BoundStream], task: Task) -> dict[str, tuple[BoundStream, Atom]]:
    """The test streams whose facts are only asked for in order to lift a guard: under a negation in a derived rule.

    Such a test certifies one fact with all its inputs in it, and no other stream certifies or needs that predicate.
    """
    everything = list(streams)
    positive = {atom.predicate for atom, sign in _atoms(task) if sign}
    positive |= {atom.predicate for stream in everything for atom in stream.declaration.domain}
    makers: dict[str, list[tuple[BoundStream, Atom]]] = defaultdict(list)
    for stream in everything:
        for atom in stream.declaration.certified:
            makers[atom.predicate].append((stream, atom))
    return {
        predicate: made[0]
        for predicate, made in makers.items()
        if len(made) == 1
        and made[0][0].is_test
        and len(made[0][0].declaration.certified) == 1
        and set(made[0][0].declaration.inputs) == set(made[0][1].terms)
        and predicate not in positive
    }


def used_predicates(task: Task) -> set[str]:
    """The predicates that conditions of the task mention."""
    return {atom.predicate for atom, _ in _atoms(task)}


def _atoms(task: Task) -> Iterator[tuple[Atom, bool]]:
    """The atoms of all conditions, each with whether it helps by holding.

    In an action's condition a negation counts as help, since only a derived rule's negation can become a guard.
    """
    stack: list[tuple[Formula, bool, bool]] = [(task.goal, True, False)]
    stack += [(action.precondition, True, False) for action in task.domain.actions]
    stack += [(effect.condition, True, False) for action in task.domain.actions for effect in action.effects]
    stack += [(rule.body, True, True) for rule in task.domain.derived]
    while stack:
        formula, sign, in_rule = stack.pop()
        match formula:
            case Atom():
                yield formula, sign
            case And(parts) | Or(parts):
                stack += [(part, sign, in_rule) for part in parts]
            case Not(body):
                stack.append((body, sign != in_rule, in_rule))
            case Exists(_, body) | Forall(_, body):
                stack.append((body, sign, in_rule))


class _Index:
    """Facts by predicate, and by predicate, position and object."""

    def __init__(self) -> None:
        self._all: set[Fact] = set()
        self._by_predicate: dict[str, list[Fact]] = defaultdict(list)
        self._by_object: dict[tuple[str, int, str], list[Fact]] = defaultdict(list)

    def add(self, fact: Fact) -> bool:
        """Whether the fact is new."""
        if fact in self._all:
            return False
        self._all.add(fact)
        self._by_predicate[fact[0]].append(fact)
        for position in range(1, len(fact)):
            self._by_object[(fact[0], position, fact[position])].append(fact)
        return True

    def join(self, atoms: Sequence[Atom], binding: dict[str, str]) -> Iterator[dict[str, str]]:
        """All extensions of the binding under which every atom is a known fact."""
        if not atoms:
            yield binding
            return
        candidates = [self._candidates(atom, binding) for atom in atoms]
        first = min(range(len(atoms)), key=lambda i: len(candidates[i]))
        rest = (*atoms[:first], *atoms[first + 1 :])
        for fact in list(candidates[first]):
            extended = _unify(atoms[first], fact, binding)
            if extended is not None:
                yield from self.join(rest, extended)

    def _candidates(self, atom: Atom, binding: Mapping[str, str]) -> Sequence[Fact]:
        best: Sequence[Fact] = self._by_predicate.get(atom.predicate, ())
        for position, term in enumerate(atom.terms, start=1):
            name = binding.get(term) if term.startswith("?") else term
            if name is not None:
                found = self._by_object.get((atom.predicate, position, name), ())
                if len(found) < len(best):
                    best = found
        return best


def _unify(atom: Atom, fact: Fact, binding: dict[str, str]) -> dict[str, str] | None:
    if len(fact) != len(atom.terms) + 1 or fact[0] != atom.predicate:
        return None
    extended = dict(binding)
    for term, name in zip(atom.terms, fact[1:], strict=True):
        if term[0] != "?":
            if term != name:
                return None
        elif extended.setdefault(term, name) != name:
            return None
    return extended
