"""PDDLStream's problem tuple, bound to a task with streams."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from tamp.errors import InputError, closest
from tamp.pddlstream.adapters import stream_function
from tamp.pddlstream.checks import check_parts
from tamp.pddlstream.facts import Names, goal_formula, initial_facts, initial_functions
from tamp.pddlstream.streams_text import facts_of, stream_functions
from tamp.stream import Rejection, Wild
from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.algorithms.costs import BoundFunction
from tamp.symbolic.algorithms.result import StreamTask
from tamp.symbolic.pddl.complement import complement_name, negated_tests, with_complements
from tamp.symbolic.pddl.exogenous import compile_away
from tamp.symbolic.pddl.files import read_pddl
from tamp.symbolic.pddl.lint import lint
from tamp.symbolic.pddl.nodes import warning
from tamp.symbolic.pddl.parser import Undeclared, output_types, parse_domain, parse_streams
from tamp.symbolic.pddl.sexpr import read
from tamp.symbolic.pddl.started import without_started
from tamp.symbolic.pddl.structs import (
    Atom,
    Domain,
    Function,
    Parameter,
    Predicate,
    Stream,
    StreamFile,
    Task,
)


class PDDLProblem(NamedTuple):
    """A problem in the parts and the order of PDDLStream's.

    Attributes:
        domain_pddl: The domain's text, or a Path to it.
        constant_map: The values of the domain's constants.
        stream_pddl: The streams' text or a Path to it, several of them, or None.
        stream_map: A function for each stream, `:function` and `:predicate`, by name in any case.
        init: Facts as tuples; ("=", ("Distance", a, b), 3.0) for costs.
        goal: A condition as nested tuples.
    """

    domain_pddl: str | Path
    constant_map: Mapping[str, Any]
    stream_pddl: str | Path | Sequence[str | Path] | None
    stream_map: Mapping[str, Any]
    init: Sequence[Any]
    goal: Any


class Bound(NamedTuple):
    """A problem as a task.

    Attributes:
        task: With its streams.
        warnings: What looks odd.
        uncalled: What only an optimizer would certify, which is never called: no plan is no proof
            then.
        names: Predicates of the task to those that the user wrote, where they differ.
    """

    task: StreamTask
    warnings: tuple[str, ...]
    uncalled: tuple[str, ...]
    names: Mapping[str, str]


def bind(problem: PDDLProblem, *, unit_costs: bool = False) -> Bound:
    """Bind the task to its streams, and collect what there is to say of it.

    Raises:
        InputError: Anything wrong with the texts, the map or the facts.
    """
    check_parts(problem)
    domain_text = _text(problem.domain_pddl)
    sources = _sources(problem.stream_pddl)
    domain, streams = _parsed(domain_text, sources, problem.init)
    functions = {str(name).lower(): function for name, function in problem.stream_map.items()}

    constants, spare = _constants(problem.constant_map, domain)
    names = Names(constants)
    facts, costs, types, unused = initial_facts(problem.init, domain, names)
    goal = goal_formula(problem.goal, domain, names)
    warnings = [*_undeclared(sources, domain), *streams.notes, *lint(domain, streams, goal, facts)]
    used = {
        "streams": [*streams.streams],
        "functions": [*streams.functions],
        "predicates": [*streams.predicates],
    }
    warnings += [
        *unused,
        *spare,
        *_check_map(functions, [one for group in used.values() for one in group]),
    ]

    started = without_started(domain, streams, goal)
    waiting = compile_away(started.domain, started.streams, started.goal, facts)
    domain, streams, goal, facts = waiting.domain, waiting.streams, waiting.goal, waiting.facts
    decided = {predicate.name: predicate for predicate in streams.predicates}
    bound = _bound_streams(streams, domain, functions)
    negated = negated_tests(streams.streams, domain, goal)
    bound += [_failing(stream, domain, functions[stream.name]) for stream in negated.values()]

    rewritten, goal = with_complements(domain, goal, decided.keys() | negated.keys())
    if unit_costs:
        actions = tuple(replace(action, cost=1.0) for action in rewritten.actions)
        rewritten = replace(rewritten, actions=actions)
    objects = {
        name: types.get(name, ("object",)) for name in names.values if name not in domain.constants
    }
    task = Task(domain.name, rewritten, objects, facts, goal, costs)
    computed = tuple(
        BoundFunction(function, functions[function.name]) for function in streams.functions
    )
    stream_task = StreamTask(task, tuple(bound), names.values, computed, by_value=True)
    return Bound(stream_task, tuple(warnings), streams.uncalled, started.names)


def _sources(listed: str | Path | Sequence[str | Path] | None) -> list[tuple[str, Path | None]]:
    """Read the texts of the streams, each with its file."""
    return [_text(one) for one in ((listed,) if isinstance(listed, str | Path) else listed or ())]


def _parsed(
    domain_text: tuple[str, Path | None],
    sources: Sequence[tuple[str, Path | None]],
    init: Sequence[Any],
) -> tuple[Domain, StreamFile]:
    """Parse the domain and its streams; what streams name need not be declared in the domain."""
    undeclared: dict[str, Predicate] = {}
    for text, file in sources:
        for name, size, _ in facts_of(read(text, file)):
            parameters = tuple(Parameter(f"?x{i}") for i in range(size))
            undeclared.setdefault(name, Predicate(name, parameters))

    valued = _used(initial_functions(init), domain_text[0])
    computed = {
        name: one for text, file in sources for name, one in stream_functions(read(text, file))
    }
    domain = parse_domain(*domain_text, Undeclared(undeclared, valued, computed))
    files = [parse_streams(text, domain, file, waiting=True) for text, file in sources]
    return domain, _joined(files)


def _bound_streams(
    streams: StreamFile, domain: Domain, functions: Mapping[str, Any]
) -> list[BoundStream]:
    """Bind streams, rules and decided predicates to the functions of the stream map."""
    bound = [_bound(stream, domain, functions[stream.name]) for stream in streams.streams]
    bound += [_bound(rule, domain, _always) for rule in streams.rules]
    for predicate in {one.name: one for one in streams.predicates}.values():
        bound += _tests(predicate, domain, functions[predicate.name])
    return bound


def _bound(stream: Stream, domain: Domain, function: Any) -> BoundStream:
    types = output_types(stream, domain)
    outputs = tuple(types[name] for name in stream.outputs)
    return BoundStream(stream, stream_function(stream, function), outputs)


def _always(*inputs: Any) -> bool:
    return True


def _tests(
    predicate: Function, domain: Domain, function: Callable[..., Any]
) -> tuple[BoundStream, BoundStream]:
    """Build the test streams that certify a decided predicate, and its complement."""

    def holds(*inputs: Any, call: Any) -> bool:
        return bool(function(*inputs))

    def does_not_hold(*inputs: Any, call: Any) -> bool | Rejection:
        return Rejection(f"{predicate.name} holds") if function(*inputs) else True

    made: list[BoundStream] = []
    for name, test in (
        (predicate.name, holds),
        (complement_name(predicate.name, domain), does_not_hold),
    ):
        certified = (Atom(name, predicate.inputs, predicate.place),)
        stream = Stream(
            f"test-{name}", predicate.inputs, predicate.domain, (), certified, (), predicate.place
        )
        made.append(BoundStream(stream, test, ()))
    return made[0], made[1]


def _failing(stream: Stream, domain: Domain, function: Any) -> BoundStream:
    """Build the stream that certifies that a test does not pass."""
    (atom,) = stream.certified
    test = stream_function(stream, function)

    def fails(*inputs: Any, call: Any) -> Any:
        answer = test(*inputs, call=call)
        passes, facts = (answer.value, answer.facts) if isinstance(answer, Wild) else (answer, ())
        opposite = Rejection(f"{atom.predicate} holds") if passes is True else True
        return Wild(opposite, facts) if facts else opposite

    name = complement_name(atom.predicate, domain)
    certified = (Atom(name, atom.terms, atom.place),)
    return BoundStream(replace(stream, name=f"test-{name}", certified=certified), fails, ())


def _joined(files: Sequence[StreamFile]) -> StreamFile:
    return StreamFile(
        files[0].name if files else "",
        tuple(one for file in files for one in file.streams),
        tuple(one for file in files for one in file.functions),
        files[0].file if files else None,
        tuple(one for file in files for one in file.predicates),
        tuple(one for file in files for one in file.rules),
        tuple(one for file in files for one in file.notes),
        tuple(one for file in files for one in file.uncalled),
    )


def _used(functions: Mapping[str, Predicate], text: str) -> dict[str, Predicate]:
    """Select those that a domain's text calls."""
    lower = text.lower()
    return {
        name: one
        for name, one in functions.items()
        if re.search(rf"\(\s*{re.escape(name)}[\s)]", lower)
    }


def _check_map(
    functions: Mapping[str, Any], declared: Sequence[Stream | Function]
) -> Iterator[str]:
    """Warn of each function that no stream is called, unless it is a misspelt one: that is an
    error.
    """
    for one in declared:
        if one.name not in functions:
            place = one.place
            raise InputError(
                f"'{one.name}' has no function in the stream map",
                file=place.file if place else None,
                line=place.line if place else None,
                column=place.column if place else None,
                found=one.name,
                choices=functions,
            )
    names = [one.name for one in declared]
    for name in functions:
        if name not in names:
            message = f"the stream map has '{name}', which no stream is called"
            if closest(name, names) is not None:
                raise InputError(message, found=name, choices=names)
            yield message


def _constants(given: Mapping[str, Any], domain: Domain) -> tuple[dict[str, Any], tuple[str, ...]]:
    """Return the domain's constants with their values, by default their names; and warnings of
    others.
    """
    lower = {name.lower(): value for name, value in given.items()}
    warnings: list[str] = []
    for name in lower:
        if name not in domain.constants:
            message = f"'{name}' is no constant of the domain"
            if closest(name, domain.constants) is not None:
                raise InputError(message, file=domain.file, found=name, choices=domain.constants)
            warnings.append(message)
    return {name: lower.get(name, name) for name in domain.constants}, tuple(warnings)


def _text(source: str | Path) -> tuple[str, Path | None]:
    return (source, None) if isinstance(source, str) else (read_pddl(source), source)


def _undeclared(sources: Sequence[tuple[str, Path | None]], domain: Domain) -> Iterator[str]:
    seen: set[str] = set()
    for text, file in sources:
        for name, _, group in facts_of(read(text, file)):
            declared = domain.predicates.get(name)
            if declared is not None and declared.place is None and name not in seen:
                seen.add(name)
                yield warning(group, f"predicate '{name}' is not among the domain's :predicates")
