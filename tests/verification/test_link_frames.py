"""Frames of the links: those of the engine, computed from measured joints or asked for."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import RobotStart, Room, Scene
from tamp.simulation.engines import open_world
from tamp.verification.link_frames import LinkFrames, base_frames, matrices
from tests.needs import INSTALLED


@pytest.mark.parametrize("engine", INSTALLED)
@pytest.mark.parametrize("name", ROBOTS)
def test_frames_are_the_engines(name: str, engine: str, rng: np.random.Generator) -> None:
    robot = ROBOTS[name]()
    scene = Scene("s", {}, RobotStart(name, (0, 0, 0)), Room((-3, 3), (-3, 3)))
    with open_world(scene, robot, name=engine) as world:
        frames = LinkFrames(world, robot)
        low, high = [-9.0, -9.0, -9.0], [9.0, 9.0, 9.0]
        for arm in robot.arms:
            low, high = [*low, *arm.lower, 0.0], [*high, *arm.upper, arm.opening]
        rows = rng.uniform(low, high, (50, len(low)))
        assert frames.measured
        assert np.abs(frames(rows) - frames.engines(rows)).max() < 1e-5


def test_frames_that_screws_do_not_give_are_asked_of_the_engine(
    rng: np.random.Generator, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As of a finger that its joint moves along an arc."""
    robot = ROBOTS["panda_mobile"]()
    scene = Scene("s", {}, RobotStart("panda_mobile", (0, 0, 0)), Room((-3, 3), (-3, 3)))
    with open_world(scene, robot) as world:
        ask = world.link_frames
        set_robot, last = world.set_robot, [0.0]

        def bent(base: Any, arm: Any, opening: float, number: int = 0) -> None:
            last[0] = opening
            set_robot(base, arm, opening, number)

        def frames() -> Array:
            found = ask()
            found[-1, 2] += last[0] ** 2
            return found

        monkeypatch.setattr(world, "set_robot", bent)
        monkeypatch.setattr(world, "link_frames", frames)
        made = LinkFrames(world, robot)
        rows = rng.uniform(-1.0, 1.0, (5, 11))
        assert not made.measured
        assert np.array_equal(made(rows), made.engines(rows))


def test_a_base_turns_about_the_vertical_where_it_is() -> None:
    (found,) = base_frames(np.array([[1.0, 2.0, math.pi / 2]]))
    assert found @ [0.5, 0.0, 0.3, 1.0] == pytest.approx([1.0, 2.5, 0.3, 1.0])
    rows = np.array([[0.3, -0.2, 0.7], [-1.0, 4.0, -2.5]])
    expected = [Pose.from_xyz_yaw(x, y, 0.0, yaw).matrix for x, y, yaw in rows]
    assert base_frames(rows) == pytest.approx(np.array(expected))


def test_frames_of_positions_and_quaternions() -> None:
    """A third of a turn about the diagonal takes x to y, y to z, z to x."""
    half = 0.5
    (found,) = matrices(np.array([[1.0, 2.0, 3.0, half, half, half, half]]))
    assert found.tolist() == [[0, 0, 1, 1], [1, 0, 0, 2], [0, 1, 0, 3], [0, 0, 0, 1]]
    pose = Pose.from_xyz_rpy((0.1, 0.2, 0.3), (0.4, -0.5, 0.6))
    row = np.array([[*pose.position, *pose.quaternion]])
    assert matrices(row)[0] == pytest.approx(pose.matrix)


class Lever:
    """A world of one link on a slide along x, and one that a hinge of the same joint swings."""

    def __init__(self) -> None:
        self.state = np.zeros(4)
        self.asked = 0

    def set_state(self, row: Array) -> None:
        self.state, self.asked = row, self.asked + 1

    def link_frames(self) -> Array:
        x, y, yaw, q = self.state[:4]
        T_base = Pose.from_xyz_yaw(x, y, 0.0, yaw)
        slid, swung = (
            Pose((0.2 + q, 0.0, 0.5)),
            Pose.from_xyz_yaw(0.1, 0.0, 0.3, q) @ Pose((1, 0, 0)),
        )
        made = [T_base @ one for one in (Pose(), slid, swung)]
        return np.array([[*one.position, *one.quaternion] for one in made])


def test_each_joints_motion_is_measured_once_and_the_engine_asked_no_more() -> None:
    world = Lever()
    frames = LinkFrames.__new__(LinkFrames)
    frames._world = world  # type: ignore[assignment]
    frames._zero_frames = frames._asked(np.zeros(1))
    frames._motions, frames._paths = [], [(), (), ()]
    frames._measure(0, 1)
    assert frames._paths == [(), (0,), (1,)]
    asked = world.asked
    rows = np.array([[1.0, 2.0, 0.5, 0.7], [0.0, 0.0, 0.0, -2.0]])
    computed = frames._computed(rows)
    assert world.asked == asked
    assert computed == pytest.approx(frames.engines(rows), abs=1e-9)
