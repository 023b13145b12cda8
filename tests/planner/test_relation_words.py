"""What a summary says of poses: the goal's own relations, as far as the plan's facts state them."""

from __future__ import annotations

from types import SimpleNamespace

from tamp.planner.relation_words import relation_words
from tamp.symbolic.pddl.parser import parse_domain, parse_streams
from tamp.symbolic.pddl.relations import relation_of
from tamp.symbolic.pddl.structs import Fact

DOMAIN = parse_domain("""(define (domain d) (:requirements :typing)
  (:types movable surface pose - object)
  (:predicates (pose ?o - movable ?p - pose) (stood ?o - movable ?p - pose)
    (left ?o - movable ?p - pose ?o2 - movable ?p2 - pose)))""")
STREAMS = parse_streams(
    """(define (stream d)
  (:stream test-upright :inputs (?o ?p) :domain (pose ?o ?p) :certified (stood ?o ?p))
  (:stream test-left_of :inputs (?o ?p ?o2 ?p2) :domain (and (pose ?o ?p) (pose ?o2 ?p2))
    :certified (left ?o ?p ?o2 ?p2)))""",
    DOMAIN,
)


def said(goal: str, *certified: Fact) -> dict[tuple[str, str], str]:
    relations = {name: relation_of(STREAMS, DOMAIN, name) for name in ("upright", "left_of")}
    problem = SimpleNamespace(relations=relations, goal=goal)
    return relation_words(SimpleNamespace(problem=problem, certified=certified))


LEFT, STOOD = ("left", "cup", "p1", "mug", "p2"), ("stood", "cup", "p1")


def test_a_relation_is_said_of_the_pose_of_its_first_argument() -> None:
    assert said("(left_of cup mug)", LEFT) == {("cup", "p1"): "left_of mug"}
    assert said("(upright cup)", STOOD) == {("cup", "p1"): "upright"}


def test_relations_of_one_pose_are_listed_each_once() -> None:
    other = ("left", "cup", "p1", "jar", "p9")
    again = ("left", "cup", "p1", "mug", "p7")
    found = said("(and (upright cup) (left_of cup mug))", again, STOOD, LEFT, other)
    assert found == {("cup", "p1"): "upright, left_of jar, left_of mug"}


def test_poses_are_told_apart() -> None:
    found = said("(upright cup)", STOOD, ("stood", "cup", "p2"), ("stood", "mug", "p1"))
    assert found.keys() == {("cup", "p1"), ("cup", "p2"), ("mug", "p1")}


def test_what_the_goal_does_not_ask_for_is_not_said() -> None:
    assert said("(left_of cup mug)", STOOD) == {}
    assert said("(not-upright cup)", STOOD) == {}
    assert said("(AND (Upright cup))", STOOD) == {("cup", "p1"): "upright"}


def test_other_facts_say_nothing() -> None:
    assert (
        said("(and (upright cup) (left_of cup mug))", ("pose", "cup", "p1"), ("stood", "cup")) == {}
    )
