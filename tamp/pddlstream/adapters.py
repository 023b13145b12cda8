"""Functions of a stream map: what they return, turned into one try after the other."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from tamp.stream import Call, Rejection, Wild
from tamp.symbolic.pddl.structs import Stream

NOTHING = Rejection("gave nothing")


@dataclass(frozen=True)
class WildOutput:
    """Outputs of a stream, a list of tuples, and further facts that it found to be true: ("Near",
    q1, q2).
    """

    values: Sequence[tuple[Any, ...]] = ()
    facts: Sequence[tuple[Any, ...]] = ()


@dataclass(frozen=True)
class Adapted:
    """A function whose kind was said: each of its calls makes an iterator over lists of output
    tuples.
    """

    lists: Callable[..., Iterator[Any]]


def from_list_gen_fn(function: Callable[..., Iterable[Any]]) -> Adapted:
    """Adapt a generator of lists of output tuples; an empty list is a failed try."""
    return Adapted(lambda *args, **fluents: iter(function(*args, **fluents)))


def from_gen_fn(function: Callable[..., Iterable[Any]]) -> Adapted:
    """Adapt a generator of output tuples; None is a failed try."""
    return Adapted(lambda *args, **fluents: map(_list, function(*args, **fluents)))


def from_list_fn(function: Callable[..., Any]) -> Adapted:
    """Adapt a function that returns the list of all output tuples."""
    return Adapted(lambda *args, **fluents: iter([function(*args, **fluents)]))


def from_fn(function: Callable[..., Any]) -> Adapted:
    """Adapt a function that returns one output tuple, or None."""
    return Adapted(lambda *args, **fluents: iter([_list(function(*args, **fluents))]))


def from_test(test: Callable[..., Any]) -> Adapted:
    """Adapt a function that says whether something holds."""
    return Adapted(lambda *args, **fluents: iter([[()] if test(*args, **fluents) else []]))


def from_gen(generator: Iterable[Any]) -> Adapted:
    """Adapt a sequence of output tuples, the same for all inputs."""
    return Adapted(lambda *args, **fluents: map(_list, generator))


def from_constant(outputs: tuple[Any, ...]) -> Adapted:
    """Adapt one output tuple, the same for all inputs."""
    return from_fn(lambda *args, **fluents: outputs)


def from_sampler(sampler: Callable[..., Any], max_attempts: float = float("inf")) -> Adapted:
    """Adapt a function that is called again and again, each time for one output tuple or None."""

    def tries(*args: Any, **fluents: Any) -> Iterator[Any]:
        attempts = 0
        while attempts < max_attempts:
            attempts += 1
            yield _list(sampler(*args, **fluents))

    return Adapted(tries)


def empty_gen() -> Adapted:
    """Give nothing, ever."""
    return Adapted(lambda *args, **fluents: iter(()))


def stream_function(stream: Stream, function: Any) -> Callable[..., Any]:
    """Build what the algorithms call for a stream: one yield a try, a bool for a test.

    Args:
        stream: Its declaration; with `:fluents` the function is given the state's facts as
            `fluents`.
        function: From one of the adapters; or any function, then what it returns says what it is:
            an iterator's items and a returned list are lists of output tuples or one tuple, a tuple
            is one output, a bool a test's answer.
    """

    def tries(*inputs: Any, call: Call) -> Iterator[Any]:
        keywords = {"fluents": list(call.fluents)} if stream.fluents else {}
        if isinstance(function, Adapted):
            items = function.lists(*inputs, **keywords)
        else:
            items = _items(function(*inputs, **keywords))
        for item in items:
            yield from _tries(stream, item)

    def test(*inputs: Any, call: Call) -> Any:
        facts: list[tuple[Any, ...]] = []
        for one in tries(*inputs, call=call):
            wild = one if isinstance(one, Wild) else Wild(one, ())
            facts += wild.facts
            if not isinstance(wild.value, Rejection):
                return Wild(True, facts) if facts else True
        return Wild(Rejection("does not hold"), facts) if facts else False

    return tries if stream.outputs else test


def _list(outputs: Any) -> Any:
    return outputs if isinstance(outputs, WildOutput) else [] if outputs is None else [outputs]


def _items(result: Any) -> Iterator[Any]:
    """Return the tries of a function whose kind was not said."""
    if type(result).__name__ in ("bool", "bool_"):  # numpy's too
        return iter([[()] if result else []])
    if isinstance(result, Iterator):
        return (item if isinstance(item, list | WildOutput) else _list(item) for item in result)
    if isinstance(result, list | WildOutput):
        return iter([result])
    return iter([_list(result)])


def _tries(stream: Stream, item: Any) -> Iterator[Any]:
    """Generate one list of output tuples as one try each; facts besides go with the first."""
    facts: Sequence[tuple[Any, ...]] = ()
    if isinstance(item, WildOutput):
        item, facts = item.values, item.facts
    tuples = list(item)
    values = [_one(stream, outputs) for outputs in tuples] or [NOTHING]
    for value in values:
        yield Wild(value, facts) if facts else value
        facts = ()


def _one(stream: Stream, outputs: Any) -> Any:
    if isinstance(outputs, Rejection):
        return outputs
    values = tuple(outputs)
    if len(values) != len(stream.outputs):
        raise ValueError(f"{len(values)} outputs for {len(stream.outputs)}: {outputs!r}")
    return values[0] if len(values) == 1 else values
