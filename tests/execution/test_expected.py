"""What the plan expects after each action: by PDDL's meaning, with poses and grasps behind the names."""

from __future__ import annotations

import numpy as np
import pytest

from tamp.execution.expected import Expected
from tamp.geometric.scene.pose import Pose
from tamp.plan.read import TimedAction
from tests.execution.cup import GOAL, GRASP, PICK, PLACE, START, act


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
