"""The robot on motors."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from types import MappingProxyType

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.scene.pose import Pose, pose_difference
from tamp.geometric.scene.scene import Body, Box, Part, RobotStart, Room, Scene
from tamp.simulation.actuation import COMMANDS_PER_SECOND, MotorSimulation
from tamp.simulation.engines import open_actuated
from tests.needs import INSTALLED

ROBOT = ROBOTS["panda_mobile"]()
HELD = Body("held", (Part(Box((0.05, 0.04, 0.06))),), Pose(), True, mass=0.3)
AWAY = Body("away", (Part(Box((0.1, 0.1, 0.1))),), Pose((2.0, 2.0, 0.05)), True)
SCENE = Scene(
    "one",
    {"held": HELD, "away": AWAY},
    RobotStart("panda_mobile", (0.0, 0.0, 0.0)),
    Room((-3, 3), (-3, 3)),
)


@pytest.fixture(params=INSTALLED)
def world(request: pytest.FixtureRequest) -> Iterator[MotorSimulation]:
    with open_actuated(SCENE, ROBOT, name=request.param) as made:
        made.set_pose("held", made.tool())
        yield made


def test_the_robot_stands_where_the_planner_has_it(world: MotorSimulation) -> None:
    assert world.tool() == pytest.approx(Kinematics(ROBOT).tool(world.conf), abs=1e-5)
    assert world.width() == pytest.approx(0.08)


def test_friction_holds_and_letting_go_drops(world: MotorSimulation) -> None:
    world.squeezing = True
    for _ in range(COMMANDS_PER_SECOND // 2):
        world.set_pose("held", world.tool())  # until the fingers have closed
        world.step_motors()
    world.conf[:3] = [0.05, 0.0, 0.1]
    world.wait(1.0)
    assert world.near_fingers("held")
    assert np.linalg.norm(world.pose("held")[:3, 3] - world.tool()[:3, 3]) < 0.005
    assert {second for first, second in world.touches() if first in world.finger_links} == {"held"}
    assert np.abs(world.actual() - world.conf).max() < 2e-3
    world.squeezing = False
    world.wait(1.0)
    assert world.pose("held")[2, 3] < 0.6 and not world.near_fingers("held")


def test_a_bound_body_follows_the_hand_until_unbound(world: MotorSimulation) -> None:
    world.attach("held")
    T = np.linalg.inv(world.tool()) @ world.pose("held")
    world.conf[:3] = [0.1, 0.1, 0.5]
    world.wait(1.0)
    assert np.linalg.inv(world.tool()) @ world.pose("held") == pytest.approx(T, abs=2e-3)
    world.detach()
    world.disable_collision("held", False)
    world.wait(1.0)
    assert world.pose("held")[2, 3] < 0.6


def test_bodies_come_and_go(world: MotorSimulation) -> None:
    wall = replace(AWAY, name="wall", movable=False, pose=Pose((2.0, 2.0, 0.149)))
    world.reset_scene(replace(SCENE, bodies=MappingProxyType({"away": AWAY, "wall": wall})))
    world.wait(0.1)
    assert ("away", "wall") in world.touches()
    assert "held" not in world.solids


def test_what_lies_still_wakes_when_it_is_pushed(world: MotorSimulation) -> None:
    world.wait(4.0)
    world.set_pose("held", Pose((2.0, 2.0, 0.4)).matrix)
    world.wait(1.0)
    assert ("away", "held") in world.touches()


def held_off_centre(world: MotorSimulation) -> np.ndarray:
    """The hand presses on the bar 6 cm beside its middle; T_tool_body."""
    world.squeezing = True
    off = np.eye(4)
    off[:3, 3] = [0.06, 0.0, 0.01]
    for _ in range(COMMANDS_PER_SECOND // 2):
        world.set_pose("bar", world.tool() @ off)
        world.step_motors()
    world.wait(0.2)
    return np.linalg.inv(world.tool()) @ world.pose("bar")


def turned(world: MotorSimulation, angle: float, seconds: float) -> None:
    """The base turns by this in this time, slowly at first and at last."""
    count, rate = round(seconds * COMMANDS_PER_SECOND), 0.0
    for step in range(count):
        rate = angle / seconds * (1 - np.cos(2 * np.pi * (step + 1) / count))
        world.conf[2] += rate / COMMANDS_PER_SECOND
        world.step_motors([0.0, 0.0, rate, *[0.0] * 7])


@pytest.fixture(params=INSTALLED)
def off_centre(request: pytest.FixtureRequest) -> Iterator[MotorSimulation]:
    bar = Body("bar", (Part(Box((0.2, 0.07, 0.04))),), Pose((0.0, 2.0, 0.5)), True, mass=0.3)
    with open_actuated(replace(SCENE, bodies={"bar": bar}), ROBOT, name=request.param) as made:
        yield made


def test_what_is_held_off_its_centre_does_not_creep_while_the_base_turns(
    off_centre: MotorSimulation,
) -> None:
    T = held_off_centre(off_centre)
    for angle in (2.0, -2.0, 2.0):
        turned(off_centre, angle, 3.0)
        moved, angle = pose_difference(T, np.linalg.inv(off_centre.tool()) @ off_centre.pose("bar"))
        # MuJoCo's friction knows speeds only: on a circle a body drifts outwards by w^2 r dt / 2 a second.
        assert moved < (0.004 if type(off_centre).__name__ == "MujocoMotors" else 0.002)
        assert angle < np.radians(2)


def test_a_hand_that_has_turned_lets_go_at_once(off_centre: MotorSimulation) -> None:
    held_off_centre(off_centre)
    turned(off_centre, 2.0, 3.0)
    before = off_centre.pose("bar")[:3, 3]
    off_centre.squeezing = False
    off_centre.wait(0.2)
    moved = off_centre.pose("bar")[:3, 3] - before
    assert np.linalg.norm(moved[:2]) < 5e-4  # no finger draws it along
    assert moved[2] < -0.15
