"""Tests that may be assumed to hold, and the atoms of a task's conditions that tell which."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping

from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.pddl.atoms import atoms
from tamp.symbolic.pddl.structs import Atom, Task
from tamp.symbolic.search.instantiation.effects import lifted_effects
from tamp.symbolic.search.instantiation.normal_form import Literals, Normalizer
from tamp.symbolic.search.instantiation.predicate_kinds import PredicateKinds


def assumable(streams: Iterable[BoundStream], task: Task) -> dict[str, tuple[BoundStream, Atom]]:
    """Return the tests whose facts only lift a guard (see `guard_lifters`).

    Such a test certifies one fact with all its inputs in it, and no other stream certifies or needs
    that predicate. It is asked of what streams give, of types, or of given facts (`given_for`).
    """
    everything = list(streams)
    lifters = guard_lifters(task)
    # An action names objects as well, for which no stream need have said what a test wants.
    direct = {atom.predicate for atom in atoms_of_actions(task)}
    changing = task.domain.fluent_predicates | {rule.head.predicate for rule in task.domain.derived}
    needed = {atom.predicate for stream in everything for atom in stream.declaration.domain}

    producers: dict[str, list[tuple[BoundStream, Atom]]] = defaultdict(list)
    for stream in everything:
        for atom in stream.declaration.certified:
            producers[atom.predicate].append((stream, atom))

    found: dict[str, tuple[BoundStream, Atom]] = {}
    for predicate, made in producers.items():
        stream, fact = made[0]
        domain = {atom.predicate for atom in stream.declaration.domain}
        is_only_asked = len(made) == 1 and predicate in lifters and predicate not in needed
        is_of_its_inputs = (
            stream.is_test
            and len(stream.declaration.certified) == 1
            and set(stream.declaration.inputs) == set(fact.terms)
        )
        if (
            is_only_asked
            and is_of_its_inputs
            and changing.isdisjoint(domain)
            and (predicate not in direct or domain.isdisjoint(producers))
        ):
            found[predicate] = made[0]
    return found


def given_for(
    tests: Mapping[str, tuple[BoundStream, Atom]], streams: Iterable[BoundStream], task: Task
) -> dict[str, list[tuple[str, tuple[int, ...]]]]:
    """Return for each assumable test the given facts without which it is never asked.

    Those are facts of its domain that neither streams give nor types say: predicates, and the
    places of their terms in the test's own fact.
    """
    made = {atom.predicate for stream in streams for atom in stream.declaration.certified}
    types = {"object", *task.domain.types}
    return {
        predicate: [
            (atom.predicate, tuple(fact.terms.index(term) for term in atom.terms))
            for atom in stream.declaration.domain
            if atom.predicate not in made and atom.predicate not in types
        ]
        for predicate, (stream, fact) in tests.items()
    }


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
    lifting: set[str] = set()
    others: set[str] = set()
    rules: dict[tuple[str, bool], None] = {}

    def walk(literals: Literals, refuted: bool) -> None:
        for sign, part in ((True, literals.positive), (False, literals.negative)):
            for name in (atom.predicate for atom in part):
                if name not in normalizer.definitions:
                    (lifting if refuted and not sign else others).add(name)
                    continue
                if sign or refuted:
                    rules.setdefault((name, False))  # a join goes over the facts that hold
                if sign is refuted:
                    rules.setdefault((name, True))

    for literals in roots:
        walk(literals, False)
    done = 0
    while done < len(rules):
        name, refuted = list(rules)[done]
        done += 1
        if refuted and name in recursive and not name.startswith("forall "):
            rules.setdefault((name, False))
        for definition in normalizer.definitions[name]:
            walk(definition.literals, refuted)
    return frozenset(lifting - others)


def atoms_of(task: Task) -> Iterator[Atom]:
    """Yield the atoms of all conditions."""
    yield from atoms_of_actions(task)
    for rule in task.domain.derived:
        yield from atoms(rule.body)


def atoms_of_actions(task: Task) -> Iterator[Atom]:
    """Yield the atoms of the goal and of the conditions of actions."""
    conditions = [task.goal]
    for action in task.domain.actions:
        conditions += [action.precondition, *(effect.condition for effect in action.effects)]
    for condition in conditions:
        yield from atoms(condition)
