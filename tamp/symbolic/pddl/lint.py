"""Lint of a domain, its streams and a goal: what is no error, but probably not what was meant."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from tamp.symbolic.pddl.atoms import atoms, signed_atoms
from tamp.symbolic.pddl.nodes import warning
from tamp.symbolic.pddl.structs import Atom, Domain, Fact, Formula, Place, StreamFile


def lint(
    domain: Domain,
    streams: StreamFile | None = None,
    goal: Formula | None = None,
    initial: Collection[Fact] = (),
) -> tuple[str, ...]:
    """Collect warnings, each with file, line and column, in the order of their places after the
    parser's own.

    Args:
        domain: Parsed.
        streams: Its streams, if it has any.
        goal: The problem's; without it nothing is said about achievers and streams: a goal may
            ask for anything.
        initial: The facts of the problem's initial state.
    """
    found: list[tuple[Place, str]] = []
    asked = {atom.predicate for atom in _conditions(domain)} | {
        atom.predicate for atom in (atoms(goal) if goal is not None else ())
    }
    found += _unused_predicates(domain, streams, asked)
    if streams is not None:
        found += _unused_streams(domain, streams, asked, goal is not None)
        found += _uncertified(streams)
        found += _unused_functions(domain, streams)
    if goal is not None:
        found += _unachievable(domain, streams, goal, initial)
    found.sort(key=lambda row: (row[0].file or "", row[0].line, row[0].column, row[1]))
    return tuple(
        dict.fromkeys((*domain.notes, *(warning(place, message) for place, message in found)))
    )


def _unused_predicates(
    domain: Domain, streams: StreamFile | None, asked: Collection[str]
) -> Iterator[tuple[Place, str]]:
    """Find predicates that stand nowhere but in their declaration, or that are made true and
    never asked for.
    """
    made = {effect.atom.predicate for action in domain.actions for effect in action.effects}
    made |= domain.derived_predicates
    shown: set[str] = set()
    for stream in (*streams.streams, *streams.rules) if streams else ():
        shown |= {atom.predicate for atom in (*stream.domain, *stream.certified)} | set(
            stream.fluents
        )
    for function in streams.functions if streams else ():
        shown |= {atom.predicate for atom in function.domain}
    for predicate in domain.predicates.values():
        if predicate.place is None or predicate.name in asked or predicate.name in shown:
            continue
        if predicate.name not in made:
            yield predicate.place, f"predicate '{predicate.name}' is never used"


def _unused_streams(
    domain: Domain, streams: StreamFile, asked: Collection[str], whole: bool
) -> Iterator[tuple[Place, str]]:
    """Find streams of whose facts no action, rule, goal or used stream asks for one."""
    needed = set(asked)
    if not whole:  # a goal may ask for any static predicate
        return
    needed |= {atom.predicate for function in streams.functions for atom in function.domain}
    waiting = [*streams.streams, *streams.rules]
    grows = True
    while grows:
        grows = False
        for stream in waiting[:]:
            if any(atom.predicate in needed for atom in stream.certified):
                waiting.remove(stream)
                needed |= {atom.predicate for atom in stream.domain}
                grows = True
    for stream in waiting:
        if stream.place is not None and stream not in streams.rules:
            facts = " or ".join(
                dict.fromkeys(f"({atom.predicate} ...)" for atom in stream.certified)
            )
            yield stream.place, f"stream '{stream.name}' is never used: nothing asks for {facts}"


def _unused_functions(domain: Domain, streams: StreamFile) -> Iterator[tuple[Place, str]]:
    """Find functions that no action's cost names."""
    used = {action.cost.predicate for action in domain.actions if isinstance(action.cost, Atom)}
    for function in streams.functions:
        if function.name not in used and function.place is not None:
            yield function.place, f"function '{function.name}' is the cost of no action"


def _uncertified(streams: StreamFile) -> Iterator[tuple[Place, str]]:
    for stream in streams.streams:
        certified = {term for atom in stream.certified for term in atom.terms}
        for output in stream.outputs:
            if output not in certified and stream.place is not None:
                what = f"output {output} of stream '{stream.name}' is never certified"
                yield stream.place, f"{what}: no action can use it"


def _unachievable(
    domain: Domain, streams: StreamFile | None, goal: Formula, initial: Collection[Fact]
) -> Iterator[tuple[Place, str]]:
    """Find goal atoms of predicates that nothing makes true, and that do not hold at the start
    either.
    """
    makers = {
        effect.atom.predicate
        for action in domain.actions
        for effect in action.effects
        if effect.adds
    }
    makers |= domain.derived_predicates | {"="}
    for stream in (*streams.streams, *streams.rules) if streams else ():
        makers |= {atom.predicate for atom in stream.certified}
    given = {fact[0] for fact in initial}

    for atom, sign in signed_atoms(goal):
        if (
            not sign
            or atom.predicate in makers
            or (atom.predicate in domain.types and atom.predicate not in domain.predicates)
        ):
            continue
        without_variables = not any(term.startswith("?") for term in atom.terms)
        if (
            (atom.predicate, *atom.terms) in initial
            if without_variables
            else atom.predicate in given
        ):
            continue
        if atom.place is not None:
            text = " ".join((atom.predicate, *atom.terms))
            yield (
                atom.place,
                f"goal ({text}): no action, rule or stream makes '{atom.predicate}' true",
            )


def _conditions(domain: Domain) -> Iterator[Atom]:
    for action in domain.actions:
        yield from atoms(action.precondition)
        for effect in action.effects:
            yield from atoms(effect.condition)
    for rule in domain.derived:
        yield from atoms(rule.body)
