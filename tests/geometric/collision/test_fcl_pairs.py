"""Exact answers about one pair of an arrangement: which two parts a number stands for, and where they are."""

from __future__ import annotations

import numpy as np
import pytest

from tamp.geometric.collision.fcl_bodies import FclBody
from tamp.geometric.collision.fcl_pairs import FLOOR_PART, ExactPairs
from tamp.geometric.collision.kernels import FLOOR, ROOM, SELF
from tamp.geometric.collision.robot_tables import RobotParts
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Box, Part, Sphere

OPENING = 0.04


class Slider:
    """Kinematics of a hand at (x, y, 1) over a foot at the origin; the tool is 0.5 below the hand."""

    def link_poses(self, conf: Array, opening: float) -> dict[str, Array]:
        assert opening == OPENING
        return {"foot": np.eye(4), "hand": Pose((conf[0], conf[1], 1.0)).matrix}

    def tool(self, conf: Array) -> Array:
        return Pose((conf[0], conf[1], 0.5)).matrix


def cubes(*xs: float) -> FclBody:
    """Cubes of 0.2 m at heights 1 and 1.5 above places along x, in the body's frame."""
    return FclBody(tuple(Part(Box((0.2, 0.2, 0.2)), Pose((x, 0.0, 0.0))) for x in xs))


@pytest.fixture
def pairs() -> ExactPairs:
    """Rows 0 and 1 are the near body's cubes at x = 1 and 2, row 2 the far one's at x = 4."""
    owners = (("foot", 0), ("hand", 0), ("thing", 0))
    parts = RobotParts(np.empty((3, 0)), np.empty((3, 12)), np.empty((0, 2)), owners)
    links = {
        "foot": FclBody((Part(Box((0.2, 0.2, 1.0)), Pose((0.0, 0.0, 0.5))),)),
        "hand": FclBody((Part(Sphere(0.1)),)),
    }
    held = FclBody((Part(Sphere(0.1), Pose((0.0, 0.0, -0.1))),)), Pose((0.0, 0.3, 0.0)).matrix
    obstacles = [
        ("near", cubes(0.0, 1.0), Pose((1.0, 0.0, 1.0)).matrix, 2),
        ("far", cubes(0.0), Pose((4.0, 0.0, 1.0)).matrix, 1),
    ]
    floor = FclBody((FLOOR_PART,))
    return ExactPairs(Slider(), parts, OPENING, links, floor, held, obstacles)  # type: ignore[arg-type]


def at(x: float, y: float = 0.0) -> Array:
    return np.array([x, y, 0.0])


@pytest.mark.parametrize(("row", "x"), [(0, 1.0), (1, 2.0), (2, 4.0)])
def test_a_row_is_that_part_of_its_body(pairs: ExactPairs, row: int, x: float) -> None:
    """The hand is a ball of 0.1 at height 1, each cube reaches 0.1 to both sides."""
    for offset, near, gap in (
        (0.0, True, 0.0),
        (0.19, True, 0.0),
        (0.21, False, 0.0),
        (0.21, True, 0.02),
    ):
        assert pairs.nearer(at(x + offset), 1, row, gap) is near
    for other in {0, 1, 2} - {row}:
        assert not pairs.nearer(at(x), 1, other, 0.0)


@pytest.mark.parametrize("padding", [0.0, 0.05])
def test_parts_of_the_robot_against_each_other(pairs: ExactPairs, padding: float) -> None:
    """The foot ends at height 1, where the hand's ball has its middle: 0.1 + 0.1 to the side they part."""
    assert pairs.nearer(at(0.0), 1, SELF - 0, padding)
    assert pairs.nearer(at(0.19), 1, SELF - 0, padding)
    assert pairs.nearer(at(0.23), 1, SELF - 0, padding) is (padding > 0.03)
    assert not pairs.nearer(at(0.5), 1, SELF - 0, padding)


def test_a_held_body_goes_with_the_tool(pairs: ExactPairs) -> None:
    """Its ball is at (x, y + 0.3, 0.4): it meets the foot where the tool is 0.3 short of it."""
    assert pairs.nearer(at(0.0, -0.3), 2, SELF - 0, 0.0)
    assert not pairs.nearer(at(0.0, 0.0), 2, SELF - 0, 0.0)
    assert pairs.nearer(at(0.0, 0.0), 2, SELF - 0, 0.1 + 1e-3)


def test_a_held_body_against_a_link_of_a_number_of_its_own(pairs: ExactPairs) -> None:
    """Two balls of 0.1, one 0.3 beside and 0.6 below the other."""
    gap = np.hypot(0.3, 0.6) - 0.2
    assert pairs.nearer(at(0.0), 2, SELF - 1, gap + 1e-3)
    assert not pairs.nearer(at(0.0), 2, SELF - 1, gap - 1e-3)


def test_the_floor_is_below_zero(pairs: ExactPairs) -> None:
    """The hand's ball ends 0.9 above it, the held one's 0.3; the foot stands on it."""
    assert pairs.nearer(at(7.0, 8.0), 1, FLOOR, 0.91)
    assert not pairs.nearer(at(7.0, 8.0), 1, FLOOR, 0.89)
    assert pairs.nearer(at(0.0), 2, FLOOR, 0.31)
    assert not pairs.nearer(at(0.0), 2, FLOOR, 0.29)


def test_the_room_is_for_the_kernel_to_say(pairs: ExactPairs) -> None:
    assert pairs.nearer(at(0.0), 0, ROOM, 0.0)


@pytest.mark.parametrize(
    ("part", "other", "names"),
    [
        (1, 0, ("hand", "near")), (1, 1, ("hand", "near")), (2, 2, ("thing", "far")),
        (1, FLOOR, ("hand", "floor")), (0, ROOM, ("foot", "room")),
        (1, SELF - 0, ("hand", "foot")), (0, SELF - 2, ("foot", "thing")),
    ],
)  # fmt: skip
def test_names(pairs: ExactPairs, part: int, other: int, names: tuple[str, str]) -> None:
    assert pairs.names(part, other) == names


def test_what_is_not_there_is_an_error(pairs: ExactPairs) -> None:
    with pytest.raises(IndexError, match="row 3"):
        pairs.nearer(at(0.0), 1, 3, 0.0)
    pairs._held = None
    with pytest.raises(ValueError, match="part 2 belongs to thing"):
        pairs.nearer(at(0.0), 2, 0, 0.0)
