"""Wanted relations: of which bodies the goal may want a relation of the user's own, in the words of
a domain that has `wanted-<relation>`.

Poses near poses near poses are endless; those that the goal speaks of are few. A chain, (left_of a
b) and (left_of b c), is as deep as the goal says.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from tamp.planner.movable_places import WANTED
from tamp.planner.settled_poses import GOAL_PREDICATES, SETTLED, settled_facts
from tamp.symbolic.pddl.atoms import necessary_atoms, signed_atoms
from tamp.symbolic.pddl.relations import (
    Relation,
    instances,
    relation_names,
    relation_of,
    streams_of,
)
from tamp.symbolic.pddl.structs import And, Atom, Domain, Fact, Formula, StreamFile

ALSO = "also-"
"""(also-R ?o ?o2): R is wanted of these, and another relation proposes where ?o is."""


def advice(domain: Domain) -> frozenset[str]:
    """Return the predicates of a domain whose facts speak of the goal, and not of the world."""
    told = {
        predicate
        for predicate in domain.predicates
        for sort in (WANTED, ALSO)
        if predicate.startswith(sort) and WANTED + predicate.removeprefix(sort) in domain.predicates
    }
    return frozenset(told.union(GOAL_PREDICATES if SETTLED in domain.predicates else ()))


def wanted_facts(
    streams: StreamFile,
    domain: Domain,
    goal: Formula,
    objects: Mapping[str, tuple[str, ...]],
    facts: Collection[Fact],
    named: Collection[str],
) -> set[Fact]:
    """Say of which bodies and places the goal, or a condition of an action, may want relations.

    Args:
        streams: They declare the relations.
        domain: Its rules are looked through.
        goal: The goal.
        objects: Types by name.
        facts: The initial facts.
        named: PDDL names of bodies and places.
    """
    placed = {fact[1] for fact in facts if fact[0] == "pose" and len(fact) == 3}
    placed |= {fact[1] for fact in facts if fact[0] == "holding"}

    found: set[Fact] = set()
    for name, relation in _told(streams, domain):
        asked = _asked(relation, domain, goal)
        patterns = {_arguments(relation, atom) for atom, helps in asked if helps}
        if not patterns:
            continue
        for bound in instances(relation, domain, objects, facts, placed, named):
            words = tuple(bound[variable] for variable in relation.arguments)
            if any(_fits(words, pattern) for pattern in patterns):
                found.add((WANTED + name, *words))
    also = _also(found, domain, goal)
    proposed = {(fact[0].removeprefix(WANTED), *fact[1:]) for fact in found}
    proposed -= {(fact[0].removeprefix(ALSO), *fact[1:]) for fact in also}
    now = any(next(_asked(one, domain, And(())), None) for _, one in _told(streams, domain))
    return found | also | settled_facts(domain, goal, placed, facts, proposed, now)


def _also(wanted: Collection[Fact], domain: Domain, goal: Formula) -> set[Fact]:
    """Say which relations of a goal's conjunction are wanted beside others.

    One relation proposes where a body is, that of most bodies, the first that the goal names:
    (left_of a b), and not (near a c) as well. Nor is a body proposed by where itself will be, as
    (near b a) would have it.
    """
    proposed: dict[str, set[str]] = {}
    also: set[Fact] = set()
    for atom in sorted(dict.fromkeys(necessary_atoms(goal)), key=lambda one: -len(one.terms)):
        if (WANTED + atom.predicate, *atom.terms) not in wanted or len(atom.terms) < 2:
            continue
        first, *others = atom.terms
        if first in proposed or _leads_to(first, others, proposed):
            also.add((ALSO + atom.predicate, *atom.terms))
        else:
            proposed[first] = {*others}
    return {fact for fact in also if fact[0] in domain.predicates}


def _leads_to(body: str, others: Collection[str], proposed: Mapping[str, set[str]]) -> bool:
    """Check whether the place of one of some bodies follows from that of a body."""
    waiting, seen = [*others], set[str]()
    while waiting:
        one = waiting.pop()
        if one == body:
            return True
        if one not in seen:
            seen.add(one)
            waiting += proposed.get(one, ())
    return False


def unasked_streams(streams: StreamFile, domain: Domain, goal: Formula) -> frozenset[str]:
    """Return the streams of relations that a domain wants to be told of and that nothing asks for:
    they need no function.
    """
    told = _told(streams, domain)
    idle = [name for name, one in told if next(_asked(one, domain, goal), None) is None]
    return frozenset(stream for name in idle for stream in streams_of(name))


def _told(streams: StreamFile, domain: Domain) -> Iterator[tuple[str, Relation]]:
    """Yield the relations that a domain wants to be told of."""
    for name in relation_names(streams):
        wanted = domain.predicates.get(WANTED + name)
        relation = None if wanted is None else relation_of(streams, domain, name)
        if wanted and relation and len(wanted.parameters) == len(relation.arguments):
            yield name, relation


def _fits(words: tuple[str, ...], pattern: tuple[str, ...]) -> bool:
    pairs = zip(words, pattern, strict=True)
    return all(meant in (word, "") for word, meant in pairs)


def _arguments(relation: Relation, atom: Atom) -> tuple[str, ...]:
    """Return a relation's arguments as an atom has them; "" for any."""
    (fact,) = (one for one in relation.facts if one.predicate == atom.predicate)
    bound = dict(zip(fact.terms, atom.terms, strict=True))
    words = (bound.get(variable, variable) for variable in relation.arguments)
    return tuple("" if word.startswith("?") else word for word in words)


def _asked(relation: Relation, domain: Domain, goal: Formula) -> Iterator[tuple[Atom, bool]]:
    """Yield atoms of a relation's facts for which goal and actions ask, through rules, each with
    whether it helps by holding.
    """
    waiting = [*signed_atoms(goal)]
    for action in domain.actions:
        waiting += signed_atoms(action.precondition)
        for effect in action.effects:
            conditions = signed_atoms(effect.condition)
            waiting += [(atom, sign) for atom, one in conditions for sign in (one, not one)]

    seen: set[tuple[str, tuple[str, ...], bool]] = set()
    while waiting:
        atom, helps = waiting.pop()
        if atom.predicate in relation.predicates:
            yield atom, helps
        for rule in domain.derived:
            if rule.head.predicate != atom.predicate:
                continue
            bound = dict(zip(rule.head.terms, atom.terms, strict=True))
            for one, way in signed_atoms(rule.body, helps):
                terms = tuple(bound.get(term, term) for term in one.terms)
                pattern = tuple("?" if term.startswith("?") else term for term in terms)
                key = (one.predicate, pattern, way)
                if key not in seen:
                    seen.add(key)
                    waiting.append((Atom(one.predicate, terms), way))
