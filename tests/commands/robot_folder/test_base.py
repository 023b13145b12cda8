"""The base under an arm: nothing of the robot reaches into the floor."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from tamp.commands.robot_folder.base import BOX, CLEAR, MOUNT, choose_base
from tamp.errors import InputError
from tamp.geometric.robot.robot import Link
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Part


def standing(*parts: Part, links: int = 1) -> tuple[Any, Link]:
    """What an arm begins with: so many links of the URDF, of these parts."""
    arm = SimpleNamespace(groups=[SimpleNamespace(links=("pelvis",) * links)], T_root_foot=Pose())
    return arm, Link("pelvis", parts)


PELVIS = Part(Box((0.2, 0.3, 0.1)))
LEGS = Part(Box((0.1, 0.2, 0.7)), Pose((0.0, 0.0, -0.4)))


@pytest.mark.parametrize("drive", ["omnidirectional", "differential", "car", "fixed"])
@pytest.mark.parametrize("links", [1, 12])
def test_legs_stand_on_the_floor_and_not_in_it(drive: str, links: int) -> None:
    arm, foot = standing(PELVIS, LEGS, links=links)
    _, T_base_arm, _, _ = choose_base(drive, 0.0, None, arm, foot)
    low, _ = bounds(foot.parts, T_base_arm)
    assert 0.0 < low[2] < 0.03


def test_an_arm_without_legs_is_bolted_to_the_box() -> None:
    box, T_base_arm, velocity, _ = choose_base("differential", 0.0, None, *standing(PELVIS))
    assert T_base_arm == Pose(MOUNT)
    assert box.shape == Box(BOX) and box.pose.position[2] == pytest.approx(CLEAR + BOX[2] / 2)
    assert min(velocity) > 0.1


def test_a_mount_in_the_floor_is_refused_with_the_least_height() -> None:
    with pytest.raises(
        InputError, match=r"pelvis reaches 0.15 m into the floor. Mount it 0.75 m high"
    ):
        choose_base("car", 0.0, (0.0, 0.0, 0.6, 1.0), *standing(PELVIS, LEGS))
    _, T_base_arm, _, _ = choose_base("car", 0.0, (0.0, 0.0, 0.75, 1.0), *standing(PELVIS, LEGS))
    assert T_base_arm.position[2] == pytest.approx(0.75)
