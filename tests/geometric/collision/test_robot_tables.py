"""The robot's rows for the kernels: where each part is, which pairs are looked at, what a held body adds."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from tamp.geometric.collision.robot_tables import RobotParts, RobotTables
from tamp.geometric.collision.tables import FRAME, ON_FLOOR, PART_COLUMNS, TableRows
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.arms import beside
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Box, Cylinder, Part

NAMES = ["panda_mobile", "ur5_suction", "pr2"]
T_TOOL_HELD = Pose.from_xyz_yaw(0.02, -0.01, 0.04, 0.7)
HELD = (Part(Box((0.05, 0.06, 0.07)), Pose((0.0, 0.01, 0.0))), Part(Cylinder(0.02, 0.1)))


def made(robot: Robot, opening: float, held: bool = False) -> tuple[RobotTables, RobotParts]:
    collected = TableRows()
    tables = RobotTables(robot, collected)
    parts = HELD if held else ()
    rows = np.array([collected.row(part) for part in parts]).reshape(-1, PART_COLUMNS)
    matrices = np.array([(T_TOOL_HELD @ part.pose).matrix for part in parts]).reshape(-1, 4, 4)
    return tables, tables.complete(opening, "thing" if held else None, matrices, rows)


def matrix(row: Array) -> Array:
    """A row of nine entries of a rotation and three of a translation as a matrix (4, 4)."""
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = row[:9].reshape(3, 3), row[9:12]
    return T


def frames(tables: RobotTables, conf: Array) -> list[Array]:
    """The base's frame and those of the joints, by the table of joints; a turn about z written out."""
    x, y, yaw = conf[:3]
    found = [Pose.from_xyz_yaw(x, y, 0.0, yaw).matrix]
    for joint, q in zip(tables.joints, conf[3:], strict=True):
        slide = Pose((0.0, 0.0, q)) if joint[12] else Pose.from_xyz_yaw(0.0, 0.0, 0.0, q)
        found.append(found[-1] @ matrix(joint) @ slide.matrix)
    return found


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("share", [0.0, 1.0])
def test_every_part_is_where_the_kinematics_have_its_link(name: str, share: float) -> None:
    robot = ROBOTS[name]()
    opening = share * robot.opening
    tables, found = made(robot, opening, held=True)
    conf = np.array([0.3, -0.5, 1.1, *np.random.default_rng(1).uniform(robot.lower, robot.upper)])
    kinematics, at = Kinematics(robot), frames(tables, conf)
    poses = kinematics.link_poses(conf, opening)
    assert len(found.rows) == len(found.poses) == len(found.owners)

    for (link, k), row, pose in zip(found.owners, found.rows, found.poses, strict=True):
        if link == "thing":
            expected = kinematics.tool(conf) @ T_TOOL_HELD.matrix @ HELD[k].pose.matrix
        else:
            expected = poses[link] @ robot.link(link).parts[k].pose.matrix
        assert at[int(row[FRAME])] @ matrix(pose) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_what_stands_on_the_floor_is_what_no_joint_moves(name: str) -> None:
    robot = ROBOTS[name]()
    _, found = made(robot, 0.0, held=True)
    on_floor = {
        link for (link, _), row in zip(found.owners, found.rows, strict=True) if row[ON_FLOOR]
    }
    assert on_floor == {robot.base, robot.foot} & {link.name for link in robot.links if link.parts}


def named(found: RobotParts) -> set[frozenset[str]]:
    return {frozenset(found.owners[int(k)][0] for k in pair) for pair in found.pairs}


def test_all_pairs_but_the_allowed_ones_are_looked_at_once() -> None:
    robot = ROBOTS["panda_mobile"]()
    _, found = made(robot, 0.04)
    links = [link.name for link in robot.links if link.parts]
    expected = {frozenset(pair) for pair in itertools.combinations(links, 2)}
    expected -= {frozenset(pair) for pair in robot.allowed}
    assert named(found) == expected
    assert len({tuple(pair) for pair in found.pairs}) == len(found.pairs)
    count = sum(
        len(robot.link(a).parts) * len(robot.link(b).parts) for a, b in map(sorted, expected)
    )
    assert len(found.pairs) == count


def test_a_held_body_is_looked_at_with_all_but_the_hand_that_holds_it() -> None:
    robot = ROBOTS["panda_mobile"]()
    _, empty = made(robot, 0.04)
    _, found = made(robot, 0.04, held=True)
    assert found.owners[-2:] == (("thing", 0), ("thing", 1))
    others = {frozenset(("thing", link.name)) for link in robot.links if link.parts}
    hand = {frozenset(("thing", name)) for name in robot.grippers}
    assert named(found) - named(empty) == others - hand
    beside_hand = [owner for owner in empty.owners if owner[0] not in robot.grippers]
    assert len(found.pairs) - len(empty.pairs) == 2 * len(beside_hand)


def test_links_of_an_arm_that_stands_still_are_not_looked_at_among_themselves() -> None:
    """Nor with the base and the foot, which they never move against; with the moving arm they are."""
    both = ROBOTS["two_pandas"]()
    robot = beside(both.arms, both.arm, {})
    _, found = made(robot, 0.0)
    still = set(robot.still_links)
    assert still
    assert not any(
        pair <= still | {robot.base, robot.foot} for pair in named(found) if pair & still
    )
    assert any(len(pair & still) == 1 for pair in named(found))
    moved = {joint.child for joint in robot.joints} | robot.grippers
    for pair in named(found):
        if pair & still:
            assert pair & moved


def test_each_finger_goes_half_the_opening_along_its_own_axis() -> None:
    robot = ROBOTS["panda_mobile"]()
    (_, shut), (_, wide) = made(robot, 0.0), made(robot, 0.06)
    for (link, _), before, after in zip(shut.owners, shut.poses, wide.poses, strict=True):
        moved = np.linalg.norm(after[9:] - before[9:])
        assert moved == pytest.approx(0.03 if link in {f.child for f in robot.fingers} else 0.0)
