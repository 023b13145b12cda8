"""MuJoCo's world: where things are, how far apart, what a ray meets, what falls; against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Part, RobotStart, Room, Scene, Sphere
from tamp.simulation.mujoco_world import MujocoWorld
from tests.geometric.making import cuboid, hull

TURNED = Pose.from_xyz_yaw(1.0, 0.5, 0.8, 0.6)


def world(*bodies: Body, dynamic: bool = False) -> MujocoWorld:
    scene = Scene(
        "s", {one.name: one for one in bodies}, RobotStart("", (0.0, 0.0, 0.0)),
        Room((-3.0, 3.0), (-3.0, 3.0)),
    )  # fmt: skip
    return MujocoWorld(scene, dynamic=dynamic)


def ball(name: str, x: float, y: float = 0.0, z: float = 1.0, *, movable: bool = True) -> Body:
    return Body(name, (Part(Sphere(0.1)),), Pose((x, y, z)), movable)


WEDGE = Body(
    "wedge",
    (
        Part(hull(cuboid((0.2, 0.1, 0.4)) + np.array([0.3, 0.0, 0.0]))),
        Part(Cylinder(0.05, 0.2), Pose((0.0, 0.0, 0.5))),
    ),
    TURNED,
    movable=False,
)


@pytest.mark.parametrize("dynamic", [False, True])
def test_bodies_are_where_the_scene_has_them_and_where_they_are_put(dynamic: bool) -> None:
    made = world(ball("a", 0.0), WEDGE, dynamic=dynamic)
    assert made.pose("wedge") == pytest.approx(TURNED.matrix, abs=1e-9)
    there = Pose.from_xyz_rpy((0.3, -0.2, 1.4), (0.4, -0.5, 2.0)).matrix
    made.place("a", there)
    assert made.pose("a") == pytest.approx(there, abs=1e-9)


@pytest.mark.parametrize(
    ("x", "reach", "distance"),
    [
        (0.205, 0.02, 0.005), (0.215, 0.02, 0.015), (0.195, 0.02, -0.005),
        (0.225, 0.02, math.inf), (0.225, 0.03, 0.025), (0.5, 0.02, math.inf),
    ],
)  # fmt: skip
@pytest.mark.parametrize("dynamic", [False, True])
def test_distances_of_balls(dynamic: bool, x: float, reach: float, distance: float) -> None:
    """Between their middles less both radii; infinite past the reach; after they were put there."""
    made = world(ball("a", 0.0), ball("b", 1.5), dynamic=dynamic)
    made.place("b", Pose((x, 0.0, 1.0)).matrix)
    assert made.body_distance("a", "b", reach) == pytest.approx(distance, abs=1e-6)


def test_the_nearest_of_all_parts_counts() -> None:
    """The wedge's parts end at (0.2 to 0.4, +-0.05, +-0.2) and at height 0.4 to 0.6 of its frame."""
    made = world(ball("a", 0.0), WEDGE)
    for local, distance in (
        ((0.3, 0.16, 0.0), 0.01), ((0.3, 0.0, 0.307), 0.007), ((0.0, 0.0, 0.705), 0.005),
        ((0.0, 0.155, 0.5), 0.005),
    ):  # fmt: skip
        made.place("a", TURNED.matrix @ Pose(local).matrix)
        assert made.body_distance("a", "wedge", 0.02) == pytest.approx(distance, abs=1e-4)


@pytest.mark.parametrize("order", [1, -1])
def test_the_nearest_counts_whichever_part_it_is(order: int) -> None:
    parts = (Part(Sphere(0.1)), Part(Sphere(0.1), Pose((0.0, 0.41, 0.0))))[::order]
    two = Body("two", parts, Pose((0.205, 0.0, 1.0)), movable=True)
    made = world(
        Body("bar", (Part(Box((0.2, 2.0, 0.2))),), Pose((0.0, 0.0, 1.0)), False), two, dynamic=True
    )
    two_at = Pose.from_xyz_yaw(0.205, 0.0, 1.0, -0.02)  # the second is 8 mm farther away
    made.place("two", two_at.matrix)
    assert made.body_distance("bar", "two", 0.02) == pytest.approx(0.005, abs=1e-4)


def test_each_solid_has_the_box_around_it_in_its_bodys_frame() -> None:
    """A fixed body has one for each part, one that can move in a world with physics a single one."""
    made = world(WEDGE)
    first, second = made.solids["wedge"]
    assert (first.centre, first.half) == (
        pytest.approx([0.3, 0.0, 0.0], abs=1e-6), pytest.approx([0.1, 0.05, 0.2], abs=1e-6),
    )  # fmt: skip
    assert (second.centre, second.half) == (
        pytest.approx([0.0, 0.0, 0.5], abs=1e-6), pytest.approx([0.05, 0.05, 0.1], abs=1e-6),
    )  # fmt: skip
    corners = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.05, 0.0], [0.0, 0.0, 0.3]])
    slanted = Body("slanted", (Part(hull(corners)),), Pose(), movable=False)
    (own,) = world(slanted).solids["slanted"]
    assert (own.centre, own.half) == (pytest.approx([0.05, 0.025, 0.15], abs=1e-6),) * 2
    aside = Part(WEDGE.parts[0].shape, Pose.from_xyz_yaw(0.0, 0.0, 0.0, math.pi / 2))
    (turned,) = world(Body("aside", (aside,), Pose(), movable=False)).solids["aside"]
    assert turned.centre == pytest.approx([0.0, 0.3, 0.0], abs=1e-6)
    free = Body("wedge", WEDGE.parts, TURNED, movable=True)
    (whole,) = world(free, dynamic=True).solids["wedge"]
    assert whole.centre == pytest.approx([0.175, 0.0, 0.2], abs=1e-6)
    assert whole.half == pytest.approx([0.225, 0.05, 0.4], abs=1e-6)


def test_a_solid_is_measured_by_itself() -> None:
    made = world(ball("a", 0.0), WEDGE)
    first, second = made.solids["wedge"]
    (own,) = made.solids["a"]
    made.place("a", TURNED.matrix @ Pose((0.3, 0.16, 0.0)).matrix)
    assert made.distance(own, first, 0.05) == pytest.approx(0.01, abs=1e-4)
    assert made.distance(own, second, 0.05) == math.inf


def test_rays_name_what_they_meet_first_and_how_far_along() -> None:
    made = world(
        ball("a", 0.0),
        ball("b", 1.0),
        Body("box", (Part(Box((0.2, 0.2, 0.2))),), Pose((0.0, 2.0, 1.0)), False),
    )
    starts = np.array(
        [[-1.1, 0.0, 1.0], [2.0, 0.0, 1.0], [-1.1, 0.5, 1.0], [0.0, 1.0, 1.0], [-1.1, 0.0, 1.0]]
    )
    ends = np.array(
        [[0.9, 0.0, 1.0], [0.0, 0.0, 1.0], [0.9, 0.5, 1.0], [0.0, 3.0, 1.0], [-0.2, 0.0, 1.0]]
    )
    hits = made.rays(starts, ends)
    assert [name for name, _ in hits] == ["a", "b", None, "box", None]
    assert [share for _, share in hits] == pytest.approx([0.5, 0.45, 1.0, 0.45, 1.0])


def test_a_ray_that_begins_within_something_meets_it_at_once() -> None:
    made = world(ball("a", 0.0), ball("b", 1.0))
    starts = np.array([[0.02, 0.0, 1.0]] * 2)
    hits = made.rays(starts, np.array([[1.0, 0.0, 1.0], [0.05, 0.0, 1.0]]))
    assert hits == [("a", 0.0), ("a", 0.0)]


@pytest.mark.parametrize("dynamic", [False, True])
def test_the_floor_ends_at_zero(dynamic: bool) -> None:
    made = world(ball("a", 0.0), dynamic=dynamic)
    ((name, share),) = made.rays(np.array([[0.5, 0.5, 1.0]]), np.array([[0.5, 0.5, -1.0]]))
    assert name == "floor" and share == pytest.approx(0.5)


def test_a_body_falls_and_one_that_is_put_somewhere_is_at_rest() -> None:
    made = world(ball("a", 0.0, z=2.0), ball("fixed", 1.0, z=2.0, movable=False), dynamic=True)
    made.step(0.3)
    assert 2.0 - made.pose("a")[2, 3] == pytest.approx(9.81 * 0.3**2 / 2, rel=0.02)
    speed, spin = made.speed("a")
    assert (speed, spin) == (pytest.approx(9.81 * 0.3, rel=0.01), pytest.approx(0.0, abs=1e-6))
    assert made.pose("fixed")[2, 3] == 2.0
    made.place("a", Pose((0.0, 0.0, 1.0)).matrix)
    assert made.speed("a") == (0.0, 0.0)


def test_what_falls_comes_to_rest_on_the_floor() -> None:
    made = world(ball("a", 0.0, z=0.12), dynamic=True)
    made.step(1.0)
    assert made.pose("a")[2, 3] == pytest.approx(0.1, abs=1e-3)
    assert made.distance(made.solids["a"][0], made.floor) == pytest.approx(0.0, abs=1e-3)


def test_links_are_where_the_kinematics_have_them() -> None:
    robot = ROBOTS["ur5"]()
    scene = Scene("s", {}, RobotStart("ur5", (0.3, 0.2, 0.5)), Room((-3.0, 3.0), (-3.0, 3.0)))
    made, kinematics = MujocoWorld(scene, robot), Kinematics(robot)
    arm = np.random.default_rng(0).uniform(robot.lower, robot.upper)
    for base, joints in (((0.3, 0.2, 0.5), robot.home), ((-0.4, 0.1, 2.0), arm)):
        if joints is arm:
            made.set_robot(base, joints, 0.04)
        opening = 0.04 if joints is arm else robot.opening
        poses = kinematics.link_poses(np.array([*base, *joints]), opening)
        for name, row in zip(made.links, made.link_frames(), strict=True):
            x, y, z, a, b, c, d = (float(value) for value in row)
            found = Pose((x, y, z), (a, b, c, d)).matrix
            assert found == pytest.approx(poses[name], abs=1e-6), name
