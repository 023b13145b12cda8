"""Base poses for arms that lack a direction."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot import base_fit
from tamp.geometric.robot.base_fit import SHIFT, TURN, BaseFit, freedom
from tamp.geometric.robot.chain import Chain
from tamp.geometric.robot.inverse_kinematics import ArmIK
from tamp.geometric.robot.kinematics import Kinematics, base_matrix
from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.urdf import Joint
from tamp.geometric.scene.pose import Pose


def desk_arm() -> Robot:
    """Make an arm of five joints: about the upright, three about level axes, and about the tool."""
    level = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (np.pi / 2, 0.0, 0.0))
    origins = [
        Pose((0.0, 0.0, 0.1)),
        Pose((0.0, 0.0, 0.06)) @ level,
        Pose((0.0, 0.4, 0.0)),
        Pose((0.0, 0.35, 0.0)),
        Pose((0.0, 0.0, 0.0)) @ level.inverse(),
    ]
    joints = tuple(
        Joint(f"j{n}", "revolute", "", f"link{n}", origin, (0.0, 0.0, 1.0), -2.9, 2.9, 1.0)
        for n, origin in enumerate(origins)
    )
    return replace(
        ROBOTS["ur5"](), joints=joints, lower=(-2.9,) * 5, upper=(2.9,) * 5,
        home=(0.0, -0.5, 1.5, 0.5, 0.0), T_flange_hand=Pose(), locked=None,
    )  # fmt: skip


@pytest.mark.parametrize("name", ROBOTS)
def test_shipped_arms_move_the_tool_in_all_directions(name: str) -> None:
    assert freedom(ROBOTS[name]()) == 6


@pytest.mark.parametrize("name", sorted(ROBOTS))
def test_directions_are_told_by_pinocchios_jacobian(name: str) -> None:
    robot = ROBOTS[name]()
    chain, kinematics, rng = Chain.of(robot), Kinematics(robot), np.random.default_rng(1)
    for q in rng.uniform(robot.lower, robot.upper, (10, len(robot.home))):
        J = kinematics.jacobian(np.concatenate([np.zeros(3), q]))[:, 3:]
        assert np.abs(base_fit._jacobian(chain, q) - J).max() < 1e-12


def test_an_arm_of_five_joints_lacks_one() -> None:
    assert freedom(desk_arm()) == 5


def test_from_a_fitted_base_the_arm_reaches_what_it_does_not_from_the_drawn_one() -> None:
    robot = desk_arm()
    fit, ik, kinematics, rng = (
        BaseFit(robot),
        ArmIK(robot),
        Kinematics(robot),
        np.random.default_rng(0),
    )
    before = after = 0
    for _ in range(100):
        q = rng.uniform(-1.5, 1.5, 5)
        stood = np.array([*rng.uniform(-1.0, 1.0, 2), rng.uniform(-3.0, 3.0)])
        T_world_tool = kinematics.tool(np.concatenate([stood, q]))
        drawn = stood + rng.uniform(-1, 1, 3) * [0.1, 0.1, 0.3]
        base = fit.fit(T_world_tool, drawn)
        turned = (base[2] - drawn[2] + np.pi) % (2 * np.pi) - np.pi
        assert np.abs(base[:2] - drawn[:2]).max() <= SHIFT * 2**0.5 and abs(turned) <= TURN + 1e-9
        for pose, count in ((drawn, "before"), (base, "after")):
            found = len(ik.solve(np.linalg.inv(base_matrix(pose)) @ T_world_tool, enough=1))
            before += found if count == "before" else 0
            after += found if count == "after" else 0
    assert before == 0 and after >= 95
