"""Stream calls: what is drawn, named, certified, counted and warned of; equal values, wild facts."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from tamp.stream import Call, Rejection, Wild
from tamp.symbolic.algorithms.bound_stream import (
    MOST_WARNINGS,
    BoundStream,
    Objects,
    Streams,
    substitute,
    value_key,
)
from tamp.symbolic.pddl.structs import Atom, Stream
from tamp.system.deadline import Deadline, OutOfTime

POSE = Stream("sample", ("?o",), (), ("?p1",), (Atom("pose", ("?o", "?p1")),), ())
PAIR = Stream("pair", ("?o",), (), ("?p", "?q"), (Atom("pair", ("?p", "?q")),), ())
TEST = Stream("test", ("?o",), (), (), (Atom("fine", ("?o",)),), ())
LOOK = Stream("look", ("?o",), (), (), (Atom("seen", ("?o",)),), ("at",))


def run(by_value: bool = False, **functions: Callable[..., Any]) -> Streams:
    """The streams above with these functions, over the objects a and b."""
    bound = {
        one.name: BoundStream(one, functions[one.name], (("pose",),) * len(one.outputs))
        for one in (POSE, PAIR, TEST, LOOK)
        if one.name in functions
    }
    objects = Objects({"a": ("body",), "b": ("body",)}, {"a": "A", "b": "B"}, by_value)
    return Streams(bound, objects, lambda key: key, Deadline(math.inf))


def three(body: str, call: Call) -> Iterator[Any]:
    yield 1.5
    yield Rejection("too near")
    yield 2.5


# ---------------------------------------------------------------- drawing


def test_values_are_drawn_one_a_try_named_and_certified() -> None:
    streams = run(sample=three)
    instance = streams.instance("sample", ("a",))
    assert streams.draw(instance) == ("p1",)
    assert streams.draw(instance) is None and instance.last == Rejection("too near")
    assert not instance.exhausted
    assert streams.draw(instance) == ("p2",)
    assert streams.draw(instance) is None and instance.exhausted
    assert instance.results == [("p1",), ("p2",)]
    assert [streams.objects.values[name] for name in ("p1", "p2")] == [1.5, 2.5]
    assert streams.objects.types["p2"] == ("pose",)
    assert streams.certain == {("pose", "a", "p1"), ("pose", "a", "p2")}


def test_what_has_ended_is_not_called_again() -> None:
    calls: list[str] = []

    def none(body: str, call: Call) -> Iterator[Any]:
        calls.append(body)
        yield from ()

    streams = run(sample=none)
    instance = streams.instance("sample", ("a",))
    assert streams.draw(instance) is None
    assert instance.last == Rejection("has no value")
    assert streams.draw(instance) is None
    assert calls == ["A"]


def test_the_reason_of_the_last_try_stays_when_nothing_more_comes() -> None:
    streams = run(sample=lambda body, call: iter([Rejection("too far")]))
    instance = streams.instance("sample", ("a",))
    streams.draw(instance)
    streams.draw(instance)
    assert instance.exhausted and instance.last == Rejection("too far")


def test_an_instance_is_the_same_for_the_same_inputs_and_fluents() -> None:
    streams = run(look=lambda body, call: True)
    here, there = frozenset({("at", "a")}), frozenset({("at", "b")})
    assert streams.instance("look", ("a",), here) is streams.instance("look", ("a",), here)
    other = streams.instance("look", ("a",), there)
    assert streams.instances("look", ("a",)) == [streams.instance("look", ("a",), here), other]
    assert streams.instances("look", ("b",)) == []


def test_the_generator_of_an_instance_is_named_after_it_alone() -> None:
    """Whatever was drawn elsewhere before, an instance draws the same."""
    keys: list[Any] = []

    def noted(body: str, call: Call) -> Iterator[Any]:
        keys.append(call.rng)
        yield 1

    first, second = run(sample=noted), run(sample=noted)
    first.draw(first.instance("sample", ("a",)))
    first.draw(first.instance("sample", ("b",)))
    second.draw(second.instance("sample", ("b",)))
    assert keys[1] == keys[2] != keys[0]


def test_a_function_is_shown_values_and_the_state_sorted() -> None:
    shown: list[Any] = []

    def look(body: str, call: Call) -> bool:
        shown.append((body, list(call.fluents)))
        return True

    streams = run(look=look)
    state = frozenset(("at", name) for name in "hgfedcba")
    streams.draw(streams.instance("look", ("b",), state))
    assert shown == [("B", [("at", name) for name in "ABcdefgh"])]


# ---------------------------------------------------------------- tests, several outputs


@pytest.mark.parametrize(
    ("answer", "names", "reason"),
    [
        (True, (), None),
        (False, None, "does not hold"),
        (Rejection("hits b"), None, "hits b"),
        (0, None, "does not hold"),
    ],
)
def test_a_test_is_asked_once(answer: Any, names: Any, reason: str | None) -> None:
    asked: list[str] = []

    def test(body: str, call: Call) -> Any:
        asked.append(body)
        return answer

    streams = run(test=test)
    instance = streams.instance("test", ("a",))
    assert streams.draw(instance) == names
    assert instance.exhausted
    assert streams.certain == ({("fine", "a")} if names is not None else set())
    assert (instance.last and instance.last.reason) == reason
    assert streams.false_tests() == ([] if names is not None else [instance])
    assert streams.draw(instance) is None and asked == ["A"]


def test_what_a_state_shows_is_certain_in_no_other() -> None:
    streams = run(look=lambda body, call: body == "A")
    for name in "ab":
        streams.draw(streams.instance("look", (name,), frozenset({("at", name)})))
    assert streams.certain == set()
    assert streams.false_tests() == []  # it may hold in another state
    assert [one.inputs for one in streams.called()] == [("a",), ("b",)]


def test_several_outputs_come_as_a_tuple_of_as_many() -> None:
    streams = run(pair=lambda body, call: iter([(1, 2), (3,), (4, 5)]))
    instance = streams.instance("pair", ("a",))
    assert streams.draw(instance) == ("p1", "q1")
    assert streams.draw(instance) is None
    assert instance.exhausted and instance.last is not None and instance.last.given_up
    assert streams.warnings == [
        "stream pair raised ValueError: stream pair yields 1 values for 2 outputs; "
        "that call is given up"
    ]


# ---------------------------------------------------------------- faults, counts, warnings


def test_a_function_that_raises_ends_its_call_and_no_more() -> None:
    def broken(body: str, call: Call) -> Iterator[Any]:
        yield 1
        raise KeyError("x")

    streams = run(sample=broken)
    instance = streams.instance("sample", ("a",))
    assert streams.draw(instance) == ("p1",)
    assert streams.draw(instance) is None
    assert instance.exhausted and instance.results == [("p1",)]
    assert "raised KeyError" in streams.warnings[0]
    assert streams.draw(streams.instance("sample", ("b",))) == ("p2",)


def test_the_end_of_time_is_no_fault_of_the_streams() -> None:
    def slow(body: str, call: Call) -> Iterator[Any]:
        raise OutOfTime
        yield

    streams = run(sample=slow)
    with pytest.raises(OutOfTime):
        streams.draw(streams.instance("sample", ("a",)))
    assert streams.warnings == [] and streams.statistics["sample"].calls == 0


def test_tries_are_counted_with_their_reasons_and_time() -> None:
    streams = run(sample=three)
    instance = streams.instance("sample", ("a",))
    while not instance.exhausted:
        streams.draw(instance)
    counted = streams.statistics["sample"]
    assert (counted.calls, counted.successes) == (4, 2)
    assert counted.reasons == {"too near": 2}  # the last try ends it, for the same reason
    assert counted.seconds > 0.0


def test_warnings_are_told_once_and_not_without_end() -> None:
    def loud(body: str, call: Call) -> bool:
        call.warn(f"about {body}")
        return True

    streams = run(test=loud)
    streams.draw(streams.instance("test", ("a",)))
    streams.warn("about A")
    assert streams.warnings == ["about A"]
    for number in range(2 * MOST_WARNINGS):
        streams.warn(str(number))
    assert len(streams.warnings) == MOST_WARNINGS


def test_another_part_of_the_run_goes_on_with_what_was_learned() -> None:
    def learned(body: str, call: Call) -> bool:
        call.memory["count"] = call.memory.get("count", 0) + 1
        return True

    first, second = run(test=learned), run(test=learned)
    first.draw(first.instance("test", ("a",)))
    first.warn("odd")
    second.remember(first)
    second.draw(second.instance("test", ("b",)))
    assert second.memory == {"count": 2}
    assert second.warnings is first.warnings


# ---------------------------------------------------------------- wild facts, equal values


def test_wild_facts_name_the_values_that_they_bring() -> None:
    def wild(body: str, call: Call) -> Iterator[Any]:
        yield Wild(7.0, [("Near", "A", 8.0)])

    streams = run(by_value=True, sample=wild)
    assert streams.draw(streams.instance("sample", ("a",))) == ("p1",)
    (fact,) = streams.wild
    assert fact[:2] == ("near", "a")  # A is a's value, so it has a name
    assert streams.objects.values[fact[2]] == 8.0


def test_equal_values_have_one_name_where_that_is_wanted() -> None:
    for by_value, names in ((True, ["p1", "p1"]), (False, ["p1", "p2"])):
        streams = run(by_value, sample=lambda body, call: iter([1, 1.0]))
        instance = streams.instance("sample", ("a",))
        assert [streams.draw(instance), streams.draw(instance)] == [(name,) for name in names]


def test_a_name_that_is_taken_is_left_out() -> None:
    objects = Objects({"p1": ("pose",)}, {"p1": None})
    assert objects.add(1, ("pose",), "p") == "p2"
    assert objects.add(2, ("pose",), "q") == "q1"


@pytest.mark.parametrize(
    ("one", "other", "equal"),
    [(1, 1.0, True), (True, 1, False), ("a", "a", True), ((1,), (1.0,), True), ("1", 1, False)],
)
def test_which_values_are_equal(one: Any, other: Any, equal: bool) -> None:
    assert (value_key(one) == value_key(other)) is equal


def test_values_without_a_hash_go_by_identity() -> None:
    one: list[int] = [1]
    assert value_key(one) == value_key(one) != value_key([1])


def test_constants_stay_in_a_substitution() -> None:
    atoms = (Atom("on", ("?o", "table")), Atom("free", ()))
    assert substitute(atoms, ("?o",), ("cup",)) == (("on", "cup", "table"), ("free",))
