"""Streams tied to their functions: which one serves, of which kind it is, what lacks one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from tamp.errors import InputError
from tamp.planner.stream_binding import bind, bind_costs, unused_functions
from tamp.stream import StreamKind
from tamp.symbolic.pddl.parser import parse_domain, parse_streams
from tamp.symbolic.pddl.structs import Domain

DOMAIN = """
(define (domain d) (:requirements :typing :action-costs)
  (:types movable surface pose way)
  (:predicates (pose ?o - movable ?p - pose) (at ?o - movable ?p - pose) (way ?o - movable ?w - way)
    (clean ?o - movable) (near ?o - movable ?s - surface ?p - pose) (tidy ?o - movable) (long ?w - way))
  (:functions (total-cost) (length ?w - way)))
"""


@pytest.fixture
def domain() -> Domain:
    return parse_domain(DOMAIN)


def bound(
    domain: Domain, streams: str, functions: dict[str, Callable[..., Any]], **more: Any
) -> Any:
    declared = parse_streams(f"(define (stream d) {streams})", domain, "d.streams.pddl")
    return {one.name: one for one in bind(declared, domain, "context", functions, **more)}  # type: ignore[arg-type]


OWN = """
  (:stream test-clean :inputs (?o) :domain (movable ?o) :certified (clean ?o))
  (:stream is-clean :inputs (?o) :domain (movable ?o) :certified (clean ?o))
  (:stream sample-near :inputs (?o ?s) :domain (and (movable ?o) (surface ?s)) :fluents (at)
    :outputs (?p) :certified (and (pose ?o ?p) (near ?o ?s ?p)))
  (:stream find-way :inputs (?o) :domain (movable ?o) :fluents (at) :outputs (?w)
    :certified (way ?o ?w))
  (:stream draw-way :inputs (?o) :domain (movable ?o) :outputs (?w) :certified (way ?o ?w))
"""


def asked(*inputs: Any) -> Any:
    return inputs


def test_kinds_of_ones_own_streams_follow_from_what_they_declare(domain: Domain) -> None:
    names = ("test-clean", "is-clean", "sample-near", "find-way", "draw-way")
    made = bound(domain, OWN, dict.fromkeys(names, asked))
    assert {name: one.kind for name, one in made.items()} == {
        "test-clean": StreamKind.TESTS,
        "is-clean": StreamKind.TESTS,
        "sample-near": StreamKind.PLACEMENTS,
        "find-way": StreamKind.MOTION,
        "draw-way": StreamKind.OTHER,
    }
    assert {name for name, one in made.items() if one.is_advisory} == {"sample-near"}
    assert {name for name, one in made.items() if one.is_fluent} == {"find-way"}
    assert made["find-way"].function("mug") == ("context", "mug")
    assert made["find-way"].output_types == (("way",),)


def test_a_shipped_stream_keeps_its_kind_whatever_serves_it(domain: Domain) -> None:
    streams = """(:stream sample-grasp :inputs (?o) :domain (movable ?o) :outputs (?w)
      :certified (way ?o ?w))"""
    shipped, own = bound(domain, streams, {}), bound(domain, streams, {"sample-grasp": asked})
    assert shipped["sample-grasp"].kind is own["sample-grasp"].kind is StreamKind.GRASPS
    assert own["sample-grasp"].function("mug") == ("context", "mug")
    assert shipped["sample-grasp"].function.args == ("context",)


def test_a_stream_without_a_function_is_refused_unless_nothing_asks_for_it(domain: Domain) -> None:
    with pytest.raises(InputError, match="stream 'test-clean' has no function") as told:
        bound(domain, OWN, dict.fromkeys(("is-clean", "sample-near"), asked))
    assert told.value.line == 2 and "--sampler clean=FILE" in told.value.remedy
    with pytest.raises(InputError) as plain:
        bound(domain, OWN[OWN.index("(:stream find-way") :], {})
    assert "functions={'find-way': f}" in plain.value.remedy

    made = bound(
        domain, OWN, {}, unasked={"test-clean", "is-clean", "sample-near", "find-way", "draw-way"}
    )
    assert made == {}


def test_rules_always_hold_and_predicates_are_refused(domain: Domain) -> None:
    made = bound(domain, "(:rule :inputs (?o) :domain (clean ?o) :certified (tidy ?o))", {})
    (rule,) = made.values()
    assert rule.function("mug", call=None) is True and rule.is_test
    with pytest.raises(InputError, match="'tidy' is a :predicate"):
        bound(domain, "(:predicate (tidy ?o) (movable ?o))", {})


def test_costs_are_tied_where_they_are_given(domain: Domain) -> None:
    declared = parse_streams("(define (stream d) (:function (length ?w) (long ?w)))", domain, "d")
    assert bind_costs(declared, "context", {}) == ()  # type: ignore[arg-type]
    (one,) = bind_costs(declared, "context", {"length": asked})  # type: ignore[arg-type]
    assert one.function("w") == ("context", "w")
    assert unused_functions(declared, {"length": asked, "lenght": asked}) == [
        "no stream is named 'lenght': that function is not used"
    ]
