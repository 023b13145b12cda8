"""The widest way of the base's disc among walls, against widths that are known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.motion.passage import Gap, Passage
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.scene import Body, Box, Cylinder
from tests.geometric.making import body, scene


@pytest.fixture(scope="module")
def robot() -> Robot:
    return ROBOTS["panda_mobile"]()


def wall(name: str, low: float, high: float, thick: float = 0.1) -> Body:
    """Along y from `low` to `high` at x = 0, 2 m high."""
    return body(name, Box((thick, high - low, 2.0)), (0.0, (low + high) / 2, 1.0), movable=False)


def door(width: float, middle: float = 0.0) -> tuple[Body, Body]:
    """Two walls across a room of 3 m each way that leave a door."""
    return wall("right", -4.0, middle - width / 2), wall("left", middle + width / 2, 4.0)


def behind(robot: Robot, *bodies: Body, half: float = 3.0) -> Gap | None:
    """What keeps the base, 1.5 m before the wall, from a small box 1.5 m behind it."""
    passage = Passage(scene(*bodies, base=(-1.5, 0.0, 0.0), half=half), robot)
    return passage.closed(np.array([1.5, -0.05]), np.array([1.6, 0.05]), 0.5)


def test_the_disc_is_the_largest_in_the_base(robot: Robot) -> None:
    passage = Passage(scene(), robot)
    size = robot.links[0].parts[0].shape.size  # type: ignore[union-attr]
    assert passage.is_mapped and passage.radius <= min(size[:2]) / 2


@pytest.mark.parametrize("middle", [-1.0, 0.0, 0.7])
@pytest.mark.parametrize("share", [0.3, 0.6, 0.9])
def test_a_door_narrower_than_the_base_is_named_with_its_width(
    robot: Robot, share: float, middle: float
) -> None:
    width = share * 2 * Passage(scene(), robot).radius
    gap = behind(robot, *door(width, middle))
    assert gap is not None
    assert gap.width == pytest.approx(width, abs=1e-6)
    assert set(gap.bodies) == {"left", "right"}
    assert abs(gap.place[0]) < 0.1 and abs(gap.place[1] - middle) < width / 2 + 0.03
    assert gap.text == f"the door is {width:.2f} m, the base {gap.base:.2f} m wide"


@pytest.mark.parametrize("share", [1.0, 1.2, 2.0])
def test_a_door_that_the_base_fits_through_closes_nothing(robot: Robot, share: float) -> None:
    assert behind(robot, *door(share * 2 * Passage(scene(), robot).radius)) is None


def test_without_a_door_the_wall_itself_is_in_the_way(robot: Robot) -> None:
    gap = behind(robot, wall("wall", -4.0, 4.0))
    assert gap is not None and gap.width == 0.0
    assert gap.text == "no way leads there: wall in between"


def test_a_wall_that_ends_in_the_room_is_gone_around(robot: Robot) -> None:
    assert behind(robot, wall("wall", -4.0, 1.0)) is None


def test_what_can_be_taken_away_and_what_is_above_the_base_is_no_wall(robot: Robot) -> None:
    across = Box((0.1, 8.0, 2.0))
    assert behind(robot, body("curtain", across, (0.0, 0.0, 1.0), movable=True)) is None
    assert behind(robot, body("beam", across, (0.0, 0.0, 3.0), movable=False)) is None


def test_a_room_too_large_for_fine_cells_is_not_judged(robot: Robot) -> None:
    assert not Passage(scene(half=40.0), robot).is_mapped
    assert behind(robot, wall("wall", -80.0, 80.0), half=40.0) is None


def test_clearance_is_the_distance_from_what_stands_there(robot: Robot) -> None:
    passage = Passage(
        scene(body("post", Cylinder(0.2, 2.0), (0.0, 0.0, 1.0), movable=False)), robot
    )
    points = np.array([[1.0, 0.0], [0.0, -0.7], [0.1, 0.0]])
    assert passage.clearance(points) == pytest.approx(
        [0.8, 0.5, 0.0], abs=0.005
    )  # a prism of 32 sides
    assert np.isinf(Passage(scene(), robot).clearance(points)).all()


def test_narrow_names_the_door_on_the_way_to_a_place(robot: Robot) -> None:
    width = 1.1 * 2 * Passage(scene(), robot).radius
    passage = Passage(scene(*door(width), base=(-1.5, 0.0, 0.0)), robot)
    gap = passage.narrow(np.array([2.0, 0.0]))
    assert gap is not None and gap.width == pytest.approx(width, abs=1e-6)
    assert passage.narrow(np.array([-2.0, 0.0])) is None  # on this side nothing is narrow
    wide = Passage(scene(*door(2 * width), base=(-1.5, 0.0, 0.0)), robot)
    assert wide.narrow(np.array([2.0, 0.0])) is None


def test_open_ways_are_straight_or_with_one_bend(robot: Robot) -> None:
    free = Passage(scene(base=(-1.5, 0.0, 0.0)), robot)
    assert free.open_towards(np.array([2.0, 1.0]), 0.5)
    blocked = Passage(scene(wall("wall", -4.0, 4.0), base=(-1.5, 0.0, 0.0)), robot)
    assert not blocked.open_towards(np.array([2.0, 1.0]), 0.5)
    around = Passage(scene(wall("wall", -0.15, 0.15), base=(-1.5, 0.0, 0.0)), robot)
    assert around.open_towards(np.array([1.5, 0.0]), 0.5)
    # What the hand reaches over the wall need not be driven to.
    assert blocked.open_towards(np.array([0.3, 0.0]), 2.0) and math.isfinite(blocked.slack)
