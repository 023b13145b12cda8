"""Streams that certify what actions change: what they find holds at the start, and until an action
ends it.

PDDLStream puts such facts into the initial state. Here the stream certifies `P-start`, which never
changes, and a condition reads `P-now`: an action made it true, or a stream found it and no action
has ended it since (`P-gone`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from tamp.symbolic.pddl.complement import atoms_of_conditions
from tamp.symbolic.pddl.exogenous import renamed
from tamp.symbolic.pddl.nodes import error
from tamp.symbolic.pddl.structs import (
    Action,
    And,
    Atom,
    Derived,
    Domain,
    Formula,
    Not,
    Place,
    Predicate,
    Stream,
    StreamFile,
)


@dataclass(frozen=True)
class Started:
    """A task whose streams certify nothing that actions change.

    Attributes:
        domain: With rules for what a stream may find at the start.
        streams: Over the predicates of what is found.
        goal: Over the rules.
        names: Each new predicate of what is found to the one that it was written as.
    """

    domain: Domain
    streams: StreamFile
    goal: Formula
    names: Mapping[str, str] = field(default_factory=dict[str, str])


def without_started(domain: Domain, streams: StreamFile, goal: Formula) -> Started:
    """Move what streams certify and actions change into rules; nothing is changed where there is
    none.

    Raises:
        InputError: It has to be false somewhere though a test decides it, another stream waits for
            it while actions make it true as well, or a stream is shown it through :fluents.
    """
    made = [*streams.streams, *streams.rules]
    changing = domain.fluent_predicates
    found = tuple(
        dict.fromkeys(a.predicate for s in made for a in s.certified if a.predicate in changing)
    )
    if not found:
        return Started(domain, streams, goal)

    _check(domain, made, goal, found)
    start, gone, now = (
        {one: _new(f"{one}-{word}", domain) for one in found} for word in ("start", "gone", "now")
    )
    predicates = dict(domain.predicates)
    for one in found:
        for names in (start, gone, now):
            predicates[names[one]] = replace(domain.predicates[one], name=names[one], place=None)

    rules = [replace(rule, body=renamed(rule.body, now)) for rule in domain.derived]
    for one in found:
        rules += _rules(domain.predicates[one], start[one], gone[one], now[one])
    actions = tuple(_action(action, gone, now) for action in domain.actions)

    def changed(listed: Sequence[Stream]) -> tuple[Stream, ...]:
        return tuple(
            replace(
                stream,
                domain=_renamed(stream.domain, start),
                certified=_renamed(stream.certified, start),
            )
            for stream in listed
        )

    return Started(
        replace(domain, predicates=predicates, actions=actions, derived=tuple(rules)),
        replace(streams, streams=changed(streams.streams), rules=changed(streams.rules)),
        renamed(goal, now),
        {new: one for one, new in start.items()},
    )


def _check(domain: Domain, made: Sequence[Stream], goal: Formula, found: Sequence[str]) -> None:
    added = {
        effect.atom.predicate
        for action in domain.actions
        for effect in action.effects
        if effect.adds
    }
    nowhere = Place(None, 1, 1)

    for stream in made:
        for atom in stream.domain:
            if atom.predicate in found and atom.predicate in added:
                waits = f"stream '{stream.name}' waits for '{atom.predicate}'"
                what = f"{waits}, which another stream certifies"
                remedy = "What actions make true and a stream waits for cannot be certified as well"
                raise error(atom.place or stream.place or nowhere, what, remedy=remedy)
        for name in stream.fluents:
            if name in found:
                shown = f"stream '{stream.name}' is shown '{name}' through :fluents"
                what = f"{shown}, which another stream certifies"
                raise error(
                    stream.place or nowhere, what, remedy="Give what is certified another name"
                )

    tested = {a.predicate for s in made for a in s.certified if not set(a.terms) & set(s.outputs)}

    for atom, sign in atoms_of_conditions(domain, goal):
        if not sign and atom.predicate in found and atom.predicate in tested:
            what = (
                f"'{atom.predicate}' has to be false here, "
                "and a test that may still pass makes it true at the start"
            )
            raise error(
                atom.place or nowhere,
                what,
                remedy="Certify another predicate, which no action changes",
            )


def _action(action: Action, gone: Mapping[str, str], now: Mapping[str, str]) -> Action:
    """Rewrite the action over the rules; what it makes false is noted as gone, what it makes
    true as not gone.
    """
    effects = [
        replace(effect, condition=renamed(effect.condition, now)) for effect in action.effects
    ]
    noted = [
        replace(
            effect,
            atom=replace(effect.atom, predicate=gone[effect.atom.predicate]),
            adds=not effect.adds,
        )
        for effect in effects
        if effect.atom.predicate in gone
    ]
    return replace(
        action, precondition=renamed(action.precondition, now), effects=(*effects, *noted)
    )


def _rules(predicate: Predicate, start: str, gone: str, now: str) -> tuple[Derived, Derived]:
    terms = tuple(parameter.name for parameter in predicate.parameters)
    head = Atom(now, terms)
    kept = And((Atom(start, terms), Not(Atom(gone, terms))))
    return (
        Derived(head, predicate.parameters, Atom(predicate.name, terms)),
        Derived(head, predicate.parameters, kept),
    )


def _renamed(atoms: Sequence[Atom], names: Mapping[str, str]) -> tuple[Atom, ...]:
    return tuple(
        replace(atom, predicate=names.get(atom.predicate, atom.predicate)) for atom in atoms
    )


def _new(name: str, domain: Domain) -> str:
    while name in domain.predicates:
        name += "~"
    return name
