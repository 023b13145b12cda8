"""A home configuration: the hand in front and down where that can be, clear of the robot."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tamp.commands.robot_folder import home as module
from tamp.commands.robot_folder.home import ROOM, home, lowest
from tamp.commands.robot_folder.self_collision import home_collision
from tamp.errors import InputError
from tamp.geometric.loading.robot_folder import read_robot
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.scene.pose import Pose


def test_an_arm_whose_hand_never_points_exactly_down_has_a_home_all_the_same(five: Path) -> None:
    robot = read_robot(five)
    # the last axis is half a degree off the plane of the arm: no pose with the hand upright is met
    tilt = replace(robot.joints[-1].origin, quaternion=_tilted(robot.joints[-1].origin.quaternion))
    bent = replace(robot, joints=(*robot.joints[:-1], replace(robot.joints[-1], origin=tilt)))
    q = home(bent, 1.1)
    assert home_collision(bent, q) is None
    tool = Kinematics(bent).arm_tool(np.array(q))
    assert tool[0, 3] > robot.T_base_arm.position[0] + 0.2 and tool[2, 3] > 0.3


def _tilted(quaternion: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
    return (
        Pose((0.0, 0.0, 0.0), quaternion) @ Pose.from_xyz_rpy((0, 0, 0), (0.009, 0.009, 0.0))
    ).quaternion


def test_the_hand_points_down_in_front_of_the_foot_where_it_can() -> None:
    robot = ROBOTS["ur5"]()
    q = home(robot, 0.95)
    tool = Kinematics(robot).arm_tool(np.array(q))
    assert home_collision(robot, q) is None
    assert tool[:3, 2] == pytest.approx((0.0, 0.0, -1.0), abs=1e-4)
    assert 0.2 < tool[0, 3] - robot.T_base_arm.position[0] < 0.8
    assert tool[2, 3] >= lowest(robot) - 1e-3
    assert all(
        low <= one <= high for low, one, high in zip(robot.lower, q, robot.upper, strict=True)
    )


def test_what_hangs_from_the_hand_clears_a_base_that_drives() -> None:
    driving = ROBOTS["panda_mobile"]()
    fixed = ROBOTS["panda_fixed"]()
    assert lowest(fixed) == ROOM
    top = driving.link(driving.base).parts[0].pose.position[2]
    assert top > 0.0 and lowest(driving) == pytest.approx(ROOM + top)


def test_an_arm_that_reaches_nothing_in_front_of_it_is_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "SAMPLES", 100)
    buried = replace(ROBOTS["panda_fixed"](), T_base_arm=Pose((0.0, 0.0, -3.0)))
    with pytest.raises(InputError, match=r"reaches no place in front of it.*--home, or mount it"):
        home(buried, 1.2)
