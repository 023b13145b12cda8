"""Predicates that Python decides, in conditions that need them to be false.

A `:predicate` of a streams file is true where its function says so, and what a test stream certifies is true where the
test passes. Streams can only promise that something holds; so where a condition is helped by the predicate being false,
it is rewritten over a complement, `not-P`, that a stream of its own promises.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

from tamp.pddl.nodes import error
from tamp.pddl.structs import And, Atom, Derived, Domain, Exists, Forall, Formula, Not, Or, Predicate, Stream


def complement_name(predicate: str, domain: Domain) -> str:
    """The name of a predicate's complement."""
    name = f"not-{predicate}"
    while name in domain.predicates:
        name += "~"
    return name


def negated_tests(streams: Sequence[Stream], domain: Domain, goal: Formula) -> dict[str, Stream]:
    """The test streams that a condition asks to fail, by the predicate that each certifies alone."""
    asked = {atom.predicate for atom, sign in _all(domain, goal) if not sign}
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


def with_complements(domain: Domain, goal: Formula, decided: Collection[str]) -> tuple[Domain, Formula]:
    """Rewrite actions, rules and goal so that the decided predicates and their complements occur positively only.

    In a rule, what helps depends on how the rule is used: `(blocked ?t)`, of which actions need the negation, is helped
    by what makes it true being false.

    Raises:
        InputError: One stands in an effect's condition, or in a rule that is needed both true and false.
    """
    names = {predicate: complement_name(predicate, domain) for predicate in decided if predicate in domain.predicates}
    if not names:
        return domain, goal
    signs = _signs(domain, goal)
    predicates = dict(domain.predicates)
    for predicate, name in names.items():
        predicates[name] = Predicate(name, domain.predicates[predicate].parameters)
    for action in domain.actions:
        for effect in action.effects:
            for atom, _ in _atoms(effect.condition, True):
                if atom.predicate in names and atom.place:
                    what = f"'{atom.predicate}' is decided by Python, it cannot stand in the condition of an effect"
                    raise error(
                        atom.place, what, remedy="Make two actions of it, with the condition in the precondition"
                    )
    rules: list[Derived] = []
    for rule in domain.derived:
        needed = signs.get(rule.head.predicate, {True})
        if len(needed) == 1:
            body = _rewrite(rule.body, True, names, *needed)
        else:
            body = _untouched(rule.body, rule.head.predicate, names)
        rules.append(replace(rule, body=body))
    actions = [replace(a, precondition=_rewrite(a.precondition, True, names, True)) for a in domain.actions]
    changed = replace(domain, predicates=predicates, actions=tuple(actions), derived=tuple(rules))
    return changed, _rewrite(goal, True, names, True)


def _signs(domain: Domain, goal: Formula) -> dict[str, set[bool]]:
    """For each derived predicate, whether it is needed to hold, not to hold, or both."""
    derived = domain.derived_predicates
    signs: dict[str, set[bool]] = {}
    for atom, sign in _all(domain, goal):
        if atom.predicate in derived:
            signs.setdefault(atom.predicate, set()).add(sign)
    return signs


def _all(domain: Domain, goal: Formula) -> Iterator[tuple[Atom, bool]]:
    """The atoms of all conditions, and of rules as they are used, each with whether it helps by holding."""
    derived = domain.derived_predicates
    seen: set[tuple[str, bool]] = set()
    stack = [*_atoms(goal, True)]
    for action in domain.actions:
        stack += _atoms(action.precondition, True)
        for effect in action.effects:
            stack += [(atom, sign) for atom, one in _atoms(effect.condition, True) for sign in (one, not one)]
    while stack:
        atom, sign = stack.pop()
        yield atom, sign
        if atom.predicate in derived and (atom.predicate, sign) not in seen:
            seen.add((atom.predicate, sign))
            for rule in domain.derived:
                if rule.head.predicate == atom.predicate:
                    stack += _atoms(rule.body, sign)


def _untouched(body: Formula, head: str, names: dict[str, str]) -> Formula:
    """A rule that is needed both ways, which therefore mentions no decided predicate."""
    for atom, _ in _atoms(body, True):
        if atom.predicate in names and atom.place:
            what = f"'{head}' is needed both true and false, and rests on '{atom.predicate}', which Python decides"
            raise error(atom.place, what, remedy="Give the two uses a rule each")
    return body


def _rewrite(formula: Formula, sign: bool, names: dict[str, str], helps: bool) -> Formula:
    """`helps`: whether the formula as a whole is needed to hold; `sign`: whether we are under no negation in it."""
    match formula:
        case Atom(predicate, terms, place):
            if predicate in names and sign is not helps:
                return Not(Atom(names[predicate], terms, place))
            return formula
        case Not(body):
            inner = _rewrite(body, not sign, names, helps)
            return inner.body if isinstance(inner, Not) and inner != body else Not(inner)
        case And(parts):
            return And(tuple(_rewrite(part, sign, names, helps) for part in parts))
        case Or(parts):
            return Or(tuple(_rewrite(part, sign, names, helps) for part in parts))
        case Exists(parameters, body):
            return Exists(parameters, _rewrite(body, sign, names, helps))
        case Forall(parameters, body):
            return Forall(parameters, _rewrite(body, sign, names, helps))


def _atoms(formula: Formula, sign: bool) -> Iterator[tuple[Atom, bool]]:
    match formula:
        case Atom():
            yield formula, sign
        case Not(body):
            yield from _atoms(body, not sign)
        case And(parts) | Or(parts):
            for part in parts:
                yield from _atoms(part, sign)
        case Exists(_, body) | Forall(_, body):
            yield from _atoms(body, sign)
