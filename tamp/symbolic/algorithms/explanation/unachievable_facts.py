"""Reasons why a fact is unachievable: the precondition at which the nearest way to it ends."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.pddl.atoms import necessary_atoms
from tamp.symbolic.pddl.structs import And, Atom, Exists, Fact, Formula, Parameter, Task

MAX_CHAIN = 4
"""Steps of a chain of missing facts that are worth reading."""

MAX_FACTS_EXAMINED = 2000
"""Facts looked at for each way to a fact; after that the best so far counts."""

Binding = dict[str, str]


@dataclass(frozen=True)
class Achiever:
    """An action, rule or stream that could make a fact true: name, conditions, variables' types."""

    name: str
    conditions: tuple[Atom, ...]
    types: Mapping[str, tuple[str, ...]]
    binding: Binding


class UnachievableFacts:
    """Looks for what is missing.

    Args:
        task: Its actions and rules.
        streams: Those of the task.
        facts: All that can become true, optimistically.
        types: Of objects and placeholders.
        assumed: Predicates whose facts are taken to hold wherever they are asked for.
    """

    def __init__(
        self,
        task: Task,
        streams: Sequence[BoundStream],
        facts: Iterable[Fact],
        types: Mapping[str, tuple[str, ...]],
        assumed: Iterable[str] = (),
    ) -> None:
        self._task, self._streams, self._types = task, streams, types
        self._assumed = frozenset(assumed)
        self._facts = frozenset(facts)
        self._by_predicate: dict[str, list[Fact]] = defaultdict(list)
        for fact in sorted(self._facts):
            self._by_predicate[fact[0]].append(fact)
        self._examined = 0

    def reason(self, fact: Fact) -> tuple[str, tuple[str, ...]]:
        """Say why nothing makes the fact true: "cook needs (hot stove), which nothing makes
        true"; list the terms of what is missing.
        """
        said: list[str] = []
        terms: list[str] = []
        seen = {fact}
        for _ in range(MAX_CHAIN):
            found = self._nearest(fact)
            if found is None:
                break
            name, lacks = found
            said.append(f"{name} needs {' and '.join(map(_shown, lacks))}")
            terms += [term for atom in lacks for term in atom.terms]
            fact = (lacks[0].predicate, *lacks[0].terms)
            if fact in seen:
                break
            seen.add(fact)
        if not said:
            return "no action makes it true", ()
        return f"{', and '.join(said)}, which nothing makes true", tuple(terms)

    def _nearest(self, fact: Fact) -> tuple[str, list[Atom]] | None:
        """Find the way to a fact that lacks least, and what; None if no way lacks anything."""
        best: tuple[str, list[Atom]] | None = None
        for achiever in self._achievers(fact):
            self._examined = 0
            lacks = self._missing_preconditions(
                list(achiever.conditions),
                achiever.binding,
                achiever.types,
                len(achiever.conditions) + 1,
            )
            if lacks and (best is None or len(lacks) < len(best[1])):
                best = achiever.name, lacks
        return best

    def _achievers(self, fact: Fact) -> Iterator[Achiever]:
        domain = self._task.domain
        for action in domain.actions:
            for effect in action.effects:
                if effect.adds:
                    conditions = (
                        *necessary_atoms(action.precondition),
                        *necessary_atoms(effect.condition),
                    )
                    parameters = (*action.parameters, *effect.parameters)
                    yield from self._achiever(
                        action.name, effect.atom, conditions, _typed(parameters), fact
                    )

        for rule in domain.derived:
            types = {**_typed(rule.parameters), **_inner(rule.body)}
            yield from self._achiever(
                f"being {rule.head.predicate}", rule.head, necessary_atoms(rule.body), types, fact
            )

        for stream in self._streams:
            declared = stream.declaration
            for atom in declared.certified:
                yield from self._achiever(stream.name, atom, declared.domain, {}, fact)

    def _achiever(
        self,
        name: str,
        head: Atom,
        conditions: Iterable[Atom],
        types: Mapping[str, tuple[str, ...]],
        fact: Fact,
    ) -> Iterator[Achiever]:
        if head.predicate == fact[0]:
            binding = self._matched(head, fact, {}, types)
            if binding is not None:
                yield Achiever(name, tuple(conditions), types, binding)

    def _missing_preconditions(
        self,
        conditions: list[Atom],
        binding: Binding,
        types: Mapping[str, tuple[str, ...]],
        fewer: int,
    ) -> list[Atom] | None:
        """Find the conditions that the best binding cannot have, if they are fewer than that."""
        if not conditions:
            return []

        atom = min(
            conditions,
            key=lambda one: sum(term not in binding for term in one.terms if term[:1] == "?"),
        )
        others = [one for one in conditions if one is not atom]
        best: list[Atom] | None = None
        if atom.predicate in self._assumed or atom.predicate == "=":
            return self._missing_preconditions(others, binding, types, fewer)

        for fact in self._by_predicate[atom.predicate]:
            self._examined += 1
            if self._examined > MAX_FACTS_EXAMINED:
                break
            grown = self._matched(atom, fact, binding, types)
            if grown is None:
                continue
            found = self._missing_preconditions(others, grown, types, fewer)
            if found is not None and len(found) < fewer:
                best, fewer = found, len(found)
            if best == [] or grown == binding:
                return best

        if fewer > 1:
            found = self._missing_preconditions(others, binding, types, fewer - 1)
            if found is not None and len(found) + 1 < fewer:
                best = [
                    Atom(atom.predicate, tuple(binding.get(term, term) for term in atom.terms)),
                    *found,
                ]
        return best

    def _matched(
        self, atom: Atom, fact: Fact, binding: Binding, types: Mapping[str, tuple[str, ...]]
    ) -> Binding | None:
        if len(atom.terms) != len(fact) - 1:
            return None
        grown = dict(binding)
        for term, word in zip(atom.terms, fact[1:], strict=True):
            if word.startswith("?"):  # any object
                continue
            if not term.startswith("?"):
                if term != word:
                    return None
            elif grown.setdefault(term, word) != word or not self._fits(
                word, types.get(term, ("object",))
            ):
                return None
        return grown

    def _fits(self, word: str, wanted: tuple[str, ...]) -> bool:
        return self._task.domain.fits(self._types.get(word, ()), wanted)


def _inner(formula: Formula) -> dict[str, tuple[str, ...]]:
    if isinstance(formula, And):
        return {name: types for part in formula.parts for name, types in _inner(part).items()}
    return (
        {**_typed(formula.parameters), **_inner(formula.body)}
        if isinstance(formula, Exists)
        else {}
    )


def _typed(parameters: Iterable[Parameter]) -> dict[str, tuple[str, ...]]:
    return {parameter.name: parameter.types for parameter in parameters}


def _shown(atom: Atom) -> str:
    """Write a fact to read; of what is not known yet there is "some"."""
    terms = (f"some {term[1:]}" if term[:1] == "?" else term for term in atom.terms)
    return f"({' '.join([atom.predicate, *terms])})"
