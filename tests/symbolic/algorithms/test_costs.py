"""Costs that Python computes: given ones first, each asked once, placeholders by the mean so far."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from tamp.errors import InputError
from tamp.symbolic.algorithms.bound_stream import Objects
from tamp.symbolic.algorithms.costs import COST_BEFORE_ASKED, BoundFunction, Costs
from tamp.symbolic.pddl.structs import Action, And, Atom, Fact, Function, Parameter

OBJECTS = Objects({"a": ("object",), "b": ("object",)}, {"a": 1.0, "b": 5.0})


def costs(function: Callable[..., Any], given: dict[Fact, float] | None = None) -> Costs:
    declared = Function("distance", ("?x", "?y"), ())
    return Costs((BoundFunction(declared, function),), OBJECTS, given or {})


def distance(x: float, y: float) -> float:
    return abs(x - y)


def test_a_cost_is_computed_from_values_and_asked_once() -> None:
    asked: list[tuple[float, float]] = []

    def function(x: float, y: float) -> float:
        asked.append((x, y))
        return distance(x, y)

    found = costs(function)
    assert [found["distance", "a", "b"] for _ in range(3)] == [4.0] * 3
    assert asked == [(1.0, 5.0)]
    assert found["distance", "b", "a"] == 4.0 and len(asked) == 2


def test_what_the_problem_states_comes_first() -> None:
    found = costs(distance, {("distance", "a", "b"): 9.0, ("weight", "a"): 2.0})
    assert found["distance", "a", "b"] == 9.0 and found["weight", "a"] == 2.0
    assert found["distance", "b", "a"] == 4.0
    assert (
        set(found) == {("distance", "a", "b"), ("weight", "a"), ("distance", "b", "a")}
        and len(found) == 3
    )


def test_placeholders_cost_the_mean_of_what_was_computed() -> None:
    found = costs(distance)
    assert found["distance", "a", "#q1"] == COST_BEFORE_ASKED
    assert found["distance", "a", "b"] == 4.0
    assert found["distance", "#q1", "#q2"] == 4.0
    assert found["distance", "a", "a"] == 0.0
    assert found["distance", "#q1", "b"] == 2.0
    assert len(found) == 2, "no placeholder is kept"


@pytest.mark.parametrize(
    ("fact", "there"),
    [
        (("distance", "a", "b"), True),
        (("weight", "a"), False),
        ((), False),
        (None, False),
        (3, False),
    ],
)
def test_what_has_a_cost(fact: object, there: bool) -> None:
    assert (fact in costs(distance)) == there


def test_an_unknown_function_is_a_key_error() -> None:
    with pytest.raises(KeyError):
        costs(distance)["weight", "a"]


@pytest.mark.parametrize("value", [-1.0, float("nan"), float("inf"), "far", None, [1.0]])
def test_a_cost_is_a_number_zero_or_more(value: object) -> None:
    with pytest.raises(InputError, match="function 'distance' gave"):
        costs(lambda x, y: value)["distance", "a", "b"]


@pytest.mark.parametrize("value", [0, 0.0, True, "2.5"])
def test_whatever_float_takes_is_a_number(value: Any) -> None:
    assert costs(lambda x, y: value)["distance", "a", "b"] == float(value)


def test_the_cost_of_an_action_with_objects() -> None:
    parameters = (Parameter("?from", ("object",)), Parameter("?to", ("object",)))
    move = Action("move", parameters, And(()), (), Atom("distance", ("?to", "?from")))
    assert costs(lambda x, y: x - y)["distance", "b", "a"] == 4.0
    assert costs(lambda x, y: x - y).of(move, ("a", "b")) == 4.0
    home = Action("home", parameters[:1], And(()), (), Atom("distance", ("?from", "b")))
    assert costs(distance).of(home, ("a",)) == 4.0
    assert costs(distance).of(Action("wait", (), And(()), (), 2), ()) == 2.0
