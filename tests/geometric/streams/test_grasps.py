"""Grasps hold: pads on opposite faces, the open hand free, within the opening; from above and from the sides."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.collision.fcl_bodies import FclBody, touch
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Hull, Part, Shape, Sphere
from tamp.geometric.stability.ray_crossings import ConvexUnion
from tamp.geometric.streams.grasps import sample_grasps
from tamp.geometric.streams.hand_fit import (
    FRICTION_CONE_RAD,
    HAND_CLEARANCE_M,
    Closed,
    GraspChecker,
)
from tamp.geometric.streams.sampling import sample_grasp
from tamp.geometric.values import Grasp
from tamp.planner.problem import load_problem
from tamp.stream import Call, Rejection
from tamp.system.deadline import Deadline


def body(*parts: Shape | Part, pose: Pose | None = None) -> Body:
    placed = tuple(part if isinstance(part, Part) else Part(part) for part in parts)
    return Body("thing", placed, pose or Pose.from_xyz_yaw(0.3, 0.2, 0.8, 0.7), movable=True)


def wedge_block(size: tuple[float, float, float]) -> Hull:
    """A box as a mesh's piece."""
    corners = np.array(list(itertools.product((-0.5, 0.5), repeat=3))) * size
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    return Hull(corners, faces)


BODIES = {
    "cracker box": body(Box((0.06, 0.16, 0.21))),
    "soup can": body(Cylinder(0.033, 0.102)),
    "tuna can": body(Cylinder(0.042, 0.033)),
    "ball": body(Sphere(0.035)),
    "cube": body(Box((0.05, 0.05, 0.05))),
    "thin plate": body(Box((0.15, 0.15, 0.012))),
    "lying can": body(
        Cylinder(0.033, 0.102), pose=Pose.from_xyz_rpy((0.0, 0.0, 0.8), (math.pi / 2, 0.0, 0.3))
    ),
    "hammer": body(
        Part(wedge_block((0.03, 0.03, 0.15))),
        Part(wedge_block((0.12, 0.03, 0.03)), Pose((0.0, 0.0, 0.09))),
    ),
}


@pytest.fixture(scope="module")
def robot() -> Robot:
    return ROBOTS["panda_mobile"]()


def first(robot: Robot, thing: Body, count: int, seed: int = 0) -> list[Grasp]:
    grasps = (
        one
        for one in sample_grasps(thing, robot, np.random.default_rng(seed))
        if isinstance(one, Grasp)
    )
    return list(itertools.islice(grasps, count))


def hand_hits(
    robot: Robot, thing: Body, T_body_tool: np.ndarray, opening: float, links: slice
) -> bool:
    """Whether links of the hand touch the body, by their own forward kinematics."""
    T_body_hand = T_body_tool @ robot.T_hand_tool.inverse().matrix
    poses = [T_body_hand]
    for finger in robot.fingers:
        T_hand_finger = finger.origin.matrix.copy()
        T_hand_finger[:3, 3] += np.array(finger.axis) * opening / 2
        poses.append(T_body_hand @ T_hand_finger)
    static = FclBody(thing.parts)
    items = [static.place(index, np.eye(4)) for index in range(len(thing.parts))]
    return any(
        touch(FclBody(link.parts).place(0, T), item, 0.0)
        for link, T in list(zip(robot.links[-3:], poses, strict=True))[links]
        for item in items
    )


@pytest.mark.parametrize("name", sorted(BODIES))
def test_grasps_hold(robot: Robot, name: str) -> None:
    thing = BODIES[name]
    grasps = first(robot, thing, 25)
    assert len(grasps) == 25
    for grasp in grasps:
        assert grasp.body == "thing" and 0.0 < grasp.opening <= 0.0765
        T = grasp.T_tool_body.inverse().matrix
        for back in (0.0, 0.01, 0.03, 0.07, 0.1):
            moved = T.copy()
            moved[:3, 3] -= back * T[:3, 2]
            assert not hand_hits(
                robot, thing, moved, robot.opening, slice(0, 3)
            )  # open, here and on its way
        assert not hand_hits(
            robot, thing, T, grasp.opening, slice(0, 3)
        )  # holding does not penetrate
        for finger in (slice(1, 2), slice(2, 3)):
            assert hand_hits(
                robot, thing, T, grasp.opening - 0.002, finger
            )  # and both fingers do touch


@pytest.mark.parametrize("name", sorted(BODIES))
def test_contacts_oppose_each_other(robot: Robot, name: str) -> None:
    thing = BODIES[name]
    solid = ConvexUnion(thing)
    opposed = 0
    for grasp in first(robot, thing, 25):
        T = grasp.T_tool_body.inverse().matrix
        for x, z in itertools.product((-0.006, 0.0, 0.006), repeat=2):
            contact = solid.solid_at(T[:3, 3] + T[:3, :3] @ (x, 0.0, z), T[:3, 1])
            if contact is not None and contact.end - contact.start > grasp.opening - 0.004:
                assert abs(contact.start + contact.end) < 0.004
                opposed += contact.end_normal @ T[:3, 1] > math.cos(
                    FRICTION_CONE_RAD
                ) and -contact.start_normal @ T[:3, 1] > math.cos(FRICTION_CONE_RAD)
    assert opposed >= 25


def test_a_box_is_grasped_from_above_and_from_the_sides(robot: Robot) -> None:
    thing = BODIES["cube"]
    directions = [
        thing.pose.rotation @ grasp.T_tool_body.inverse().rotation[:, 2]
        for grasp in first(robot, thing, 12)
    ]
    heights = np.array(directions)[:, 2]
    assert np.any(heights < -0.99) and np.sum(np.abs(heights) < 0.01) >= 4
    assert np.all(heights < 0.1)  # none of the canonical ones from below
    sides = {
        (round(x), round(y))
        for x, y, z in np.array(directions) @ thing.pose.rotation
        if abs(z) < 0.01
    }
    assert sides == {(1, 0), (-1, 0), (0, 1), (0, -1)}


def test_up_is_the_bodys_present_up(robot: Robot) -> None:
    lying = BODIES["lying can"]
    heights = [
        (lying.pose.rotation @ grasp.T_tool_body.inverse().rotation[:, 2])[2]
        for grasp in first(robot, lying, 12)
    ]
    assert min(heights) < -0.99 and max(heights) < 0.1


def test_slanted_grasps_come_too(robot: Robot) -> None:
    thing = BODIES["cube"]
    heights = [
        (thing.pose.rotation @ grasp.T_tool_body.inverse().rotation[:, 2])[2]
        for grasp in first(robot, thing, 60)
    ]
    for angle in (30, 45, 60):
        assert any(abs(height + math.cos(math.radians(angle))) < 0.01 for height in heights)


def test_the_stream_goes_on_and_differs_by_seed_only(robot: Robot) -> None:
    thing = BODIES["soup can"]
    once, again, other = (
        first(robot, thing, 80),
        first(robot, thing, 80),
        first(robot, thing, 80, seed=1),
    )
    assert once == again and once != other
    assert len(once) == 80 and len(set(once)) == 80


@pytest.mark.parametrize("shape", [Box((0.1, 0.1, 0.1)), Sphere(0.05), Cylinder(0.06, 0.2)])
def test_a_body_that_is_too_wide_has_no_grasp(robot: Robot, shape: Shape) -> None:
    assert first(robot, body(shape), 1) == []


def test_a_thin_body_on_its_support_is_not_grasped_through_it(robot: Robot) -> None:
    """The tips stay inside the body's extent along a canonical approach: what it stands on is right behind."""
    thing = body(Box((0.06, 0.06, 0.02)))
    checked = 0
    for grasp in first(robot, thing, 6):
        T = grasp.T_tool_body.inverse().matrix
        if T[2, 2] < -0.99:
            assert T[2, 3] - 0.009 > -0.01
            checked += 1
    assert checked > 0


@pytest.mark.parametrize(
    ("width", "fits"),
    [(0.074, True), (0.076, True), (0.0785, True), (0.0795, False), (0.09, False)],
)
def test_the_hand_grasps_up_to_its_opening_less_the_clearance(
    robot: Robot, width: float, fits: bool
) -> None:
    grasps = first(robot, body(Box((width, width, 0.12))), 3)
    assert bool(grasps) is fits
    for grasp in grasps:
        assert width <= grasp.opening <= robot.opening - HAND_CLEARANCE_M + 0.002


def test_grasps_near_the_centre_of_mass_come_first(robot: Robot) -> None:
    long = replace(body(Box((0.5, 0.05, 0.06))), mass=1.0)
    aside = [abs(grasp.T_tool_body.inverse().position[0]) for grasp in first(robot, long, 40)]
    assert max(aside[:8]) < 0.03
    assert max(aside) > 0.06  # none is lost
    uneven = replace(long, center_of_mass=(0.1, 0.0, 0.0))
    assert all(
        abs(grasp.T_tool_body.inverse().position[0] - 0.1) < 0.03
        for grasp in first(robot, uneven, 8)
    )


def test_a_tall_panel_is_grasped_aslant_over_its_centre(robot: Robot) -> None:
    """What hangs straight down meets the arm at home; a slanted line through its middle leaves it far aside."""
    panel = body(Box((0.5, 0.07, 0.4)))

    def aslant(grasp: Grasp) -> Rejection | None:
        down = float(grasp.T_tool_body.inverse().rotation[:, 2] @ [0.0, 0.0, -1.0])
        return None if abs(down - math.sqrt(0.5)) < 1e-6 else Rejection("not 45 degrees")

    found = sample_grasps(panel, robot, np.random.default_rng(0), refused=aslant)
    grasp = next(one for one in found if isinstance(one, Grasp))
    assert abs(grasp.T_tool_body.inverse().position[0]) < 0.02


def load(folder: Path, thing: str) -> list[object]:
    """The first answers of the grasp stream about a thing."""
    file = folder / "scene.yaml"
    file.write_text(
        "domain: cupboard\nrobot: {model: panda_mobile, base: [0, 0, 0]}\nroom: {x: [-2, 2], y: [-2, 2]}\n"
        f"bodies:\n  table: {{furniture: table, size: [0.8, 0.6, 0.7], at: [1.2, 0, 0]}}\n  thing: {{{thing}}}\n"
        "goal: (on thing table)\n"
    )
    call = Call(np.random.default_rng(0), Deadline(60.0), ())
    return list(itertools.islice(sample_grasp(load_problem(file).context, "thing", call), 3))


def test_what_is_too_heavy_is_refused_in_words(tmp_path: Path) -> None:
    (said,) = load(tmp_path, "box: [0.05, 0.05, 0.1], on: table, mass: 3.5")
    assert (
        isinstance(said, Rejection) and said.reason == "thing weighs 3.5 kg, the robot lifts 3 kg"
    )
    (said,) = load(tmp_path, "box: [0.05, 0.05, 0.1], on: table, mass: 2.0, friction: 0.1")
    assert isinstance(said, Rejection) and said.given_up
    assert "would slip: with its friction of 0.1 the fingers, at 50 N, hold 1 kg" in said.reason
    assert all(
        isinstance(one, Grasp)
        for one in load(tmp_path, "box: [0.05, 0.05, 0.1], on: table, mass: 2.0")
    )


def test_a_fair_grasp_does_not_wait_for_random_ones(
    robot: Robot, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Neither do firm random ones wait for each other."""
    closed: list[bool] = []
    close = GraspChecker.close

    def counted(fit: GraspChecker, T_body_tool: np.ndarray) -> Closed | None:
        found = close(fit, T_body_tool)
        closed.append(found is not None)
        return found

    monkeypatch.setattr(GraspChecker, "close", counted)
    heavy = replace(body(Box((0.05, 0.06, 0.15))), mass=2.1)
    assert len(first(robot, heavy, 3)) == 3
    assert sum(closed) < 20
    closed.clear()
    ring = [
        Pose.from_xyz_yaw(0.08 * math.cos(a), 0.08 * math.sin(a), 0.0, a)
        for a in np.arange(8) * math.pi / 4
    ]
    hollow = replace(
        body(Box((0.01, 0.07, 0.06))),
        parts=tuple(Part(Box((0.01, 0.07, 0.06)), pose) for pose in ring),
    )
    assert len(first(robot, hollow, 1)) == 1
    assert sum(closed) == 1
