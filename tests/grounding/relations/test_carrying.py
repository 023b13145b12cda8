"""Places carried over: in known coordinates, back to where they were, and what is in the way there."""

from __future__ import annotations

import math

import numpy as np
import pytest

from grounding.relations.carrying import BESIDE_OVERLAP_M, carry, coordinates_of, trouble, turned
from grounding.relations.charts import FREE, MODES
from grounding.relations.situation import Situations
from tamp.geometric.scene.pose import Array
from tests.grounding.relations.made import BOX, CRATE, THING, TOP, WEDGE, about_z, situation

WORLD, FURNITURE, OTHER, SECOND, LINE, TO_OTHER, TO_SECOND = range(7)
"""Frames of three arguments: the second's and the third's own, the line between them; and the
directions to them, from which a yaw may be measured."""


def coordinates(s: Situations, *code: int) -> tuple[Array, Array, float]:
    """Place and side of argument 0 in a chart, and what its yaw is measured from."""
    place, outside, yaw = np.zeros((1, 1, 2)), np.zeros((1, 1, 2)), np.zeros((1, 1))
    coordinates_of(
        s.corners, s.counts, s.inner, s.shape, s.R, s.p, s.support, np.array([code]), place,
        outside, yaw,
    )  # fmt: skip
    return place[0, 0], outside[0, 0], float(yaw[0, 0])


def carried(
    s: Situations, shown: Situations, *code: int, spot: tuple[float, float] = (0.0, 0.0),
    free: tuple[float, float] = (0.0, 0.0), onto: float = TOP,
) -> tuple[Array, Array]:  # fmt: skip
    """Where argument 0 gets to, and how it is turned, when what was shown is carried over."""
    place, outside, yaw = coordinates(shown, *code)
    s = s.rows([0])
    carry(
        s.corners, s.counts, s.inner, s.shape, s.R, s.p, s.support, np.array([code]), place[None],
        outside[None], np.array([yaw]), shown.R[:, 0].copy(), np.array([free]), np.array([spot]),
        np.array([onto]),
    )  # fmt: skip
    return s.p[0, 0], s.R[0, 0]


def mode(name: str) -> int:
    return MODES.index(name)


def test_a_rotation_is_turned_about_the_vertical() -> None:
    R, out = about_z(0.3) @ np.diag([1.0, -1.0, -1.0]), np.empty((3, 3))
    turned(R, 0.5, out)
    assert np.allclose(out, about_z(0.5) @ R)


def test_the_offset_of_middles_is_along_the_frame() -> None:
    s = situation((THING, 0.3, 0.1, 0.0), (BOX, 0.1, 0.2, 0.0), front=math.pi / 2)
    assert np.allclose(coordinates(s, 1, WORLD, mode("middle"), FREE)[0], [0.2, -0.1])
    assert np.allclose(coordinates(s, 1, FURNITURE, mode("middle"), FREE)[0], [-0.1, -0.2])


def test_beside_another_body_the_air_between_them_counts() -> None:
    """0.25 m from middle to middle, less 3 and 10 cm; they overlap across."""
    s = situation((THING, -0.25, 0.01, 0.0), (BOX, 0.0, 0.0, 0.0))
    place, outside, _ = coordinates(s, 1, WORLD, mode("edge"), FREE)
    assert np.allclose(place, [0.12, 0.01]) and outside.tolist() == [-1.0, 0.0]

    near = 0.08 - BESIDE_OVERLAP_M  # across they touch at 2 + 6 cm
    for y, side in ((near - 1e-4, 0.0), (near + 1e-4, 1.0)):
        s = situation((THING, -0.25, y, 0.0), (BOX, 0.0, 0.0, 0.0))
        assert coordinates(s, 1, WORLD, mode("edge"), FREE)[1][1] == side


def test_shares_are_of_the_other_body_and_of_the_room_in_it() -> None:
    s = situation((THING, 0.05, -0.03, 0.0), (BOX, 0.0, 0.0, 0.0))
    assert np.allclose(coordinates(s, 1, WORLD, mode("share"), FREE)[0], [0.5, -0.5])
    assert np.allclose(coordinates(s, 1, WORLD, mode("room"), FREE)[0], [5 / 7, -0.75])
    s = situation((THING, 0.03, -0.2, 0.0), (CRATE, 0.0, 0.0, 0.0))
    assert np.allclose(coordinates(s, 1, OTHER, mode("room"), FREE)[0], [0.03 / 0.15, -1.0])


def test_a_gap_is_in_a_direction() -> None:
    s = situation((THING, 0.0, 0.2, 0.0), (BOX, 0.0, 0.0, 0.0))
    place, *_ = coordinates(s, 1, WORLD, mode("gap"), FREE)
    assert np.allclose(place, [math.pi / 2, 0.2 - 0.06 - 0.02])


def test_along_a_line_and_to_its_left() -> None:
    s = situation((THING, -0.05, 0.1, 0.0), (BOX, 0.0, 0.0, 0.0), (BOX, 0.0, 0.4, 0.0))
    place, *_ = coordinates(s, 1, LINE, mode("line"), FREE)
    assert np.allclose(place, [0.25, 0.05])


@pytest.mark.parametrize(
    ("edge", "air"),
    [("left", 0.67), ("right", 0.47), ("front", 0.58), ("rear", 0.18)],
)
def test_how_far_it_is_from_an_edge_of_the_furniture(edge: str, air: float) -> None:
    """The table is about (1, 2), 1.2 m wide and 0.8 m deep; 0.1 right and 0.2 m behind of that."""
    s = situation((THING, 1.1, 2.2, 0.0), middle=(1.0, 2.0))
    assert coordinates(s, 0, FURNITURE, mode(edge), FREE)[0][0] == pytest.approx(air)


@pytest.mark.parametrize("way", MODES[:5])
@pytest.mark.parametrize("frame", [WORLD, FURNITURE, OTHER])
def test_what_is_carried_to_where_it_was_shown_stays_there(way: str, frame: int) -> None:
    at = (0.12, 0.21) if way == "room" else (0.25, 0.31)  # out of it, it would come to its border
    for thing in ((THING, *at, 0.0), (THING, *at, 1.0), (WEDGE, *at, 2.0)):
        s = situation(thing, (BOX, 0.1, 0.2, 0.4), front=0.8)
        p, R = carried(s, s, 1, frame, mode(way), FURNITURE)
        assert np.allclose(p, s.p[0, 0], atol=1e-3 if way == "gap" else 1e-9)
        assert np.allclose(R, s.R[0, 0])


def moved(s: Situations, angle: float, x: float, y: float) -> Situations:
    """The whole scene elsewhere: turned about the vertical and pushed."""
    s, turn = s.rows([0]), about_z(angle)
    s.p[0] = s.p[0] @ turn.T + [x, y, 0.0]
    s.R[0] = turn @ s.R[0]
    s.support[0, 1] += angle
    s.support[0, 2:4] = turn[:2, :2] @ s.support[0, 2:4] + [x, y]
    return s


CHARTS = [
    (1, FURNITURE, mode("middle"), FURNITURE),
    (1, OTHER, mode("edge"), OTHER),
    (1, FURNITURE, mode("gap"), OTHER),
    (1, LINE, mode("line"), LINE),
    (1, SECOND, mode("share"), TO_OTHER),
    (2, LINE, mode("middle"), TO_SECOND),
]


@pytest.mark.parametrize("code", CHARTS)
def test_wherever_the_scene_is_the_coordinates_are_the_same(code: tuple[int, ...]) -> None:
    shown = situation(
        (THING, 0.1, -0.2, 0.3), (BOX, 0.0, 0.0, 0.1), (BOX, 0.5, 0.1, 0.2), front=0.4
    )
    there = moved(shown, 1.1, 0.7, -0.4)
    assert np.allclose(coordinates(there, *code)[0], coordinates(shown, *code)[0], atol=1e-9)
    p, R = carried(there, shown, *code)
    assert np.allclose(p, there.p[0, 0], atol=1e-3) and np.allclose(R, there.R[0, 0], atol=1e-3)


def test_beside_a_larger_body_the_gap_is_kept() -> None:
    shown = situation((THING, 0.25, 0.0, 0.0), (BOX, 0.0, 0.0, 0.0))
    larger = situation((THING, 0.0, 0.3, 0.0), (CRATE, 0.0, 0.0, 0.0))
    assert np.allclose(carried(larger, shown, 1, WORLD, mode("edge"), WORLD)[0][0], 0.35)
    assert np.allclose(carried(larger, shown, 1, WORLD, mode("middle"), WORLD)[0][0], 0.25)
    assert np.allclose(carried(larger, shown, 1, WORLD, mode("share"), WORLD)[0][0], 0.5)
    p, _ = carried(larger, shown, 1, WORLD, mode("gap"), WORLD)
    assert np.allclose(p[:2], [0.35, 0.0], atol=1e-6)


@pytest.mark.parametrize(("edge", "x", "y"), [("left", -0.47, 0.19), ("rear", 0.285, 0.28)])
def test_on_furniture_one_edge_says_and_the_rest_is_free(edge: str, x: float, y: float) -> None:
    """A hand's breadth of 0.1 m from it, half of the room on the other axis."""
    at = {"left": (-0.47, 0.0), "rear": (0.0, 0.28)}[edge]
    shown = situation((THING, *at, 0.0))
    p, _ = carried(shown, shown, 0, FURNITURE, mode(edge), FURNITURE, spot=(0.5, 0.5))
    assert np.allclose(p[:2], [x, y])


def test_anywhere_on_furniture_is_on_it() -> None:
    shown = situation((THING, 0.0, 0.0, 0.0))
    s = situation((THING, 0.0, 0.0, 0.0), front=0.5, middle=(1.0, 2.0))
    p, R = carried(s, shown, 0, FURNITURE, mode("anywhere"), FURNITURE, spot=(1.0, -1.0))
    local = about_z(0.5)[:2, :2].T @ (p[:2] - [1.0, 2.0])
    assert np.allclose(local, [0.57, -0.38]) and np.allclose(R, about_z(0.5))


def test_what_no_frame_says_is_free_and_it_stands_on_what_it_is_told() -> None:
    s = situation((THING, 0.2, 0.0, 0.0), (BOX, 0.0, 0.0, 0.0))
    p, R = carried(s, s, 1, FREE, mode("middle"), FREE, free=(math.pi / 2, 0.7), onto=1.0)
    assert np.allclose(p, [0.0, 0.2, 1.05]) and np.allclose(R, about_z(0.7))


DOWN = np.array([[0.0, 0.0, -1.0]])


def troubled(s: Situations, *, onto: float = TOP, steady: Array = DOWN) -> float:
    out = np.empty(1)
    trouble(
        s.corners, s.counts, s.inner, s.shape, s.R, s.p, s.support, np.array([onto]), steady, out
    )
    return float(out[0])


def test_what_stands_free_has_no_trouble() -> None:
    assert troubled(situation((THING, 0.2, 0.0, 0.3), (BOX, 0.0, 0.0, 0.0))) == 0.0


def test_trouble_is_by_how_much_it_is_in_another_and_off_the_furniture() -> None:
    inside = situation((THING, 0.12, 0.0, 0.0), (BOX, 0.0, 0.0, 0.0))
    assert troubled(inside) == pytest.approx(0.01 - 0.001)
    assert troubled(situation((THING, 0.1, 0.0, 0.0), (CRATE, 0.0, 0.0, 0.0))) == 0.0  # in it
    off = situation((THING, -0.62, 0.0, 0.0))
    assert troubled(off) == pytest.approx(0.02 + 0.01)
    assert troubled(off, onto=TOP + 0.1) == 0.0  # it stands on something else
    turned_off = situation((THING, 0.0, 0.62, 0.0), front=math.pi / 2)
    assert troubled(turned_off) == pytest.approx(0.03)


def test_what_is_about_to_tip_is_in_trouble() -> None:
    s = situation((THING, 0.0, 0.0, 0.0))
    for lean, bad in ((0.2, 0.0), (0.3, 0.1)):  # cosine of 0.25 rad is 0.97
        c, d = math.cos(lean), math.sin(lean)
        s.R[0, 0] = np.array([[1, 0, 0], [0, c, -d], [0, d, c]])
        assert troubled(s) == bad
    assert troubled(s, steady=np.empty((0, 3))) == 0.0
    s.R[0, 0] = np.diag([1.0, -1.0, -1.0])
    assert troubled(s) == 0.1 and troubled(s, steady=np.array([[1.0, 0, 0], [0, 0, 1.0]])) == 0.0
