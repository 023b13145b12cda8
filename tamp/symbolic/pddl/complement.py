"""Complements of predicates that Python decides, for conditions that need them to be false.

A `:predicate` of a streams file is true where its function says so, and what a test stream
certifies is true where the test passes. Streams can only promise that something holds; so where a
condition is helped by the predicate being false, it is rewritten over a complement, `not-P`, that a
stream of its own promises. Where an effect has it in its condition, the action is given the
precondition that one of the two is known.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from tamp.symbolic.pddl.atoms import signed_atoms
from tamp.symbolic.pddl.structs import (
    Action,
    And,
    Atom,
    Derived,
    Domain,
    Effect,
    Exists,
    Forall,
    Formula,
    Not,
    Or,
    Predicate,
    Stream,
)


def complement_name(predicate: str, domain: Domain) -> str:
    """Name a predicate's complement."""
    name = f"not-{predicate}"
    while name in domain.predicates:
        name += "~"
    return name


def negated_tests(streams: Sequence[Stream], domain: Domain, goal: Formula) -> dict[str, Stream]:
    """Return the test streams that a condition asks to fail, by the predicate that each
    certifies alone.
    """
    asked = {atom.predicate for atom, sign in atoms_of_conditions(domain, goal) if not sign}
    makers: dict[str, list[Stream]] = {}
    for stream in streams:
        for atom in stream.certified:
            makers.setdefault(atom.predicate, []).append(stream)
    return {
        predicate: made[0]
        for predicate, made in makers.items()
        if predicate in asked
        and len(made) == 1
        and not made[0].outputs
        and not made[0].fluents
        and len(made[0].certified) == 1
        and sorted(made[0].certified[0].terms) == sorted(made[0].inputs)
    }


class Complements(NamedTuple):
    """The predicates that are written instead where a predicate has to be false.

    Attributes:
        complements: Of decided predicates: what holds when the predicate does not.
        copies: Of derived predicates needed both ways that rest on decided ones: what holds unless
            the complements say that it does not.
    """

    complements: dict[str, str]
    copies: dict[str, str]


def with_complements(
    domain: Domain, goal: Formula, decided: Collection[str]
) -> tuple[Domain, Formula]:
    """Rewrite actions, rules and goal so that the decided predicates and their complements occur
    positively only.

    In a rule, what helps depends on how the rule is used: `(blocked ?t)`, of which actions need the
    negation, is helped by what makes it true being false. A derived predicate that is needed both
    ways gets a copy for the negations.
    """
    names = {
        predicate: complement_name(predicate, domain)
        for predicate in decided
        if predicate in domain.predicates
    }
    if not names:
        return domain, goal
    signs = _signs(domain, goal)
    both = [
        predicate for predicate in _dependent(domain, names) if len(signs.get(predicate, ())) == 2
    ]
    instead = Complements(
        names, {predicate: complement_name(predicate, domain) for predicate in both}
    )
    predicates = dict(domain.predicates)
    for predicate, name in {**instead.complements, **instead.copies}.items():
        predicates[name] = Predicate(name, domain.predicates[predicate].parameters)
    rules: list[Derived] = []

    for rule in domain.derived:
        predicate = rule.head.predicate
        needed = signs.get(predicate, {True})
        rules.append(replace(rule, body=_rewrite(rule.body, True, instead, True in needed)))
        if predicate in instead.copies:
            head = replace(rule.head, predicate=instead.copies[predicate])
            rules.append(replace(rule, head=head, body=_rewrite(rule.body, True, instead, False)))

    actions = tuple(_rewritten(action, instead) for action in domain.actions)
    changed = replace(domain, predicates=predicates, actions=actions, derived=tuple(rules))
    return changed, _rewrite(goal, True, instead, True)


def _rewritten(action: Action, instead: Complements) -> Action:
    """Rewrite the action over complements; whether an effect happens must be known where a
    decided predicate says so.
    """
    conditions = [_rewrite(action.precondition, True, instead, True)]
    effects: list[Effect] = []
    for effect in action.effects:
        happens = _rewrite(effect.condition, True, instead, True)
        does_not = _rewrite(Not(effect.condition), True, instead, True)
        if happens != effect.condition or does_not != Not(effect.condition):
            decided = Or((happens, does_not))
            conditions.append(Forall(effect.parameters, decided) if effect.parameters else decided)
        effects.append(replace(effect, condition=happens))
    return replace(
        action,
        precondition=And(tuple(conditions)) if conditions[1:] else conditions[0],
        effects=tuple(effects),
    )


def _dependent(domain: Domain, decided: Collection[str]) -> list[str]:
    """Return the derived predicates that rest on decided ones, in any number of steps."""
    found: dict[str, None] = {}
    more = True
    while more:
        more = False
        for rule in domain.derived:
            used = {atom.predicate for atom, _ in signed_atoms(rule.body)}
            if rule.head.predicate not in found and any(
                one in decided or one in found for one in used
            ):
                found[rule.head.predicate] = None
                more = True
    return list(found)


def _signs(domain: Domain, goal: Formula) -> dict[str, set[bool]]:
    """Tell for each derived predicate whether it is needed to hold, not to hold, or both."""
    derived = domain.derived_predicates
    signs: dict[str, set[bool]] = {}
    for atom, sign in atoms_of_conditions(domain, goal):
        if atom.predicate in derived:
            signs.setdefault(atom.predicate, set()).add(sign)
    return signs


def atoms_of_conditions(domain: Domain, goal: Formula) -> Iterator[tuple[Atom, bool]]:
    """Generate the atoms of all conditions, and of rules as they are used, each with whether it
    helps by holding.
    """
    derived = domain.derived_predicates
    seen: set[tuple[str, bool]] = set()
    stack = [*signed_atoms(goal)]
    for action in domain.actions:
        stack += signed_atoms(action.precondition)
        for effect in action.effects:
            stack += [
                (atom, sign)
                for atom, one in signed_atoms(effect.condition)
                for sign in (one, not one)
            ]
    while stack:
        atom, sign = stack.pop()
        yield atom, sign
        if atom.predicate in derived and (atom.predicate, sign) not in seen:
            seen.add((atom.predicate, sign))
            for rule in domain.derived:
                if rule.head.predicate == atom.predicate:
                    stack += signed_atoms(rule.body, sign)


def _rewrite(formula: Formula, sign: bool, instead: Complements, helps: bool) -> Formula:
    """Rewrite a formula. `helps`: whether the whole is needed to hold; `sign`: whether we are
    under no negation in it.
    """
    match formula:
        case Atom(predicate, terms, place):
            if sign is helps:
                return formula
            if predicate in instead.complements:
                return Not(Atom(instead.complements[predicate], terms, place))
            return Atom(instead.copies.get(predicate, predicate), terms, place)
        case Not(body):
            inner = _rewrite(body, not sign, instead, helps)
            return inner.body if isinstance(inner, Not) and inner != body else Not(inner)
        case And(parts):
            return And(tuple(_rewrite(part, sign, instead, helps) for part in parts))
        case Or(parts):
            return Or(tuple(_rewrite(part, sign, instead, helps) for part in parts))
        case Exists(parameters, body):
            return Exists(parameters, _rewrite(body, sign, instead, helps))
        case Forall(parameters, body):
            return Forall(parameters, _rewrite(body, sign, instead, helps))
