"""What a classifier says of a scene, in facts; what it does not answer, and bodies that are elsewhere."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pytest

from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Scene
from tamp.relations.observed import ClassifierAnswers, moved, observe, refuse_silent, scene_names
from tamp.symbolic.pddl.parser import parse_domain, parse_streams
from tamp.symbolic.pddl.relations import relation_of
from tests.geometric.making import body, scene, table

DOMAIN = parse_domain("""(define (domain d) (:requirements :typing)
  (:types movable surface pose - object)
  (:predicates (pose ?o - movable ?p - pose) (left ?o - movable ?p - pose ?s - surface)))""")
STREAMS = parse_streams(
    """(define (stream d)
  (:stream test-left :inputs (?o ?p ?s) :domain (and (pose ?o ?p) (surface ?s)) :certified (left ?o ?p ?s)))""",
    DOMAIN,
)
OBJECTS = {
    "cup": ("movable",),
    "box": ("movable",),
    "table": ("surface",),
    "p1": ("pose",),
    "p2": ("pose",),
}
CUBE = Box((0.1, 0.1, 0.1))
SCENE = scene(table(), body("Cup", CUBE, (-0.2, 0, 0.551)), body("box", CUBE, (0.2, 0, 0.551)))


class Left:
    """Left of the middle, by x; odd answers for bodies that it is told."""

    def __init__(self, **odd: object) -> None:
        self.odd, self.asked = odd, list[tuple[str, ...]]()

    def classify(self, scene: Scene, arguments: Sequence[str]) -> float:
        self.asked.append(tuple(arguments))
        answer = self.odd.get(arguments[0])
        if isinstance(answer, Exception):
            raise answer
        return float(scene.bodies[arguments[0]].pose.position[0] < 0) if answer is None else answer  # type: ignore[return-value]


def seen(
    classifier: Left, at: dict[str, str] | None = None, made: Scene = SCENE
) -> ClassifierAnswers:
    relation = relation_of(STREAMS, DOMAIN, "left")
    assert relation is not None
    return observe(
        relation,
        classifier,
        made,
        DOMAIN,
        OBJECTS,
        (),
        {"cup": "p1", "box": "p2"} if at is None else at,
    )


def test_answers_become_facts_of_the_poses_that_bodies_have() -> None:
    classifier = Left()
    found = seen(classifier)
    assert found.holds == {("left", "cup", "p1", "table")} and found.fails == {
        ("left", "box", "p2", "table")
    }
    assert sorted(classifier.asked) == [
        ("Cup", "table"),
        ("box", "table"),
    ]  # the scene's names, not PDDL's
    assert found.answers == {("cup", "table"): 1.0, ("box", "table"): 0.0}


@pytest.mark.parametrize(("answer", "holds"), [(0.5, True), (0.4999, False), (1.0, True)])
def test_a_half_is_likely(answer: float, holds: bool) -> None:
    assert (("left", "box", "p2", "table") in seen(Left(box=answer)).holds) == holds


def test_what_it_cannot_tell_neither_holds_nor_fails() -> None:
    found = seen(Left(box=math.nan))
    assert not any("box" in fact for fact in (*found.holds, *found.fails))
    assert math.isnan(found.answers["box", "table"]) and found.unanswered == {}


def test_what_it_does_not_answer_is_kept_with_the_reason() -> None:
    found = seen(Left(box=ValueError("no such body")))
    assert found.unanswered == {("box", "table"): "it raised ValueError: no such body"}
    assert found.holds == {("left", "cup", "p1", "table")}
    refuse_silent("left", found)  # it answered something


def test_a_body_without_a_pose_is_not_asked_about() -> None:
    classifier = Left()
    seen(classifier, {"cup": "p1"})
    assert classifier.asked == [("Cup", "table")]


def test_a_classifier_that_answers_nothing_is_refused() -> None:
    found = seen(Left(Cup=ValueError("broken"), box=2.0))
    with pytest.raises(
        InputError,
        match=r"the classifier of 'left' does not work: asked of \(left (cup|box) table\), it",
    ):
        refuse_silent("left", found)
    refuse_silent("left", ClassifierAnswers())  # it was asked nothing


def test_bodies_are_moved_and_the_one_in_the_hand_is_away() -> None:
    there = Pose((0.4, 0.1, 0.551))
    changed = moved(SCENE, {"Cup": there}, absent=("box",))
    assert changed.bodies["Cup"].pose == there and "box" not in changed.bodies
    assert changed.bodies["table"] is SCENE.bodies["table"]
    assert SCENE.bodies["Cup"].pose.position[0] == -0.2  # the scene itself stays
    assert seen(Left(), made=changed).fails == {("left", "cup", "p1", "table")}


def test_names_of_bodies_and_places() -> None:
    assert scene_names(SCENE) == {"table": "table", "cup": "Cup", "box": "box"}
