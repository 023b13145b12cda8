"""Which relations a streams file declares, and what it is of each that a classifier is asked about."""

from __future__ import annotations

import pytest

from tamp.symbolic.pddl.formatter import to_text
from tamp.symbolic.pddl.parser import parse_domain, parse_goal, parse_streams
from tamp.symbolic.pddl.relations import (
    Relation,
    failing,
    instances,
    needed_false,
    relation_names,
    relation_of,
    streams_of,
)
from tamp.symbolic.pddl.structs import Domain, StreamFile

DOMAIN = """(define (domain d) (:requirements :typing)
  (:types cup shelf pose - object)
  (:predicates (pose ?o - cup ?p - pose) (at-pose ?o - cup ?p - pose)
    (stood ?o - cup ?p - pose ?s - shelf) (left ?o - cup ?p - pose ?o2 - cup ?p2 - pose)
    (dry ?o - cup) (turned ?o - cup ?p ?p2 - pose) (seen ?o - cup) (lone) (drunk ?o - cup) (tidy))
  (:derived (seen ?o) (exists (?p - pose ?s - shelf) (and (at-pose ?o ?p) (stood ?o ?p ?s))))
  (:derived (lone) (forall (?o - cup) (not (seen ?o))))
  (:action drink :parameters (?o - cup) :precondition (seen ?o) :effect (drunk ?o)))"""
TEST_LEFT = """(:stream test-left :inputs (?o ?p ?o2 ?p2)
  :domain (and (pose ?o ?p) (pose ?o2 ?p2)) :certified (left ?o ?p ?o2 ?p2))"""
SAMPLE_STOOD = """(:stream sample-stood :inputs (?o ?s) :domain (and (cup ?o) (shelf ?s))
  :outputs (?p) :certified (and (pose ?o ?p) (stood ?o ?p ?s)))"""


def declared(*streams: str, domain: str = DOMAIN) -> tuple[StreamFile, Domain]:
    parsed = parse_domain(domain)
    return parse_streams(f"(define (stream d) {' '.join(streams)})", parsed), parsed


def relation(name: str, *streams: str) -> Relation | None:
    return relation_of(*declared(*streams), name)


def test_a_relation_is_named_once_whatever_streams_it_has() -> None:
    named = (
        "sample-on", "test-left", "sample-on-inside", "test-on", "test-on-also", "move-on",
        "test-not-dry-inside",
    )  # fmt: skip
    text = " ".join(
        f"(:stream {name} :inputs (?o) :domain (cup ?o) :certified (dry ?o))" for name in named
    )
    assert relation_names(declared(text)[0]) == ("on", "left", "not-dry-inside")
    assert streams_of("on") == (
        "sample-on", "sample-on-inside", "sample-on-on-movable", "sample-on-inside-movable",
        "test-on", "test-on-also",
    )  # fmt: skip


def test_a_pose_is_that_of_the_body_before_it() -> None:
    left = relation("left", TEST_LEFT)
    assert left is not None
    assert left.arguments == left.bodies == ("?o", "?o2")
    assert left.poses == {"?p": "?o", "?p2": "?o2"}
    facts = left.substitute({"?o": "mug", "?o2": "jar"}, {"mug": "p1", "jar": "p7"})
    assert facts == (("left", "mug", "p1", "jar", "p7"),)


def test_what_a_generator_alone_certifies_says_that_a_relation_holds() -> None:
    stood = relation("stood", SAMPLE_STOOD)
    assert stood is not None
    assert stood.arguments == ("?o", "?s") and stood.bodies == ("?o",)
    assert stood.predicates == {"stood"}  # not pose, which says nothing of the relation
    shared = (
        "(:stream find :inputs (?o ?s) :domain (and (cup ?o) (shelf ?s)) :outputs (?p)"
        " :certified (stood ?o ?p ?s))"
    )
    assert relation("stood", SAMPLE_STOOD, shared) is None  # another stream says it as well
    assert relation("left", SAMPLE_STOOD) is None


@pytest.mark.parametrize(
    "stream",
    [
        # a classifier that proposes
        "(:stream test-left :inputs (?o ?o2 ?p2) :domain (and (cup ?o) (pose ?o2 ?p2)) :outputs (?p)"
        " :certified (left ?o ?p ?o2 ?p2))",
        # what is certified leaves out an input
        "(:stream test-left :inputs (?o ?p ?s) :domain (and (pose ?o ?p) (shelf ?s))"
        " :certified (pose ?o ?p))",
        # one body in two places
        "(:stream test-left :inputs (?o ?p ?p2) :domain (and (pose ?o ?p) (pose ?o ?p2))"
        " :certified (turned ?o ?p ?p2))",
    ],
)
def test_what_no_fact_says_by_its_terms_alone_is_no_relation(stream: str) -> None:
    assert relation("left", stream) is None


def test_a_classifier_is_asked_of_fitting_names_and_of_no_body_twice() -> None:
    left, stood = relation("left", TEST_LEFT), relation("stood", SAMPLE_STOOD)
    assert left is not None and stood is not None
    objects = {
        "mug": ("cup",),
        "jar": ("cup",),
        "lost": ("cup",),
        "top": ("shelf",),
        "x": ("shelf",),
    }
    _, domain = declared()

    def asked(one: Relation) -> list[tuple[str, ...]]:
        placed, named = {"mug", "jar"}, {"mug", "jar", "lost", "top"}
        found = instances(one, domain, objects, (), placed, named)
        return [tuple(names.values()) for names in found]

    assert asked(left) == [("mug", "jar"), ("jar", "mug")]
    assert asked(stood) == [("mug", "top"), ("jar", "top")]  # x is no place of the scene


def test_kinds_that_are_facts_count_like_types() -> None:
    domain = parse_domain("""(define (domain d) (:predicates (movable ?o) (surface ?s)
      (pose ?o ?p) (stood ?o ?p ?s)))""")
    text = SAMPLE_STOOD.replace("(cup ?o) (shelf ?s)", "(movable ?o) (surface ?s)")
    stood = relation_of(parse_streams(f"(define (stream d) {text})", domain), domain, "stood")
    assert stood is not None
    objects, facts = dict.fromkeys(("a", "b"), ("object",)), {("movable", "a"), ("surface", "b")}
    found = list(instances(stood, domain, objects, facts, {"a", "b"}, {"a", "b"}))
    assert found == [{"?o": "a", "?s": "b"}]


@pytest.mark.parametrize(
    ("goal", "needed"),
    [
        ("(seen mug)", None),
        ("(not (seen mug))", "(seen mug)"),  # through the rule
        ("(lone)", "(lone)"),
        ("(not (lone))", None),  # twice denied
        ("(and (drunk mug) (not (tidy)))", None),
    ],
)
def test_a_condition_that_a_false_relation_helps_is_found(goal: str, needed: str | None) -> None:
    domain = parse_domain(DOMAIN)
    condition = parse_goal(goal, domain, {"mug": ("cup",)})
    found = needed_false(domain, condition, {"stood"})
    assert (found and to_text(found)) == needed


@pytest.mark.parametrize("condition", ["(seen ?o)", "(not (seen ?o))"])
def test_whether_an_effect_happens_has_to_be_known_both_ways(condition: str) -> None:
    effect = f":effect (when {condition} (drunk ?o))"
    domain = parse_domain(DOMAIN.replace(":effect (drunk ?o)", effect))
    found = needed_false(domain, parse_goal("(tidy)", domain, {}), {"stood"})
    assert found is not None and to_text(found) == "(seen ?o)"


def test_the_stream_of_a_relation_that_fails_asks_for_any_poses() -> None:
    either = DOMAIN.replace("?p - pose ?s - shelf)", "?p - pose ?s - (either cup shelf))", 1)
    streams, domain = declared(SAMPLE_STOOD, domain=either)
    stood = relation_of(streams, domain, "stood")
    assert stood is not None
    stream = failing(stood, domain)
    assert (stream.name, stream.inputs, stream.outputs) == (
        "test-not-stood",
        ("?o", "?p", "?s"),
        (),
    )
    assert [to_text(atom) for atom in stream.domain] == ["(pose ?o ?p)", "(cup ?o)", "(shelf ?s)"]
    assert [to_text(atom) for atom in stream.certified] == ["(not-stood ?o ?p ?s)"]
