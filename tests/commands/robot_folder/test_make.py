"""From a URDF to a robot's folder: what is in it holds by other means."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio  # pyright: ignore[reportMissingImports]
import pytest

from tamp.commands.robot_folder.self_collision import home_collision
from tamp.geometric.loading.robot_folder import read_robot
from tamp.geometric.robot.inverse_kinematics import ArmIK
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.spheres import link_covers
from tamp.geometric.scene.scene import Hull


@pytest.fixture(params=["driving", "steered", "lifting", "bolted"])
def folder(request: pytest.FixtureRequest) -> Path:
    return request.getfixturevalue(request.param)


def test_the_tip_is_where_pinocchio_has_it(folder: Path) -> None:
    robot = read_robot(folder)
    model = pinocchio.buildModelFromUrdf(str(folder.parent / "arm.urdf"))
    data, tip = model.createData(), model.getFrameId("tool")
    kinematics, rng = Kinematics(robot), np.random.default_rng(0)
    for _ in range(50):
        q = rng.uniform(robot.lower, robot.upper)
        full = pinocchio.neutral(model)
        for joint, value in zip(robot.joints, q, strict=True):
            index = model.joints[model.getJointId(joint.name)]
            full[index.idx_q : index.idx_q + index.nq] = (
                [np.cos(value), np.sin(value)] if index.nq == 2 else [value]
            )
        pinocchio.framesForwardKinematics(model, data, full)
        hand = kinematics.link_poses(np.concatenate([np.zeros(3), q]), 0.0)[robot.hand]
        expected = robot.T_base_arm.matrix @ data.oMf[tip].homogeneous
        assert np.abs(hand - expected).max() < 2e-5


def test_inverse_kinematics_finds_what_forward_kinematics_reaches(folder: Path) -> None:
    robot = read_robot(folder)
    ik, kinematics, rng = ArmIK(robot), Kinematics(robot), np.random.default_rng(0)
    found = 0
    for _ in range(200):
        T = kinematics.arm_tool(rng.uniform(robot.lower, robot.upper))
        solutions = ik.solve(T, enough=1)
        found += len(solutions)
        for q in solutions:
            assert np.abs(kinematics.arm_tool(q) - T).max() < 1e-6
            assert np.all((np.array(robot.lower) <= q) & (q <= np.array(robot.upper)))
    assert found == 200


def test_home_is_free_and_within_the_limits(folder: Path) -> None:
    robot = read_robot(folder)
    assert home_collision(robot, robot.home) is None
    assert all(
        low <= q <= high for low, q, high in zip(robot.lower, robot.home, robot.upper, strict=True)
    )


def test_spheres_contain_their_hulls(folder: Path) -> None:
    robot = read_robot(folder)
    covers, rng, looked = link_covers(robot), np.random.default_rng(0), 0
    for link in robot.links:
        for number, part in enumerate(link.parts):
            if isinstance(part.shape, Hull):
                spheres, _ = covers[link.name, number]
                weights = rng.dirichlet(np.ones(len(part.shape.vertices)), 300)
                points = np.concatenate([weights @ part.shape.vertices, part.shape.vertices])
                gaps = (
                    np.linalg.norm(points[:, None] - spheres[None, :, :3], axis=2) - spheres[:, 3]
                )
                assert gaps.min(axis=1).max() < 1e-9
                looked += 1
    assert looked >= 9


def test_a_continuous_joint_may_turn_once_to_either_side(driving: Path) -> None:
    robot = read_robot(driving)
    assert robot.joints[-1].kind == "continuous"
    assert robot.upper[-1] - robot.lower[-1] == pytest.approx(4 * np.pi)


def test_a_lift_slides(lifting: Path) -> None:
    robot = read_robot(lifting)
    assert robot.prismatic == (True, *(False,) * 6)
    kinematics, q = Kinematics(robot), np.array(robot.home)
    low, high = q.copy(), q.copy()
    low[0], high[0] = robot.lower[0], robot.upper[0]
    rise = kinematics.arm_tool(high)[:3, 3] - kinematics.arm_tool(low)[:3, 3]
    assert rise == pytest.approx([0.0, 0.0, robot.upper[0] - robot.lower[0]], abs=1e-9)


def test_neighbours_are_allowed_and_others_are_not(driving: Path) -> None:
    allowed = read_robot(driving).allowed
    assert ("lift_link", "pan_link") in allowed and ("elbow_link", "lift_link") in allowed
    assert ("base", "elbow_link") not in allowed  # the arm can be laid down on the base
