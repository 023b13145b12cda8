"""The streams and cost functions that a file declares, tied to the functions that compute them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from functools import partial
from typing import Any

from tamp.errors import InputError
from tamp.geometric.context import Context
from tamp.geometric.streams.registry import STREAMS
from tamp.planner.missing_function import without_function
from tamp.stream import StreamKind
from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.algorithms.costs import BoundFunction
from tamp.symbolic.pddl.parser import output_types
from tamp.symbolic.pddl.relations import SAMPLE_PREFIX
from tamp.symbolic.pddl.structs import Domain, Stream, StreamFile


def bind(
    declared: StreamFile,
    domain: Domain,
    context: Context,
    functions: Mapping[str, Callable[..., Any]],
    unasked: Collection[str] = (),
) -> tuple[BoundStream, ...]:
    """Tie the streams to their functions.

    Args:
        declared: The streams.
        domain: Whose types the streams' outputs have.
        context: What the functions are called with first.
        functions: By the stream's name, over the shipped ones.
        unasked: Streams that may lack one, and are left out then.

    Raises:
        InputError: Another stream without a function, or a :predicate.
    """
    available = {**{name: one.function for name, one in STREAMS.items()}, **functions}

    bound: list[BoundStream] = []
    for stream in declared.streams:
        if stream.name not in available and stream.name in unasked:
            continue
        if stream.name not in available:
            raise without_function(stream, declared.file, available)
        types = output_types(stream, domain)
        outputs = tuple(types[name] for name in stream.outputs)
        function = partial(available[stream.name], context)
        advises = stream.name.startswith(SAMPLE_PREFIX)
        bound.append(BoundStream(stream, function, outputs, advises, _kind(stream)))

    _refuse_decided(declared)
    return (*bound, *(BoundStream(rule, _always, ()) for rule in declared.rules))


def bind_costs(
    declared: StreamFile, context: Context, functions: Mapping[str, Callable[..., Any]]
) -> tuple[BoundFunction, ...]:
    """Tie those of the declared cost functions that are given to what computes them."""
    return tuple(
        BoundFunction(function, partial(functions[function.name], context))
        for function in declared.functions
        if function.name in functions
    )


def unused_functions(declared: StreamFile, functions: Mapping[str, Any]) -> list[str]:
    """Warn of given functions whose name no stream and no cost function has."""
    names = [one.name for one in (*declared.streams, *declared.functions)]
    return [
        f"no stream is named '{name}': that function is not used"
        for name in functions
        if name not in names
    ]


def _kind(stream: Stream) -> StreamKind:
    """Return the kind of a shipped stream, and of another one by what it declares."""
    if stream.name in STREAMS:
        return STREAMS[stream.name].kind
    if not stream.outputs:
        return StreamKind.TESTS
    if stream.name.startswith(SAMPLE_PREFIX):
        return StreamKind.PLACEMENTS
    return StreamKind.MOTION if stream.fluents else StreamKind.OTHER


def _always(*inputs: Any, call: Any) -> bool:
    return True


def _refuse_decided(declared: StreamFile) -> None:
    for predicate in declared.predicates:
        place = predicate.place
        raise InputError(
            f"'{predicate.name}' is a :predicate, which scenes do not have",
            file=declared.file,
            line=place.line if place else None,
            column=place.column if place else None,
            remedy="A stream without outputs tests a relation; "
            "tamp.pddlstream takes :predicate too",
        )
