"""What the plan expects after each action: by PDDL's meaning, with poses and grasps behind the names."""

from __future__ import annotations

import numpy as np
import pytest

from tamp.execution.expected import Expected
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box
from tamp.plan.read import Hold, TimedAction, Value
from tamp.symbolic.pddl.parser import parse_domain
from tests.geometric.making import body, crate, scene, table
from tests.plan.making import plan_of

DOMAIN = parse_domain("""(define (domain d) (:requirements :typing :derived-predicates)
  (:types movable surface container pose grasp - object)
  (:predicates (at-pose ?o - movable ?p - pose) (holding ?o - movable ?g - grasp) (hand-empty)
    (supported ?o - movable ?p - pose ?s - surface) (contained ?o - movable ?p - pose ?c - container)
    (on ?o - movable ?s - surface) (inside ?o - movable ?c - container))
  (:derived (on ?o ?s) (exists (?p - pose) (and (supported ?o ?p ?s) (at-pose ?o ?p))))
  (:derived (inside ?o ?c) (exists (?p - pose) (and (contained ?o ?p ?c) (at-pose ?o ?p))))
  (:action pick :parameters (?o - movable ?p - pose ?g - grasp)
    :effect (and (not (at-pose ?o ?p)) (holding ?o ?g) (not (hand-empty))))
  (:action place :parameters (?o - movable ?p - pose ?g - grasp)
    :effect (and (at-pose ?o ?p) (not (holding ?o ?g)) (hand-empty))))""")
SCENE = scene(table(), crate(), body("Cup", Box((0.1, 0.1, 0.1)), (0.2, 0, 0.551)))
START, GOAL, GRASP = (
    Pose((0.2, 0, 0.551)).matrix,
    Pose((2.0, 0, 0.071)).matrix,
    Pose((0, 0, 0.1)).matrix,
)


@pytest.fixture
def expected() -> Expected:
    plan = plan_of(
        values={
            "p0": Value("pose", START),
            "p1": Value("pose", GOAL),
            "g": Value("grasp", Hold("cup", GRASP, 0.05)),
        },
        initial=[("at-pose", "cup", "p0"), ("hand-empty",), ("supported", "cup", "p0", "table")],
        certified=[("contained", "cup", "p1", "crate_inside")],
    )
    objects = {"cup": ("movable",), "table": ("surface",), "crate_inside": ("container",)}
    return Expected(type(plan)(**{**vars(plan), "objects": objects}), DOMAIN, SCENE)


def act(name: str, *arguments: str) -> TimedAction:
    return TimedAction(name, arguments, 0.0, 1.0, 1.0, ())


PICK, PLACE = act("pick", "cup", "p0", "g"), act("place", "cup", "p1", "g")


def test_at_the_start_bodies_stand_where_the_plan_says(expected: Expected) -> None:
    assert expected.poses.keys() == {"Cup"}  # the scene's name
    assert expected.poses["Cup"] == pytest.approx(START)
    assert expected.held is None and expected.facts == {("on", "cup", "table")}


def test_in_the_hand_a_body_is_nowhere_and_on_nothing(expected: Expected) -> None:
    expected.apply(PICK)
    assert expected.poses == {} and expected.facts == frozenset()
    assert expected.held is not None
    name, T_tool_body = expected.held
    assert name == "Cup" and T_tool_body == pytest.approx(GRASP)


def test_put_down_it_is_at_its_new_pose_and_in_what_that_is_in(expected: Expected) -> None:
    expected.apply(PICK)
    expected.apply(PLACE)
    assert expected.poses["Cup"] == pytest.approx(GOAL)
    assert expected.held is None and expected.facts == {("inside", "cup", "crate_inside")}


def test_what_is_seen_may_be_accepted_until_the_plan_moves_it(expected: Expected) -> None:
    seen = Pose((0.23, 0.01, 0.551)).matrix
    expected.accept({"Cup": seen})
    assert expected.poses["Cup"] == pytest.approx(seen)
    expected.apply(PICK)
    expected.apply(PLACE)
    assert expected.poses["Cup"] == pytest.approx(GOAL)


def test_what_is_not_seen_is_not_accepted(expected: Expected) -> None:
    expected.accept({"other": np.eye(4)})
    assert expected.poses["Cup"] == pytest.approx(START)


@pytest.mark.parametrize("action", [act("fly", "cup"), act("pick", "cup")])
def test_an_action_that_the_domain_does_not_know_has_no_effect(
    expected: Expected, action: TimedAction
) -> None:
    expected.apply(action)
    assert expected.facts == {("on", "cup", "table")} and expected.held is None


def test_a_pose_without_a_value_is_no_expectation(expected: Expected) -> None:
    expected.apply(PICK)
    expected.apply(act("place", "cup", "nowhere", "g"))
    assert expected.poses == {} and expected.held is None
