"""Suction grasps: the whole rim on one face, square to it, the hand free, strong enough."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from tamp.geometric.collision.fcl_bodies import FclBody, touch
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Part
from tamp.geometric.streams.suction import CUP_GAP_M, suction_strain
from tests.geometric.streams.cups import CUP, body, first, with_cup


@pytest.fixture(scope="module")
def robot() -> Robot:
    return with_cup()


def distance_to_box(points: np.ndarray, size: tuple[float, float, float]) -> np.ndarray:
    """Signed distances of points (n, 3) from a box's surface, by the formula."""
    q = np.abs(points) - np.array(size) / 2
    return np.linalg.norm(np.maximum(q, 0.0), axis=1) + np.minimum(q.max(axis=1), 0.0)


@pytest.mark.parametrize("size", [(0.2, 0.3, 0.1), (0.05, 0.16, 0.21), (0.06, 0.06, 0.06)])
def test_the_whole_rim_is_on_a_face_and_the_hand_is_free(
    robot: Robot, size: tuple[float, float, float]
) -> None:
    thing = body(Box(size))
    grasps = first(robot, thing, 60)
    assert len(grasps) == 60
    angles = np.linspace(0.0, 2 * math.pi, 40)
    rim = np.column_stack([0.02 * np.cos(angles), 0.02 * np.sin(angles), 0 * angles])
    still, hand = FclBody(thing.parts), robot.link(robot.hand)
    for grasp in grasps:
        assert grasp.body == "thing" and grasp.opening == 0.0
        T = grasp.T_tool_body.inverse()
        assert distance_to_box(T.apply(rim), size) == pytest.approx(CUP_GAP_M, abs=1e-6)
        for back in (0.0, 0.05, 0.1):
            at = (T @ Pose((0.0, 0.0, -back)) @ robot.T_hand_tool.inverse()).matrix
            assert not any(
                touch(FclBody(hand.parts).place(k, at), still.place(0, np.eye(4)), 0.0)
                for k in range(len(hand.parts))
            )


def test_the_first_grasp_is_from_above_over_the_middle(robot: Robot) -> None:
    thing = body(Box((0.2, 0.3, 0.1)))
    T = first(robot, thing, 1)[0].T_tool_body.inverse()
    assert T.rotation[:, 2] == pytest.approx([0.0, 0.0, -1.0], abs=1e-9)
    assert T.position == pytest.approx((0.0, 0.0, 0.05 + CUP_GAP_M), abs=1e-9)


def test_every_face_has_its_turn_before_one_is_held_another_way(robot: Robot) -> None:
    # what is to be laid on another side is held by what is up there
    grasps = first(robot, body(Box((0.06, 0.07, 0.08)), mass=0.1), 6)
    axes = {tuple(np.round(g.T_tool_body.inverse().rotation[:, 2]).astype(int)) for g in grasps}
    assert len(axes) == 6


def test_a_can_is_held_by_its_ends_only(robot: Robot) -> None:
    grasps = first(robot, body(Cylinder(0.033, 0.1)), 40)
    assert len(grasps) == 40
    axes = np.array([grasp.T_tool_body.inverse().rotation[:, 2] for grasp in grasps])
    assert np.abs(axes[:, 2]) == pytest.approx(1.0, abs=1e-9)


def test_an_edge_in_the_rim_s_way_is_no_place(robot: Robot) -> None:
    # a plate with a bar across its middle: the cup goes beside the bar, and never under it
    plate, bar = Part(Box((0.3, 0.2, 0.02))), Part(Box((0.02, 0.2, 0.03)), Pose((0.0, 0.0, 0.02)))
    grasps = first(robot, body(plate, bar), 60)
    above = [g for g in grasps if g.T_tool_body.inverse().rotation[2, 2] < -0.9]
    assert len(above) >= 20
    assert all(abs(g.T_tool_body.inverse().position[0]) >= 0.01 + 0.02 for g in above)


def test_strain_is_the_share_of_the_pull_and_of_the_turn_that_lifts_the_rim() -> None:
    thing = body(Box((0.2, 0.2, 0.1)), mass=1.0)
    down = np.diag([1.0, -1.0, -1.0, 1.0])
    over, beside = down.copy(), down.copy()
    over[:3, 3], beside[:3, 3] = (0.0, 0.0, 0.05), (0.03, 0.0, 0.05)
    held = np.array([0.0, 0.0, -1.0])
    middle = suction_strain(thing, np.zeros(3), over, CUP, 75.0, (held,))
    # at rest 9.81 N of 75; shaken by 0.3 g straight up, 1.3 times as much, or to the side by less
    assert middle >= 1.3 * 9.81 / 75.0 - 1e-9
    aside = suction_strain(thing, np.zeros(3), beside, CUP, 75.0, (held,))
    lifts = 1.3 * 9.81 * (1 / 75.0 + 0.03 / (75.0 * 0.02))
    assert aside >= lifts - 1e-9 and aside > middle
    assert suction_strain(thing, np.zeros(3), over, CUP, 150.0, (held,)) == pytest.approx(
        middle / 2
    )


def test_a_weak_grasp_far_from_the_centre_of_mass_is_not_given(robot: Robot) -> None:
    weak = replace(robot, force=12.0)
    grasps = first(weak, body(Box((0.4, 0.4, 0.05)), mass=0.6), 30)
    assert grasps
    far = [math.hypot(*g.T_tool_body.inverse().position[:2]) for g in grasps]
    assert max(far) < 0.02


def test_the_same_seed_gives_the_same_grasps(robot: Robot) -> None:
    thing = body(Box((0.2, 0.3, 0.1)))
    assert first(robot, thing, 30) == first(robot, thing, 30)
