"""Streams that wait for actions: a `:domain` that names what actions change, or what rules derive.

Such a stream may be called once its domain has come true; what it certifies then holds. So the planner asks it for
values as if that were so, and conditions read each fact that rests on it through a rule: the stream gave it, and all
of its domain that actions change was true at some time (of what rules derive: is true now). PDDLStream calls such
streams exogenous.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

from tamp.errors import InputError
from tamp.pddl.complement import atoms_of_conditions
from tamp.pddl.nodes import error
from tamp.pddl.structs import (
    Action,
    And,
    Atom,
    Derived,
    Domain,
    Effect,
    Exists,
    Fact,
    Forall,
    Formula,
    Not,
    Or,
    Parameter,
    Predicate,
    Stream,
    StreamFile,
)


@dataclass(frozen=True)
class Waiting:
    """A task whose streams speak of what never changes.

    Attributes:
        domain: With rules for what rests on a waiting stream.
        streams: Each certifies as well that it gave its outputs for its inputs.
        goal: Over those rules.
        facts: The initial ones, with what was true at first.
    """

    domain: Domain
    streams: StreamFile
    goal: Formula
    facts: frozenset[Fact]


def without_waiting(domain: Domain, streams: StreamFile, goal: Formula, facts: frozenset[Fact]) -> Waiting:
    """Move what changes from the streams' domains into rules; nothing is changed where there is none.

    Raises:
        InputError: What rests on a waiting stream has to be false somewhere.
    """
    made = [*streams.streams, *streams.rules]
    changing = domain.fluent_predicates | domain.derived_predicates
    resting = _resting(made, changing)
    if not resting:
        return Waiting(domain, streams, goal, facts)
    for atom, sign in atoms_of_conditions(domain, goal):
        if not sign and atom.predicate in resting:
            what = f"'{atom.predicate}' has to be false here, and its stream waits for what actions change"
            remedy = "Put what it waits for in the action's precondition instead of the stream's :domain"
            raise InputError(what, remedy=remedy) if atom.place is None else error(atom.place, what, remedy=remedy)
    names = _Names(domain)
    awaited = {a.predicate for stream in made for a in stream.domain if a.predicate in domain.fluent_predicates}
    now = {predicate: names.new(f"{predicate}-now", domain.predicates[predicate].parameters) for predicate in resting}
    was = {predicate: names.new(f"was-{predicate}", domain.predicates[predicate].parameters) for predicate in awaited}
    given = {
        predicate: names.new(f"given-{predicate}", domain.predicates[predicate].parameters)
        for predicate in sorted(resting)
        if any(fact[0] == predicate for fact in facts)
    }
    rules = [replace(rule, body=_renamed(rule.body, now)) for rule in domain.derived]
    for predicate, name in given.items():
        variables = tuple(f"?x{i}" for i in range(len(domain.predicates[predicate].parameters)))
        parameters = tuple(Parameter(variable) for variable in variables)
        rules.append(Derived(Atom(now[predicate], variables), parameters, Atom(name, variables)))
    changed: dict[str, Stream] = {}
    for stream in made:
        certified = [atom for atom in stream.certified if atom.predicate in resting]
        if not certified and not any(atom.predicate in changing for atom in stream.domain):
            continue
        terms = (*stream.inputs, *stream.outputs)
        result = Atom(names.new(f"{stream.name}-result", tuple(Parameter(term) for term in terms)), terms)
        waits = [
            Atom(was.get(atom.predicate) or now.get(atom.predicate) or atom.predicate, atom.terms)
            for atom in stream.domain
            if atom.predicate in changing or atom.predicate in resting
        ]
        rules += [_rule(Atom(now[atom.predicate], atom.terms), terms, (result, *waits)) for atom in certified]
        static = tuple(atom for atom in stream.domain if atom.predicate not in changing)
        changed[stream.name] = replace(stream, domain=static, certified=(*stream.certified, result))
    started = {(was[fact[0]], *fact[1:]) for fact in facts if fact[0] in was}
    started |= {(given[fact[0]], *fact[1:]) for fact in facts if fact[0] in given}
    return Waiting(
        replace(
            domain,
            predicates={**domain.predicates, **names.made},
            actions=tuple(_noting(action, was, now) for action in domain.actions),
            derived=tuple(rules),
        ),
        replace(
            streams,
            streams=tuple(changed.get(stream.name, stream) for stream in streams.streams),
            rules=tuple(changed.get(stream.name, stream) for stream in streams.rules),
        ),
        _renamed(goal, now),
        facts | started,
    )


class _Names:
    """New predicates, none of which is called as another one."""

    def __init__(self, domain: Domain) -> None:
        self._domain = domain
        self.made: dict[str, Predicate] = {}

    def new(self, name: str, parameters: tuple[Parameter, ...]) -> str:
        while name in self._domain.predicates or name in self.made:
            name += "~"
        self.made[name] = Predicate(name, parameters)
        return name


def _resting(streams: Sequence[Stream], changing: Collection[str]) -> list[str]:
    """What streams certify whose domain changes, or rests on such a stream."""
    found: dict[str, None] = {}
    before = -1
    while len(found) > before:
        before = len(found)
        for stream in streams:
            if any(atom.predicate in changing or atom.predicate in found for atom in stream.domain):
                found.update(dict.fromkeys(atom.predicate for atom in stream.certified))
    return list(found)


def _rule(head: Atom, variables: Sequence[str], body: Sequence[Atom]) -> Derived:
    """The head holds when there are such variables; it may have constants, and a variable twice."""
    fresh = tuple(f"?x{i}" for i in range(len(head.terms)))
    plain = len(set(head.terms)) == len(head.terms) and set(head.terms) <= set(variables)
    terms = head.terms if plain else fresh
    equal = () if plain else tuple(Atom("=", pair) for pair in zip(fresh, head.terms, strict=True))
    rest = tuple(Parameter(variable) for variable in variables if variable not in terms)
    conditions = And((*body, *equal))
    return Derived(
        replace(head, terms=terms),
        tuple(Parameter(term) for term in terms),
        Exists(rest, conditions) if rest else conditions,
    )


def _noting(action: Action, was: Mapping[str, str], now: Mapping[str, str]) -> Action:
    """The action over the rules; what it makes true is noted as having been true."""
    effects = [replace(effect, condition=_renamed(effect.condition, now)) for effect in action.effects]
    noted = [_noted(effect, was) for effect in effects if effect.adds and effect.atom.predicate in was]
    return replace(action, precondition=_renamed(action.precondition, now), effects=(*effects, *noted))


def _noted(effect: Effect, was: Mapping[str, str]) -> Effect:
    return replace(effect, atom=replace(effect.atom, predicate=was[effect.atom.predicate]))


def _renamed(formula: Formula, names: Mapping[str, str]) -> Formula:
    match formula:
        case Atom(predicate):
            return replace(formula, predicate=names.get(predicate, predicate))
        case Not(body):
            return Not(_renamed(body, names))
        case And(parts) | Or(parts):
            return type(formula)(tuple(_renamed(part, names) for part in parts))
        case Exists(parameters, body) | Forall(parameters, body):
            return type(formula)(parameters, _renamed(body, names))
