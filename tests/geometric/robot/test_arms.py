"""Several arms on one body: each moves as a robot to which the others stand still, with what they hold."""

from __future__ import annotations

import dataclasses
import shutil
from pathlib import Path

import numpy as np
import pytest

import tamp
from tamp.errors import InputError
from tamp.geometric.collision.collisions import Collisions
from tamp.geometric.loading.robot_folder import read_robot
from tamp.geometric.loading.robots import ASSETS, ROBOTS
from tamp.geometric.robot.arms import Posture, beside
from tamp.geometric.robot.inverse_kinematics import ArmIK
from tamp.geometric.robot.kinematics import ArmsKinematics, Kinematics, base_matrix
from tamp.geometric.robot.reachability import Reachability
from tamp.geometric.robot.robot import Link, Robot
from tamp.geometric.robot.states import rest_row, with_arm
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Part, RobotStart, Room, Scene
from tamp.simulation.engines import open_world
from tamp.verification.collision_sweep import CollisionFindings, Sweeper
from tests.needs import INSTALLED

TWO = ROBOTS["two_pandas"]()
SCENE = Scene("s", {}, RobotStart("two_pandas", (0.0, 0.0, 0.0)), Room((-3, 3), (-3, 3)))


@pytest.fixture(scope="module")
def into_the_right() -> tuple[float, ...]:
    """The left arm's configuration in which its hand meets the right one's at home."""
    left, right = TWO.arms
    T_base_tool = Kinematics(right).tool(conf(right, right.home)).copy()
    T_base_tool[1, 3] += 0.15
    found = ArmIK(left).solve(T_base_tool)
    assert len(found)
    return tuple(found[0].tolist())


def conf(arm: Robot, joints: tuple[float, ...]) -> np.ndarray:
    return np.array([0.0, 0.0, 0.0, *joints])


def test_all_arms_have_the_links_of_all() -> None:
    left, right = TWO.arms
    assert (left.arm, right.arm) == ("left", "right")
    assert {link.name for link in left.links} == {link.name for link in right.links}
    assert left.still_links.keys() | right.still_links.keys() == {
        link.name for link in TWO.links if link.name != TWO.base
    }


def test_an_arm_that_stands_still_is_where_its_own_kinematics_have_it(
    rng: np.random.Generator,
) -> None:
    for moving, other in (TWO.arms, TWO.arms[::-1]):
        joints = tuple(rng.uniform(other.lower, other.upper).tolist())
        still = beside(TWO.arms, moving.arm, {other.arm: Posture(joints, 0.03)})
        seen = Kinematics(still).link_poses(conf(moving, moving.home), moving.opening)
        own = Kinematics(dataclasses.replace(other, still_links={}))
        wanted = own.link_poses(conf(other, joints), 0.03)
        for name in still.still_links:
            assert seen[name] == pytest.approx(wanted[name], abs=1e-9)


def test_what_another_arm_holds_stands_still_with_it() -> None:
    bar = Link("bar", (Part(Box((0.3, 0.03, 0.03))),))
    T_tool_bar = Pose((0.0, 0.01, 0.02))
    left, right = TWO.arms
    posture = Posture(right.home, 0.03, (bar, T_tool_bar))
    still = beside(TWO.arms, "left", {"right": posture})
    T_tool = Kinematics(right).tool(conf(right, right.home))
    assert still.still_links["bar"].matrix == pytest.approx(T_tool @ T_tool_bar.matrix, abs=1e-9)
    assert still.links[-1] is bar and left.links[-1] is not bar


def test_arms_meet_and_only_where_the_other_stands(into_the_right: tuple[float, ...]) -> None:
    aside = (-1.57, *TWO.home[1:])
    free = []
    for right in (TWO.arms[1].home, aside):
        robot = beside(TWO.arms, "left", {"right": Posture(right, 0.08)})
        arrangement = Collisions(SCENE, robot, Kinematics(robot)).arrangement({})
        assert arrangement.free(conf(robot, robot.home))
        hit = arrangement.hits(conf(robot, into_the_right))
        free.append(hit is None)
        assert hit is None or {name.split("_")[0] for name in hit} == {"left", "right"}
    assert free == [False, True]


@pytest.mark.parametrize("engine", INSTALLED)
def test_the_judge_sees_arms_meet(engine: str, into_the_right: tuple[float, ...]) -> None:
    row = with_arm(TWO, rest_row(TWO), 0, into_the_right, None)
    with open_world(SCENE, TWO, name=engine) as world:
        for state, meets in ((rest_row(TWO), False), (row, True)):
            findings = CollisionFindings()
            Sweeper(world, TWO).sweep(state[None], np.zeros(1), (), findings)
            owners = [{name.split("_")[0] for name in pair} for pair in findings.worst]
            assert ({"left", "right"} in owners) is meets


def test_kinematics_of_all_arms_are_those_of_each(rng: np.random.Generator) -> None:
    row = rest_row(TWO, (0.1, 0.2, 0.3))
    for number, arm in enumerate(TWO.arms):
        row = with_arm(TWO, row, number, rng.uniform(arm.lower, arm.upper).tolist(), 0.02)
    both = ArmsKinematics(TWO)
    poses = both.link_poses(row)
    assert poses.keys() == {link.name for link in TWO.links}
    for number, arm in enumerate(TWO.arms):
        T_world_tool = poses[arm.hand] @ arm.T_hand_tool.matrix
        assert both.tool(row, number) == pytest.approx(T_world_tool, abs=1e-9)


DRIVING = (ASSETS / "two_ur5" / "robot.yaml").read_text(encoding="utf-8")


@pytest.mark.parametrize("yaw", [0.0, np.pi / 2])
@pytest.mark.parametrize("rise", [0.0, 0.25])
def test_an_arm_on_a_base_that_drives_takes_its_own_robots_table_with_its_foot(
    yaw: float, rise: float, tmp_path: Path
) -> None:
    turned = f"quaternion: [0.0, 0.0, {np.sin(yaw / 2)}, {np.cos(yaw / 2)}]"
    text = DRIVING.replace("quaternion: [0.0, 0.0, 0.0, 1.0]", turned)
    text = text.replace("-0.35, 0.35]", f"-0.35, {0.35 + rise}]")
    (tmp_path / "robot.yaml").write_text(text, encoding="utf-8")
    right = read_robot(tmp_path).arms[1]
    assert right.T_base_arm.position[2] == pytest.approx(0.35 + rise)

    T_world_tool = Pose.from_xyz_rpy((0.7, -1.2, 0.9), (np.pi, 0.0, 1.0)).matrix
    bases = Reachability(right).sample(T_world_tool, np.random.default_rng(0), 200)
    ik = ArmIK(right)
    hits = [len(ik.solve(np.linalg.inv(base_matrix(base)) @ T_world_tool, 1)) > 0 for base in bases]
    assert np.mean(hits) >= 0.75

    feet = np.array([(base_matrix(base) @ right.T_base_arm.matrix)[:2, 3] for base in bases])
    ways = T_world_tool[:2, 3] - feet
    facing = np.arctan2(ways[:, 1], ways[:, 0]) - bases[:, 2] - yaw
    assert np.mean(np.cos(facing) > 0.5) > 0.6


@pytest.mark.parametrize("side", [0, 1])
def test_the_table_of_every_arm_is_read_before_planning(side: int, tmp_path: Path) -> None:
    shutil.copytree(ASSETS / "ur5", tmp_path / "mine")
    (tmp_path / "mine" / "reachability.npz").unlink()
    both = tmp_path / "both"
    both.mkdir()
    parts = DRIVING.split("robot: ur5")
    parts[side + 1] = f"robot: ../mine{parts[side + 1]}"
    parts[2 - side] = f"robot: ur5{parts[2 - side]}"
    (both / "robot.yaml").write_text("".join(parts), encoding="utf-8")
    with pytest.raises(InputError, match="reachability table is missing"):
        tamp.load_problem("two_arms_cupboard", robot=both)
