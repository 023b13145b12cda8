"""Hands by themselves, where nothing else is: what they hold, and what they would meet."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.states import rest_row
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Box, Hull
from tamp.simulation.engines import open_world
from tamp.simulation.world import World
from tamp.verification.collision_sweep import Sweeper
from tamp.verification.hands import Hands
from tests.geometric.making import body, scene

TWO = ROBOTS["two_pandas"]()
SIDE = 0.04
TOOL = Pose.from_xyz_rpy((0.6, 0.2, 0.7), (np.pi, 0.3, 0.5)).matrix
"""Where a hand is asked about; its z is along the fingers, y the closing direction."""


@pytest.fixture(scope="module")
def world() -> Iterator[World]:
    """A cube to hold, and a block that stands in the way of no robot."""
    cube = body("cube", Box((SIDE, SIDE, SIDE)), (1.0, 1.0, 0.02))
    block = body("block", Box((0.1, 0.1, 0.1)), (-1.0, 1.0, 0.05), movable=False)
    with open_world(scene(cube, block, half=5.0), TWO) as made:
        yield made


@pytest.fixture
def hands(world: World) -> Iterator[Hands]:
    before = {name: world.pose(name) for name in ("cube", "block")}
    yield Hands(world, TWO, Sweeper(world, TWO))
    assert all(np.allclose(world.pose(name), T, atol=1e-12) for name, T in before.items())


def at(x: float, y: float, z: float) -> Array:
    return Pose((x, y, z)).matrix


@pytest.mark.parametrize("arm", [0, 1])
def test_either_hand_holds_what_fits_between_its_pads(hands: Hands, arm: int) -> None:
    grasp = at(0.0, 0.0, 0.0)
    assert hands.why_not_held("cube", grasp, SIDE, arm) is None
    assert "off it" in (hands.why_not_held("cube", grasp, SIDE + 0.02, arm) or "")
    assert "in it" in (hands.why_not_held("cube", grasp, SIDE - 0.01, arm) or "")
    beside = hands.why_not_held("cube", at(SIDE / 2 + 0.0095, 0.0, 0.0), SIDE, arm)
    assert beside == "it is not between the fingers' pads"


def test_a_hand_does_not_hold_with_fingers_that_open_wider_than_they_can(hands: Hands) -> None:
    assert "cannot open" in (hands.why_not_held("cube", at(0.0, 0.0, 0.0), 0.1) or "")


def meets(
    world: World, hands: Hands, T_tool_body: Array, *, name: str = "block", arm: int = 0
) -> str | None:
    """What an arm's open hand at `TOOL` meets of a body, which is put there for so long."""
    before = world.pose(name)
    world.place(name, TOOL @ T_tool_body)
    there = world.pose(name)
    said = hands.meets(name, TOOL, arm)
    assert np.allclose(world.pose(name), there, atol=1e-12)
    world.place(name, before)
    return said


def tip() -> float:
    """How far the fingers reach beyond the tool's origin, metres, by the robot's own hulls."""
    (link, _), (finger, _) = TWO.finger_links, TWO.fingers
    (hull,) = (part.shape for part in link.parts)
    assert isinstance(hull, Hull)
    return finger.origin.position[2] + hull.vertices[:, 2].max() - TWO.T_hand_tool.position[2]


@pytest.mark.parametrize("arm", [0, 1])
def test_the_tips_of_an_open_hand_meet_what_is_before_them(
    world: World, hands: Hands, arm: int
) -> None:
    touching = tip() + 0.05  # of the block's middle
    assert meets(world, hands, at(0.0, 0.0, touching + 0.002), arm=arm) is None
    assert meets(world, hands, at(0.0, 0.0, touching - 0.0008), arm=arm) is None
    said = meets(world, hands, at(0.0, 0.0, touching - 0.004), arm=arm)
    assert said == "the hand is 4.0 mm in block"


def test_the_palm_meets_what_the_fingers_go_around(world: World, hands: Hands) -> None:
    assert meets(world, hands, at(0.0, 0.0, 0.0), name="cube") is None
    said = meets(world, hands, at(0.0, 0.0, -0.06), name="cube")
    assert said is not None and said.endswith("mm in cube")


def test_a_body_far_from_the_hand_is_not_met_wherever_the_robot_is(
    world: World, hands: Hands
) -> None:
    assert meets(world, hands, at(0.0, 0.0, 0.5)) is None
    world.set_state(rest_row(TWO, (*TOOL[:2, 3], 0.0)))
    assert meets(world, hands, at(0.0, 0.0, 0.12)) is None
