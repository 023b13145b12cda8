"""An arm as arrays: from the robot's base to the tool, joint by joint."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.chain import Chain
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.scene.pose import Array, Pose


def test_the_first_origin_is_in_the_base_and_the_tool_in_the_last_joint() -> None:
    """The arm's foot a quarter turn about z at (1, 2, 3): 0.1 m along its x is +y of the base."""
    robot = ROBOTS["ur5"]()
    joints = (replace(robot.joints[0], origin=Pose((0.1, 0.0, 0.5))), *robot.joints[1:])
    robot = replace(
        robot, joints=joints, T_base_arm=Pose.from_xyz_yaw(1.0, 2.0, 3.0, math.pi / 2),
        T_flange_hand=Pose((0.0, 0.0, 0.2)), T_hand_tool=Pose.from_xyz_yaw(0.0, 0.0, 0.1, 0.5),
    )  # fmt: skip
    chain = Chain.of(robot)
    assert chain.origins[0][:3, 3] == pytest.approx([1.0, 2.1, 3.5])
    assert chain.origins[0][:2, :2] == pytest.approx(np.array([[0, -1], [1, 0]]), abs=1e-12)
    for k in range(1, 6):
        assert np.array_equal(chain.origins[k], joints[k].origin.matrix)
    assert chain.T_flange_tool == pytest.approx(Pose.from_xyz_yaw(0.0, 0.0, 0.3, 0.5).matrix)
    assert joints[0].origin.position == (0.1, 0.0, 0.5)  # the robot's own is left alone
    for found, wanted in (
        (chain.lower, robot.lower), (chain.upper, robot.upper), (chain.home, robot.home),
    ):  # fmt: skip
        assert found.tolist() == list(wanted)


def along(chain: Chain, q: Array) -> Array:
    """The tool's pose (4, 4) in the base, joint after joint."""
    T = np.eye(4)
    for origin, slides, value in zip(chain.origins, chain.slides, q, strict=True):
        T = T @ origin
        T = T @ (Pose((0.0, 0.0, value)) if slides else Pose.from_xyz_yaw(0, 0, 0, value)).matrix
    return T @ chain.T_flange_tool


@pytest.mark.parametrize(("name", "slides"), [("panda_mobile", []), ("pr2", [0])])
def test_the_joints_one_after_the_other_lead_to_the_tool(
    name: str, slides: list[int], rng: np.random.Generator
) -> None:
    robot = ROBOTS[name]()
    chain, kinematics = Chain.of(robot), Kinematics(robot)
    assert np.flatnonzero(chain.slides).tolist() == slides
    for q in rng.uniform(robot.lower, robot.upper, (20, len(robot.joints))):
        assert along(chain, q) == pytest.approx(kinematics.arm_tool(q), abs=1e-9)


def test_kernels_take_its_arrays_in_their_order() -> None:
    chain = Chain.of(ROBOTS["ur5"]())
    fields = (chain.origins, chain.slides, chain.T_flange_tool, chain.lower, chain.upper)
    assert all(a is b for a, b in zip(chain.arrays, fields, strict=True))
    assert chain.origins.dtype == chain.slides.dtype == np.float64
