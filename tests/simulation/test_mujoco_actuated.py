"""MuJoCo's robot on motors: what each motor may give, what a bound body does, what stays when bodies come and go."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from types import MappingProxyType

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, RobotStart, Scene
from tamp.simulation.actuation import BASE_FORCE, COMMANDS_PER_SECOND, FINGER_SPEED
from tamp.simulation.mobile_urdf import BASE_JOINTS
from tamp.simulation.mujoco_actuated import ARM_GAINS, BASE_GAINS, STRONG_JOINT_NM, MujocoMotors
from tamp.simulation.mujoco_model import FELT, PASSED
from tests.geometric.making import body, scene

ROBOT = ROBOTS["ur5"]()
CUBE = Box((0.05, 0.04, 0.06))


def place() -> Scene:
    made = scene(
        body("cube", CUBE, (2.0, 2.0, 0.5), friction=0.9), body("far", CUBE, (-2.0, 2.0, 0.03))
    )
    return replace(made, robot=RobotStart("ur5", (0.1, -0.2, 0.3)))


@pytest.fixture
def world() -> Iterator[MujocoMotors]:
    made = MujocoMotors(place(), ROBOT)
    yield made
    made.close()


def run(world: MujocoMotors, seconds: float) -> None:
    for _ in range(round(seconds * COMMANDS_PER_SECOND)):
        world.step_motors()


def test_each_motor_gives_what_its_joint_may(world: MujocoMotors) -> None:
    """The base's force, the arm's efforts, the hand's force for each finger; gains by strength."""
    model = world._model
    forces = {model.actuator(i).name: model.actuator_forcerange[i] for i in range(model.nu)}
    expected = dict.fromkeys(BASE_JOINTS, BASE_FORCE)
    expected |= {one.name: most for one, most in zip(ROBOT.joints, ROBOT.effort, strict=True)}
    expected |= {finger.name: ROBOT.force for finger in ROBOT.fingers}
    assert {name: tuple(pair) for name, pair in forces.items()} == {
        name: (-most, most) for name, most in expected.items()
    }
    assert model.actuator_forcelimited.all()
    gains = {model.actuator(i).name: model.actuator_gainprm[i, 0] for i in range(model.nu)}
    assert {gains[name] for name in BASE_JOINTS} == {BASE_GAINS[0]}
    for joint, effort in zip(ROBOT.joints, ROBOT.effort, strict=True):
        assert gains[joint.name] == ARM_GAINS[effort >= STRONG_JOINT_NM][0]
    pressed = MujocoMotors(place(), ROBOT, force=7.0)._model
    assert pressed.actuator_forcerange[-2:, 1].tolist() == [7.0, 7.0]


def test_it_stands_at_the_start_and_goes_where_it_is_told(world: MujocoMotors) -> None:
    assert world.actual() == pytest.approx([0.1, -0.2, 0.3, *ROBOT.home])
    assert (world.time, world.width()) == (0.0, pytest.approx(ROBOT.opening))
    world.conf[:3] += [0.02, 0.01, -0.05]
    world.conf[5] += 0.1
    run(world, 1.0)
    assert world.actual() == pytest.approx(world.conf, abs=3e-3)
    assert world.time == pytest.approx(1.0)


def test_fingers_go_no_faster_than_they_may(world: MujocoMotors) -> None:
    """Both together twice the speed of one; squeezing on nothing they close, and press on."""
    run(world, 0.1)
    wide = world.width()
    world.squeezing = True
    run(world, 0.2)
    assert wide - world.width() == pytest.approx(2 * FINGER_SPEED * 0.2, rel=0.3)
    run(world, 1.0)
    assert world.width() < 2e-3
    world.squeezing, world.opening = False, 0.04
    run(world, 1.0)
    assert world.width() == pytest.approx(0.04, abs=2e-3)


def test_what_lies_on_the_floor_presses_with_its_weight(world: MujocoMotors) -> None:
    run(world, 1.0)
    weight = place().bodies["far"].mass * 9.81
    assert world.touches()["far", "floor"] == pytest.approx(weight, rel=0.1)
    assert not any(pair[0] in world.robot_links for pair in world.touches())
    assert {link.name for link in ROBOT.links} <= world.robot_links


def test_a_bound_body_keeps_its_place_in_the_hand_and_is_passed_through(
    world: MujocoMotors,
) -> None:
    T_tool_body = Pose((0.01, 0.02, 0.03)).matrix
    world.set_pose("cube", world.tool() @ T_tool_body)
    world.attach("cube")
    assert world.bound == "cube"
    world.conf[2] += 0.3
    run(world, 1.0)
    assert np.linalg.inv(world.tool()) @ world.pose("cube") == pytest.approx(T_tool_body, abs=3e-3)
    world.detach()
    assert world.bound is None
    height = world.pose("cube")[2, 3]
    run(world, 0.3)
    assert height - world.pose("cube")[2, 3] == pytest.approx(9.81 * 0.3**2 / 2, rel=0.2)


def test_whether_robot_and_body_feel_each_other_is_in_their_masks(world: MujocoMotors) -> None:
    """Other bodies still do. Pairs of their own have a margin that no contact is within."""
    model = world._model
    geoms = list(world._geoms[world._numbers["cube"]])
    others = list(world._geoms[world._numbers["far"]])

    def masks(some: list[int]) -> set[tuple[int, int]]:
        return {(int(model.geom_contype[one]), int(model.geom_conaffinity[one])) for one in some}

    assert masks(geoms) == masks(others) == {FELT}
    for passes, mask in ((True, PASSED), (False, FELT), (True, PASSED)):
        world.disable_collision("cube", passes)
        assert (masks(geoms), masks(others)) == ({mask}, {FELT})
        assert len(model.pair_geom1) > 0
        pairs = np.isin(model.pair_geom1, geoms) | np.isin(model.pair_geom2, geoms)
        links = world._is_link[model.pair_geom1] | world._is_link[model.pair_geom2]
        assert np.all(model.pair_margin[pairs & links] == (-1.0 if passes else 0.0))
        assert np.all(model.pair_margin[~(pairs & links)] == 0.0)
        assert (pairs & links).any()

    world.reset_scene(place())  # made anew, it is passed through as before
    model = world._model
    assert masks(list(world._geoms[world._numbers["cube"]])) == {PASSED}


def test_bodies_come_and_go_and_all_else_goes_on_as_it_was(world: MujocoMotors) -> None:
    """Configuration, speeds, what is bound, what is passed through."""
    world.set_pose("cube", world.tool())
    world.attach("cube")
    world.conf[:2] += 0.05
    run(world, 0.1)
    before, moving = world.actual(), world._data.qvel[:3].copy()
    pose = world.pose("cube")
    fresh = body("new", CUBE, (1.5, -1.5, 0.03))
    bodies = {"cube": place().bodies["cube"], "new": fresh}
    world.reset_scene(replace(place(), bodies=MappingProxyType(bodies)))

    assert world.actual() == pytest.approx(before)
    assert world._data.qvel[:3] == pytest.approx(moving)
    assert world.pose("cube") == pytest.approx(pose)
    assert world.pose("new") == pytest.approx(fresh.pose.matrix)
    assert set(world.solids) == {"cube", "new"}
    assert world.bound == "cube"
    at_hand = np.linalg.inv(world.tool()) @ pose
    run(world, 0.5)
    assert np.linalg.inv(world.tool()) @ world.pose("cube") == pytest.approx(at_hand, abs=5e-3)

    world.reset_scene(replace(place(), bodies=MappingProxyType({"new": fresh})))
    assert world.bound is None


def test_a_body_is_between_the_fingers_where_both_are_near(world: MujocoMotors) -> None:
    wide = ROBOT.opening
    y = world.tool()[:3, 1]
    for size, aside, near in (
        (wide - 0.004, 0.0, True),
        (wide - 0.02, 0.0, False),
        (wide - 0.004, 0.3, False),
    ):
        cube = body("cube", Box((0.02, size, 0.02)), (0.0, 0.0, 0.0))
        world.reset_scene(replace(place(), bodies=MappingProxyType({"cube": cube})))
        T = world.tool()
        T[:3, 3] += aside * y
        world.set_pose("cube", T)
        assert world.near_fingers("cube") is near
