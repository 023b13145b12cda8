"""A robot is refused where a second opinion differs: on its frames, its home, its reach."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tamp.commands.robot_folder import check
from tamp.commands.robot_folder.arm import find_arm
from tamp.commands.robot_folder.check import (
    OFF,
    against_physics,
    against_urdf,
    check_home,
    check_reach,
    solved,
)
from tamp.commands.robot_folder.description import Description
from tamp.errors import InputError
from tamp.geometric.loading.robot_folder import read_robot
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.pose import Array, Pose

PANDA = ROBOTS["panda_fixed"]()


def moved(origin: Pose, by: float) -> Pose:
    x, y, z = origin.position
    return Pose((x, y, z + by), origin.quaternion)


def test_the_tip_is_held_against_pinocchios(
    described: Callable[..., Description], bolted: Path
) -> None:
    robot, description = read_robot(bolted), described("")
    arm = find_arm(description, "foot", "tool", {})
    assert against_urdf(robot, description, arm, "tool") < OFF / 10
    off = replace(arm, T_last_tip=moved(arm.T_last_tip, 2 * OFF))
    with pytest.raises(InputError, match=r"kinematics of the arm differ by 0.001 from pinocchio's"):
        against_urdf(robot, description, off, "tool")


def test_all_frames_are_held_against_the_engines(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(check, "STATES", 3)
    assert against_physics(PANDA) < 1e-5

    class Off(check.ArmsKinematics):
        def link_poses(self, row: Array) -> dict[str, Array]:
            poses = {name: np.array(T) for name, T in super().link_poses(row).items()}
            poses[PANDA.hand][2, 3] += 0.003
            return poses

    monkeypatch.setattr(check, "ArmsKinematics", Off)
    with pytest.raises(InputError, match=r"our kinematics differ by 0.003 from"):
        against_physics(PANDA)


def test_the_share_of_poses_that_are_solved_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    class EveryFourth:
        asked = 0

        def __init__(self, robot: object) -> None: ...

        def solve(self, T: Array, enough: int) -> list[int]:
            EveryFourth.asked += 1
            return [1] * (EveryFourth.asked % 4 == 0)

    monkeypatch.setattr(check, "POSES", 20)
    assert solved(PANDA) == 1.0
    monkeypatch.setattr(check, "ArmIK", EveryFourth)
    assert solved(PANDA) == 0.25


def test_a_robot_that_meets_itself_at_home_is_refused() -> None:
    check_home(PANDA)
    lower, home = PANDA.lower, list(PANDA.home)
    home[1], home[3] = PANDA.upper[1], lower[3]  # shoulder forward and elbow closed: into the foot
    with pytest.raises(InputError, match=r"at home \w+ and \w+ meet"):
        check_home(replace(PANDA, home=tuple(home)))


HEIGHTS = np.array([0.0, 0.7, 1.2, 1.3])


@pytest.mark.parametrize(
    ("counts", "said"),
    [
        ([1, 0, 0, 0], None),
        ([0, 0, 1, 0], None),  # half a metre above a table at most
        ([0, 0, 0, 5], "reaches nothing under 1.30 m: neither the floor nor any table"),
        ([0, 0, 0, 0], "reaches nothing: neither the floor nor any table"),
    ],
)
def test_an_arm_that_reaches_neither_floor_nor_table_is_refused(
    counts: list[int], said: str | None
) -> None:
    table = np.zeros((4, 2, 3), dtype=np.uint8)
    table[:, 1, 2] = counts
    if said is None:
        check_reach(table, HEIGHTS, PANDA)
        return
    with pytest.raises(InputError, match=said):
        check_reach(table, HEIGHTS, PANDA)
