"""A domain like the cupboard's, and a way to say where an error must be."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.parser import parse_domain, parse_streams
from tamp.symbolic.pddl.structs import Domain, StreamFile

DOMAIN = """\
; carrying bodies between surfaces
(define (domain Cupboard)
  (:requirements :typing :equality :negative-preconditions :derived-predicates :action-costs)
  (:types
    movable fixed - body
    body surface container - object
    pose grasp base-conf - object)
  (:constants depot - (either body surface))
  (:predicates
    (at-pose ?o - movable ?p - pose)
    (holding ?o - movable ?g - grasp)
    (hand-empty)
    (at-base ?b - base-conf)
    (pose ?o - movable ?p - pose)
    (supported ?o - movable ?p - pose ?s - surface)
    (grasp ?o - movable ?g - grasp)
    (kin ?o - movable ?p - pose ?g - grasp ?b - base-conf)
    (clear ?o - movable ?p - pose ?o2 - movable ?p2 - pose)
    (on ?o - body ?s - surface)
    (blocked ?o - movable ?p - pose))
  (:functions (total-cost) - number
              (distance ?b ?b2 - base-conf))

  (:derived (on ?o ?s)
    (exists (?p - pose) (and (supported ?o ?p ?s) (at-pose ?o ?p))))
  (:derived (blocked ?o ?p)
    (exists (?o2 - movable ?p2 - pose)
      (and (at-pose ?o2 ?p2) (not (= ?o ?o2)) (not (clear ?o ?p ?o2 ?p2)))))

  (:action move
    :parameters (?b ?b2 - base-conf)
    :precondition (at-base ?b)
    :effect (and (at-base ?b2)
                 (not (at-base ?b))
                 (increase (total-cost) (distance ?b ?b2))))
  (:action pick
    :parameters (?o - movable ?p - pose ?g - grasp ?b - base-conf)
    :precondition (and (kin ?o ?p ?g ?b)
                       (hand-empty) (at-base ?b)
                       (imply (on ?o depot) (not (blocked ?o ?p)))
                       (at-pose ?o ?p))
    :effect (and (holding ?o ?g)
                 (not (hand-empty))
                 (not (at-pose ?o ?p))
                 (increase (total-cost) 2) (increase (total-cost) 0.5)))
  (:action wait
    :parameters ()
    :effect (and (forall (?o - movable ?g - grasp) (when (holding ?o ?g)
                   (and (hand-empty) (not (holding ?o ?g))))))))
"""

STREAMS = """\
(define (stream cupboard)
  (:stream sample-grasp
    :inputs (?o) :domain (movable ?o)
    :outputs (?g) :certified (grasp ?o ?g))
  (:stream sample-on
    :inputs (?o ?s) :domain (and (movable ?o) (surface ?s))
    :fluents (at-pose holding)
    :outputs (?p) :certified (and (pose ?o ?p) (supported ?o ?p ?s)))
  (:stream inverse-kinematics
    :inputs (?o ?p ?g) :domain (and (pose ?o ?p) (grasp ?o ?g))
    :outputs (?b) :certified (and (base-conf ?b) (kin ?o ?p ?g ?b)))
  (:stream test-clear
    :inputs (?o ?p ?o2 ?p2) :domain (and (pose ?o ?p) (pose ?o2 ?p2))
    :certified (clear ?o ?p ?o2 ?p2))
  (:function (Distance ?b1 ?b2) (and (base-conf ?b1) (base-conf ?b2))))
"""

OBJECTS = {
    "mug": ("movable",),
    "Box": ("movable",),
    "table": ("fixed", "surface"),
    "cupboard_top": ("surface",),
    "shelf": ("container",),
}

RaisesAt = Callable[..., InputError]


@pytest.fixture(scope="session")
def domain_text() -> str:
    return DOMAIN


@pytest.fixture(scope="session")
def streams_text() -> str:
    return STREAMS


@pytest.fixture(scope="session")
def domain() -> Domain:
    return parse_domain(DOMAIN, "cupboard.pddl")


@pytest.fixture(scope="session")
def streams(domain: Domain) -> StreamFile:
    return parse_streams(STREAMS, domain, "cupboard.streams.pddl")


@pytest.fixture(scope="session")
def objects() -> dict[str, tuple[str, ...]]:
    return dict(OBJECTS)


@pytest.fixture(scope="session")
def raises_at() -> RaisesAt:
    """Parse a text in which `@@` marks where the InputError must be; gives the error."""

    def check(parse: Callable[[str], object], marked: str, message: str) -> InputError:
        before, marker, after = marked.partition("@@")
        assert marker
        with pytest.raises(InputError) as caught:
            parse(before + after)
        error = caught.value
        expected = (before.count("\n") + 1, len(before) - before.rfind("\n"))
        assert (error.line, error.column) == expected, str(error)
        assert message in str(error)
        return error

    return check


@pytest.fixture(scope="session")
def changed() -> Callable[[str, str, str], str]:
    """A text with its only occurrence of `old` replaced by `new`."""

    def change(text: str, old: str, new: str) -> str:
        assert text.count(old) == 1, f"{old!r} stands {text.count(old)} times"
        return text.replace(old, new)

    return change
