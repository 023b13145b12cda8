"""What a URDF rounds is made exact, and what it cannot say is found otherwise."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tamp.commands.robot_folder.description import find_urdf, read_description
from tamp.commands.robot_folder.home import home
from tamp.commands.robot_folder.self_collision import home_collision
from tamp.errors import InputError
from tamp.geometric.loading.robot_folder import read_robot
from tamp.geometric.robot.kinematics import Kinematics
from tests.commands.robot_folder.urdf import arm_text


@pytest.mark.parametrize(
    ("rpy", "exact"),
    [
        ("1.5708 0 3.14159", (np.pi / 2, 0.0, np.pi)),
        ("1.5708 0.0486795 3.14159", (np.pi / 2, 0.0486795, np.pi)),
        ("0.01 0.02 -1.5707", (0.01, 0.02, -np.pi / 2)),
        ("0.7853 0.3 0.3", (np.pi / 4, 0.3, 0.3)),
        ("0.79 0.3 0.3", (0.79, 0.3, 0.3)),
    ],
)
def test_each_right_angle_is_made_exact_by_itself(tmp_path: Path, rpy: str, exact) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text(arm_text().replace('rpy="-1.5708 0 0"', f'rpy="{rpy}"'), encoding="utf-8")
    R = read_description(file).joints["tool_joint"].origin.rotation
    a, b, c = exact
    x, y, z = (
        np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]]),
        np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]]),
        np.array([[np.cos(c), -np.sin(c), 0], [np.sin(c), np.cos(c), 0], [0, 0, 1]]),
    )
    assert np.abs(R - z @ y @ x).max() < 1e-12


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
    from tamp.geometric.scene.pose import Pose

    return (
        Pose((0.0, 0.0, 0.0), quaternion) @ Pose.from_xyz_rpy((0, 0, 0), (0.009, 0.009, 0.0))
    ).quaternion


def test_where_pybullet_is_missing_its_files_are_named_as_what_is_missing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, "pybullet_data", None)
    with pytest.raises(InputError, match="pybullet_data is not installed") as said:
        find_urdf("pybullet_data/kuka_iiwa/model.urdf")
    assert "Python 3.11" in said.value.remedy
