"""Functions of a stream map, of whatever kind, are asked for one try after the other."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from tamp.pddlstream import adapters
from tamp.pddlstream.adapters import NOTHING, Adapted, WildOutput, stream_function
from tamp.stream import Call, Rejection, Wild
from tamp.symbolic.pddl.structs import Stream
from tamp.system.deadline import Deadline


def stream(outputs: tuple[str, ...] = ("?b",), fluents: tuple[str, ...] = ()) -> Stream:
    return Stream("s", ("?a",), (), outputs, (), fluents)


def call(*fluents: tuple[Any, ...]) -> Call:
    return Call(np.random.default_rng(0), Deadline(math.inf), fluents)


def tries(function: Any, declared: Stream | None = None, most: int = 6) -> list[Any]:
    asked = stream_function(declared or stream(), function)(1, call=call())
    return list(itertools.islice(asked, most))


@pytest.mark.parametrize(
    ("adapt", "function", "found"),
    [
        (adapters.from_list_gen_fn, lambda a: iter([[(a,), (2,)], [], [(3,)]]), [1, 2, NOTHING, 3]),
        (adapters.from_gen_fn, lambda a: iter([(a,), None, (3,)]), [1, NOTHING, 3]),
        (adapters.from_list_fn, lambda a: [(a,), (2,)], [1, 2]),
        (adapters.from_list_fn, lambda a: [], [NOTHING]),
        (adapters.from_fn, lambda a: (a,), [1]),
        (adapters.from_fn, lambda a: None, [NOTHING]),
        (adapters.from_sampler, lambda a: (a,), [1] * 6),  # as often as it is asked
        (adapters.from_gen, [(7,), (8,)], [7, 8]),
        (adapters.from_constant, (9,), [9]),
    ],
)
def test_adapters(adapt: Callable[[Any], Adapted], function: Any, found: list[Any]) -> None:
    assert tries(adapt(function)) == found


def test_a_sampler_may_be_limited_and_a_generator_empty() -> None:
    assert tries(adapters.from_sampler(lambda a: None, max_attempts=2)) == [NOTHING, NOTHING]
    assert tries(adapters.empty_gen()) == []


@pytest.mark.parametrize(
    ("function", "found"),
    [
        (lambda a: (a,), [1]),
        (lambda a: None, [NOTHING]),
        (lambda a: [(a,), (2,)], [1, 2]),
        (lambda a: iter([(a,), [(2,), (3,)], None]), [1, 2, 3, NOTHING]),
        (lambda a: ((i,) for i in range(a)), [0]),
    ],
)
def test_without_an_adapter_the_result_says_what_it_is(function: Any, found: list[Any]) -> None:
    assert tries(function) == found


def test_several_outputs_are_a_tuple_and_their_number_is_checked() -> None:
    two = stream(("?b", "?c"))
    assert tries(lambda a: (a, 2), two) == [(1, 2)]
    with pytest.raises(ValueError, match=r"1 outputs for 2: .1,."):
        tries(lambda a: (a,), two)


def test_facts_besides_go_with_the_first_of_their_list() -> None:
    near = ("Near", 1, 2)
    first, second = tries(adapters.from_list_fn(lambda a: WildOutput([(1,), (2,)], [near])))
    assert isinstance(first, Wild) and (first.value, list(first.facts)) == (1, [near])
    assert second == 2
    (alone,) = tries(lambda a: WildOutput((), [near]))
    assert isinstance(alone, Wild) and alone.value is NOTHING


def test_a_rejection_passes_as_it_is() -> None:
    no = Rejection("too far")
    assert tries(lambda a: iter([[no, (5,)]])) == [no, 5]


@pytest.mark.parametrize(
    ("function", "answer"),
    [
        (lambda a: a == 1, True),
        (lambda a: a == 2, False),
        (lambda a: np.bool_(True), True),
        (lambda a: np.bool_(False), False),
        (adapters.from_test(lambda a: a), True),
        (adapters.from_test(lambda a: 0), False),
        (lambda a: iter([None, None, ()]), True),
        (lambda a: [()], True),
        (lambda a: [], False),
    ],
)
def test_a_stream_without_outputs_is_a_test(function: Any, answer: bool) -> None:
    assert stream_function(stream(()), function)(1, call=call()) is answer


def test_a_test_may_find_facts_whether_it_passes_or_not() -> None:
    passed = stream_function(stream(()), lambda a: WildOutput([()], [("Near", 1)]))(1, call=call())
    assert isinstance(passed, Wild) and passed.value is True and list(passed.facts) == [("Near", 1)]
    failed = stream_function(stream(()), lambda a: WildOutput((), [("Near", 1)]))(1, call=call())
    assert isinstance(failed, Wild) and isinstance(failed.value, Rejection)


def test_fluents_are_given_where_the_stream_declares_them() -> None:
    function = stream_function(stream(fluents=("at",)), lambda a, fluents: (len(fluents),))
    assert list(function(1, call=call(("at", "mug", 1)))) == [1]
