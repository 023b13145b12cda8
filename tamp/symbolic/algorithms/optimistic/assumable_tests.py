"""Tests that may be assumed to hold, and the atoms of a task's conditions that tell which."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence

from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.pddl.atoms import atoms
from tamp.symbolic.pddl.structs import Atom, Task
from tamp.symbolic.search.instantiation.effects import lifted_effects
from tamp.symbolic.search.instantiation.normal_form import Normalizer
from tamp.symbolic.search.instantiation.predicate_kinds import PredicateKinds

Certifiers = Mapping[str, Sequence[tuple[BoundStream, Atom]]]
"""By predicate the streams that certify it, each with the atom of its declaration."""


def assumable(streams: Iterable[BoundStream], task: Task) -> dict[str, tuple[BoundStream, Atom]]:
    """Return the tests whose facts only lift a guard (see `guard_lifters`).

    Such a test certifies one fact with all its inputs in it, and no other stream certifies or needs
    that predicate. Of what it may be asked is told by facts to look up (see `given_for`).
    """
    everything = list(streams)
    certifiers = _certifiers(everything)
    lifters = guard_lifters(task)
    needed = {atom.predicate for stream in everything for atom in stream.declaration.domain}

    found: dict[str, tuple[BoundStream, Atom]] = {}
    for predicate, made in certifiers.items():
        stream, fact = made[0]
        is_only_asked = len(made) == 1 and predicate in lifters and predicate not in needed
        is_of_its_inputs = (
            stream.is_test
            and len(stream.declaration.certified) == 1
            and set(stream.declaration.inputs) == set(fact.terms)
        )
        if is_only_asked and is_of_its_inputs and _looked_up(made[0], certifiers, task) is not None:
            found[predicate] = made[0]
    return found


def given_for(
    tests: Mapping[str, tuple[BoundStream, Atom]], streams: Iterable[BoundStream], task: Task
) -> dict[str, list[tuple[str, tuple[int, ...]]]]:
    """Return for each assumable test the facts without which it is never asked.

    They are looked up where the test is asked for: predicates, and the places of their terms in the
    test's own fact.
    """
    certifiers = _certifiers(streams)
    return {
        predicate: _looked_up(test, certifiers, task) or [] for predicate, test in tests.items()
    }


def _certifiers(streams: Iterable[BoundStream]) -> Certifiers:
    found: dict[str, list[tuple[BoundStream, Atom]]] = defaultdict(list)
    for stream in streams:
        for atom in stream.declaration.certified:
            found[atom.predicate].append((stream, atom))
    return found


def _looked_up(
    test: tuple[BoundStream, Atom], certifiers: Certifiers, task: Task
) -> list[tuple[str, tuple[int, ...]]] | None:
    """List what has to be looked up of the terms of a test's fact before it may be asked; None
    where its terms do not tell.

    A fact of its domain that is given, or comes with a value that is drawn, is there as soon as its
    terms are. One that another test certifies comes when that is asked: what that test's domain
    says of the same terms is looked up in its place.
    """
    stream, fact = test
    types = {"object", *task.domain.types}
    given = {fact_[0] for fact_ in task.initial}
    changing = task.domain.fluent_predicates | {rule.head.predicate for rule in task.domain.derived}
    found: dict[tuple[str, tuple[int, ...]], None] = {}
    pending = list(stream.declaration.domain)

    for atom in pending:  # it grows
        if not set(atom.terms) <= set(fact.terms) or atom.predicate in changing:
            return None
        if atom.predicate in types and len(atom.terms) == 1:
            continue

        made = certifiers.get(atom.predicate, ())
        if all(set(one.terms) & set(by.declaration.outputs) for by, one in made):
            found[atom.predicate, tuple(fact.terms.index(term) for term in atom.terms)] = None
            continue
        if len(made) > 1 or atom.predicate in given:
            return None
        by, one = made[0]
        binding = dict(zip(one.terms, atom.terms, strict=True))
        further = [
            Atom(other.predicate, tuple(binding.get(term, term) for term in other.terms))
            for other in by.declaration.domain
        ]
        if not set(by.declaration.inputs) <= binding.keys():
            return None
        pending += [other for other in further if other not in pending]
    return list(found)


def guard_lifters(task: Task) -> frozenset[str]:
    """Return the predicates of which conditions ask nothing but that a fact lifts a guard.

    A guard comes from a rule that is only ever refuted, a derived one or the body of a `not
    exists`: `not exists b, q. at(b, q) and not free(p, q)` is guarded by each at(b, q), and
    free(p, q) lifts that. The polarity is that of the normal form, in which rules are unfolded:
    what an action asks for itself, even under a negation, and what a rule asks for that has to
    hold, is no guard.
    """
    derived = {rule.head.predicate for rule in task.domain.derived}
    given = frozenset(derived.intersection(fact[0] for fact in task.initial))
    normalizer = Normalizer(task.domain, given)
    roots = normalizer.split(task.goal, {})
    for action in task.domain.actions:
        scope = {parameter.name: parameter.types for parameter in action.parameters}
        roots += normalizer.split(action.precondition, scope)
        roots += [c for one in lifted_effects(action, normalizer) for c in one.conditions]

    recursive = PredicateKinds(task, normalizer).recursive()  # refuted state by state
    conjunctions = [(literals, False) for literals in roots]
    for name, refuted in normalizer.polarities(roots, recursive):
        conjunctions += [(rule.literals, refuted) for rule in normalizer.definitions[name]]

    lifting: set[str] = set()
    others: set[str] = set()
    for literals, refuted in conjunctions:
        others.update(atom.predicate for atom in literals.positive)
        negated = lifting if refuted else others
        negated.update(atom.predicate for atom in literals.negative)
    return frozenset(lifting - others - normalizer.definitions.keys())


def atoms_of(task: Task) -> Iterator[Atom]:
    """Yield the atoms of all conditions."""
    conditions = [task.goal]
    for action in task.domain.actions:
        conditions += [action.precondition, *(effect.condition for effect in action.effects)]
    conditions += [rule.body for rule in task.domain.derived]
    for condition in conditions:
        yield from atoms(condition)
