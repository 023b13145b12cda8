"""What a relation of one's own leaves unsaid: its poses rest on the surface that it names."""

from __future__ import annotations

import pytest

from tamp.planner.stream_completion import saying_where_poses_rest
from tamp.symbolic.pddl.parser import parse_domain, parse_streams
from tamp.symbolic.pddl.structs import Fact

DOMAIN = """
(define (domain d) (:requirements :typing)
  (:types movable pose surface container)
  (:predicates (movable ?o) (surface ?s) (container ?s) (pose ?o ?p) (supported ?o ?p ?s)
    (contained ?o ?p ?s) (laid ?o ?p ?s)))
"""


def certified(domain: str, said: str, given: tuple[str, ...] = (), without: str = "") -> set[Fact]:
    parsed = parse_domain(DOMAIN.replace(without or "-", "" if without else "-"), None)
    text = (
        f"(define (stream d) (:stream sample-lying :inputs (?o ?s) :domain {domain}"
        f" :outputs (?p) :certified {said}))"
    )
    declared = saying_where_poses_rest(parse_streams(text, parsed, None), parsed, ["lying"], given)
    return {(atom.predicate, *atom.terms) for atom in declared.streams[0].certified}


LAID = "(and (pose ?o ?p) (laid ?o ?p ?s))"
ON = ("supported", "?o", "?p", "?s")


def test_the_surface_that_is_named_carries() -> None:
    """Else `(not (on milk table))` would hold of milk that lies on the table."""
    assert ON in certified("(and (movable ?o) (surface ?s))", LAID)


@pytest.mark.parametrize(
    ("domain", "said", "given", "without"),
    [
        ("(and (movable ?o) (container ?s))", LAID, (), ""),
        ("(and (movable ?o) (surface ?s) (container ?s))", LAID, (), ""),
        ("(and (movable ?o) (movable ?s))", LAID, (), ""),
        ("(and (movable ?o) (surface ?s))", "(and (pose ?o ?p) (contained ?o ?p ?s))", (), ""),
        ("(and (movable ?o) (surface ?s))", "(laid ?o ?p ?s)", (), ""),
        ("(and (movable ?o) (surface ?s))", LAID, ("sample-lying",), ""),
        ("(and (movable ?o) (surface ?s))", LAID, (), "(supported ?o ?p ?s)"),
    ],
)
def test_where_it_is_not_sure_nothing_is_said(
    domain: str, said: str, given: tuple[str, ...], without: str
) -> None:
    assert ON not in certified(domain, said, given, without)
