"""FK against a second engine, Jacobians against finite differences."""

from __future__ import annotations

import platform

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.kinematics import Kinematics, base_matrix
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Pose
from tests.needs import NEEDS_PYBULLET


@pytest.fixture(scope="module")
def robot() -> Robot:
    return ROBOTS["panda_mobile"]()


@pytest.fixture(scope="module")
def kinematics(robot: Robot) -> Kinematics:
    return Kinematics(robot)


def random_confs(robot: Robot, count: int) -> np.ndarray:
    rng = np.random.default_rng(1)
    return np.hstack(
        [rng.uniform(-3, 3, (count, 3)), rng.uniform(robot.lower, robot.upper, (count, 7))]
    )


@NEEDS_PYBULLET
def test_link_poses_agree_with_pybullet(robot: Robot, kinematics: Kinematics) -> None:
    import pybullet as bullet

    client = bullet.connect(bullet.DIRECT)
    arm = bullet.loadURDF(str(robot.urdf), useFixedBase=True, physicsClientId=client)
    info = [
        bullet.getJointInfo(arm, i, physicsClientId=client)
        for i in range(bullet.getNumJoints(arm, client))
    ]
    index_of = {entry[1].decode(): entry[0] for entry in info}
    link_of = {entry[12].decode(): entry[0] for entry in info}
    inertial = Pose(
        bullet.getDynamicsInfo(arm, -1, physicsClientId=client)[3]
    )  # pybullet places the centre of mass
    checked = 0
    for number, conf in enumerate(random_confs(robot, 20)):
        opening = 0.004 * number
        mount = Pose.from_matrix(base_matrix(conf) @ robot.T_base_arm.matrix)
        mount = mount @ inertial
        bullet.resetBasePositionAndOrientation(
            arm, mount.position, mount.quaternion, physicsClientId=client
        )
        values = dict(zip((joint.name for joint in robot.joints), conf[3:], strict=True))
        values |= {finger.name: opening / 2 for finger in robot.fingers}
        for name, value in values.items():
            bullet.resetJointState(arm, index_of[name], value, physicsClientId=client)
        for name, T in kinematics.link_poses(conf, opening).items():
            if name in link_of:
                state = bullet.getLinkState(
                    arm, link_of[name], computeForwardKinematics=True, physicsClientId=client
                )
                assert np.allclose(T, Pose(state[4], state[5]).matrix, atol=1e-6)
                checked += 1
    bullet.disconnect(client)
    assert checked == 20 * 10


def test_link_poses_cover_all_links_and_the_tool_is_on_the_hand(
    robot: Robot, kinematics: Kinematics
) -> None:
    conf = random_confs(robot, 1)[0]
    poses = kinematics.link_poses(conf, 0.05)
    assert list(poses) == [link.name for link in robot.links]
    assert np.allclose(
        poses["panda_hand"] @ robot.T_hand_tool.matrix, kinematics.tool(conf), atol=1e-12
    )
    assert np.allclose(
        base_matrix(conf) @ kinematics.arm_tool(conf[3:]), kinematics.tool(conf), atol=1e-12
    )
    gap = (
        np.linalg.inv(poses["panda_hand"])
        @ (poses["panda_leftfinger"] - poses["panda_rightfinger"])[:, 3]
    )
    assert np.allclose(gap[:3], (0.0, 0.05, 0.0), atol=1e-12)


def test_earlier_results_are_not_overwritten(robot: Robot, kinematics: Kinematics) -> None:
    first, second = random_confs(robot, 2)
    tool, poses, jacobian = (
        kinematics.tool(first),
        kinematics.link_poses(first, 0.0),
        kinematics.jacobian(first),
    )
    kept = tool.copy(), poses["panda_link3"].copy(), jacobian.copy()
    for compute in (
        kinematics.tool,
        lambda conf: kinematics.link_poses(conf, 0.0),
        kinematics.jacobian,
    ):
        compute(second)
    assert all(
        np.array_equal(a, b)
        for a, b in zip((tool, poses["panda_link3"], jacobian), kept, strict=True)
    )


def test_jacobian_agrees_with_finite_differences(robot: Robot, kinematics: Kinematics) -> None:
    step = 1e-6
    confs = random_confs(robot, 10)
    for conf in confs:
        jacobian = kinematics.jacobian(conf)
        assert jacobian.shape == (6, 10)
        for column in range(10):
            delta = np.zeros(10)
            delta[column] = step
            before, after = kinematics.tool(conf - delta), kinematics.tool(conf + delta)
            linear = (after - before)[:3, 3] / (2 * step)
            skew = (after[:3, :3] - before[:3, :3]) / (2 * step) @ kinematics.tool(conf)[:3, :3].T
            angular = np.array([skew[2, 1], skew[0, 2], skew[1, 0]])
            assert np.allclose(jacobian[:, column], np.concatenate([linear, angular]), atol=1e-6)
    assert len(confs) == 10


@pytest.mark.parametrize("name", sorted(ROBOTS))
def test_the_plain_tool_is_pinocchios(name: str) -> None:
    robot = ROBOTS[name]()
    kinematics, rng, equal = Kinematics(robot), np.random.default_rng(3), 0
    for arm in (
        np.array(robot.home),
        *rng.uniform(robot.lower, robot.upper, (200, len(robot.home))),
    ):
        for base in (np.zeros(3), rng.uniform(-3, 3, 3)):
            conf = np.concatenate([base, arm])
            plain, library = kinematics.tool_plainly(conf), kinematics.tool(conf)
            assert np.abs(plain - library).max() < 1e-12
            equal += np.array_equal(plain, library)
    if platform.machine() == "x86_64":  # plans do not change with who computed it
        assert equal == 402
