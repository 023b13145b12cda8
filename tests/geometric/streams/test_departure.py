"""The retreat with a body in hand: it may leave what it touches at its first pose, and nothing else."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from tamp.geometric.context import Context
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body, Box, Part, RobotStart, Room, Scene
from tamp.geometric.streams.departure import lift_hits
from tamp.geometric.values import Grasp

SIDE, HEIGHT = 0.04, 0.1
HELD_Z = 0.03
"""Metres that the body's middle is beyond the tool, which points down."""


@pytest.fixture(scope="module")
def robot() -> Robot:
    return ROBOTS["panda_mobile"]()


@pytest.fixture(scope="module")
def start(robot: Robot) -> Pose:
    """Where the body is while the base is at the origin and the arm at home; upright."""
    tool = Kinematics(robot).tool(np.array([0.0, 0.0, 0.0, *robot.home]))
    x, y, z = tool[:3, 3] - [0.0, 0.0, HELD_Z]
    return Pose((float(x), float(y), float(z)))


def near(
    start: Pose, dx: float, dz: float = -0.03, *, movable: bool = False, size: float = SIDE
) -> Body:
    """A low box whose middle is `dx` beside the held body's, its top below the fingers."""
    x, y, z = start.position
    return Body("b", (Part(Box((size, 0.04, 0.04))),), Pose((x + dx, y, z + dz)), movable)


def hit(
    robot: Robot, start: Pose, *bodies: Body, way: tuple[float, ...] = (-0.1,), pose: Pose | None = None,
    others: Mapping[str, Pose] | None = None, padding: float = 0.0,
) -> tuple[str, str] | None:  # fmt: skip
    """Take the body from where the hand is along x, by driving."""
    held = Body("a", (Part(Box((SIDE, SIDE, HEIGHT))),), pose or start, movable=True)
    room = Room((-3.0, 3.0), (-3.0, 3.0))
    scene = Scene(
        "s", {one.name: one for one in (held, *bodies)}, RobotStart("panda_mobile", (0, 0, 0)), room
    )
    T = Kinematics(robot).tool(conf(robot, 0.0))
    grasp = Grasp("a", Pose.from_matrix(np.linalg.inv(T) @ start.matrix), SIDE)
    lift = np.array([conf(robot, x) for x in (0.0, *way)])
    return lift_hits(Context(scene, robot, {}), start, grasp, lift, others, padding)


def conf(robot: Robot, x: float) -> Array:
    return np.array([x, 0.0, 0.0, *robot.home])


TOUCHING = SIDE / 2 + 0.02
"""Between the middles of the held body and of a neighbour of 4 cm."""


@pytest.mark.parametrize("gap", [-0.0003, 0.0, 0.0004])
def test_what_touches_may_be_left_but_not_pushed(robot: Robot, start: Pose, gap: float) -> None:
    fixed = near(start, TOUCHING + gap)
    assert hit(robot, start, fixed) is None
    assert hit(robot, start, fixed, way=(0.1,)) == ("a", "b")


@pytest.mark.parametrize("gap", [-0.0003, 0.0, 0.0004])
def test_so_may_a_body_that_can_move_where_it_stands_at_first(
    robot: Robot, start: Pose, gap: float
) -> None:
    movable = near(start, TOUCHING + gap, movable=True)
    at = {"b": movable.pose}
    assert hit(robot, start, movable, others=at) is None
    assert hit(robot, start, movable, others=at, way=(0.1,)) == ("a", "b")


def test_a_pair_that_does_not_stand_as_at_first_is_left_no_room(robot: Robot, start: Pose) -> None:
    """Placed there by the plan, a body that is in another one by 0.3 mm collides."""
    movable = near(start, TOUCHING - 0.0003, movable=True)
    elsewhere = Pose((0.0, -1.0, 0.5))
    assert hit(robot, start, movable, others={"b": movable.pose}, pose=elsewhere) == ("a", "b")
    away = Body("b", movable.parts, Pose((0.0, -1.0, 0.5)), movable=True)
    assert hit(robot, start, away, others={"b": movable.pose}) == ("a", "b")


def test_it_may_not_come_back_to_what_it_left(robot: Robot, start: Pose) -> None:
    fixed = near(start, TOUCHING)
    assert hit(robot, start, fixed, way=(-0.05, -0.1)) is None
    assert hit(robot, start, fixed, way=(-0.05, 0.0)) == ("a", "b")


def test_a_step_that_goes_right_through_is_seen(robot: Robot, start: Pose) -> None:
    """The ends of the step are both apart from the thin plate, the looks between are not."""
    thin = near(start, SIDE / 2 + 0.0105, size=0.02)
    assert hit(robot, start, thin, way=(0.12,)) == ("a", "b")


def test_the_hand_may_not_meet_what_its_body_leaves(robot: Robot, start: Pose) -> None:
    """The neighbour has a second part that hangs in the hand's way; the body passes below it."""
    one = near(start, -TOUCHING)
    x = TOUCHING + 0.15  # from the neighbour's middle
    hanging = Body(
        "b", (*one.parts, Part(Box((0.04, 0.04, 0.04)), Pose((x, 0.0, 0.17)))), one.pose, False
    )
    assert hit(robot, start, hanging, way=(0.02,)) is None
    found = hit(robot, start, hanging, way=(0.2,))
    assert found is not None
    assert found[0] != "a" and found[1] == "b"


def test_the_fingers_are_as_far_apart_as_they_hold(robot: Robot, start: Pose) -> None:
    """The neighbour has a part 2 cm beside the body at the fingers' height: wide open they would meet it."""
    one = near(start, -TOUCHING)
    post = Part(Box((0.02, 0.01, 0.02)), Pose((TOUCHING, 0.05, 0.03 + HELD_Z)))
    beside = Body("b", (*one.parts, post), one.pose, False)
    assert hit(robot, start, beside, way=(0.01,)) is None


@pytest.mark.parametrize("movable", [False, True])
def test_what_else_is_in_the_way_is_hit(robot: Robot, start: Pose, movable: bool) -> None:
    """With a neighbour that it leaves, and without one."""
    x, y, z = start.position
    c = Body("c", (Part(Box((0.04, 0.04, 0.04))),), Pose((x - 0.1, y, z - 0.03)), movable)
    others = {"c": c.pose} if movable else None
    assert hit(robot, start, c, others=others) == ("a", "c")
    assert hit(robot, start, c, others=others, way=(0.1,)) is None
    beside = near(start, TOUCHING, movable=movable)
    both = None if others is None else {**others, "b": beside.pose}
    assert hit(robot, start, beside, c, others=both) == ("a", "c")
    assert hit(robot, start, beside, c, others=both, way=(-0.05,)) is None


def test_fixed_bodies_are_looked_at_only_where_no_others_are_named(
    robot: Robot, start: Pose
) -> None:
    """A reach was tested against them before: they do not count again with each movable body."""
    x, y, z = start.position
    wall = Body("c", (Part(Box((0.04, 0.04, 0.04))),), Pose((x - 0.1, y, z - 0.03)), False)
    beside = near(start, TOUCHING, movable=True)
    assert hit(robot, start, wall, others={}) is None
    assert hit(robot, start, wall, beside, others={"b": beside.pose}) is None
    assert hit(robot, start, wall) == ("a", "c")


@pytest.mark.parametrize("beside", [False, True])
def test_robot_and_body_keep_a_padding_to_what_they_do_not_touch(
    robot: Robot, start: Pose, beside: bool
) -> None:
    """It ends 3 mm short of the other."""
    x, y, z = start.position
    c = Body("c", (Part(Box((0.04, 0.04, 0.04))),), Pose((x - 0.143, y, z - 0.03)), False)
    bodies = (c, near(start, TOUCHING)) if beside else (c,)
    assert hit(robot, start, *bodies, padding=0.002) is None
    assert hit(robot, start, *bodies, padding=0.004) == ("a", "c")
