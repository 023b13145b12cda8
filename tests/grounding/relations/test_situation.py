"""Situations of a scene: what a body stands on, what its front is, and batches put together."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from grounding.relations.situation import (
    BELOW,
    GROUND,
    SLAB,
    joined,
    place_row,
    shape_of,
    situation_of,
    support_of,
)
from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Surface
from tests.geometric.making import body, crate, scene, table
from tests.grounding.relations.made import BOX, THING, situation

CUP = body("cup", Cylinder(0.04, 0.1), (0.2, 0.1, 0.551))
PLATE = body("plate", Box((0.2, 0.1, 0.02)), (-0.2, 0.0, 0.511))


def test_a_body_is_measured_where_the_middle_of_its_box_is() -> None:
    found = situation_of(scene(table(), CUP, PLATE), ("cup", "plate"))
    assert (len(found), found.arguments) == (1, 2)
    assert found.p[0] == pytest.approx(np.array([[0.2, 0.1, 0.551], [-0.2, 0.0, 0.511]]))
    assert found.half == pytest.approx(np.array([[0.04, 0.04, 0.05], [0.1, 0.05, 0.01]]), abs=1e-3)
    assert (found.inner == 0.0).all()
    assert found.support[0] == pytest.approx([0.5, 0.0, 0.0, 0.0, 0.5, 0.3])


def test_the_second_argument_says_on_what_it_is() -> None:
    there = scene(table(), table("low", at=(2.0, 0.0), height=0.3), CUP, replace(
        PLATE, pose=Pose((2.0, 0.0, 0.311))))  # fmt: skip
    assert situation_of(there, ("cup", "plate")).support[0, 0] == pytest.approx(0.3)
    assert situation_of(there, ("plate", "cup")).support[0, 0] == pytest.approx(0.5)
    assert situation_of(there, ("cup",)).support[0, 0] == pytest.approx(0.5)


def test_a_place_is_a_slab_and_a_container_the_room_in_it() -> None:
    there = scene(table(), crate(), CUP)
    on = situation_of(there, ("cup", "table"))
    assert on.half[1] == pytest.approx([0.5, 0.3, SLAB / 2])
    assert on.p[0, 1] == pytest.approx([0.0, 0.0, 0.5 - SLAB / 2])
    assert (on.inner[1] == 0.0).all()

    inside = situation_of(there, ("cup", "crate_inside"))
    assert inside.half[1] == pytest.approx([0.2, 0.2, 0.15])
    assert inside.p[0, 1] == pytest.approx([2.0, 0.0, 0.02 + 0.15])
    assert inside.inner[1] == pytest.approx([0.2, 0.2, -0.15, 0.3])
    assert inside.support[0] == pytest.approx([0.02, 0.0, 2.0, 0.0, 0.2, 0.2])


def test_a_movable_container_is_a_body_with_room_in_it() -> None:
    box = replace(crate(), movable=True)
    found = situation_of(scene(table(), box, CUP), ("cup", "crate"))
    assert found.half[1] == pytest.approx([0.2, 0.2, 0.01])
    assert found.inner[1] == pytest.approx([0.2, 0.2, 0.01, 0.3])
    assert shape_of(box.parts).inner.tolist() == [0.0] * 4


def test_what_is_neither_a_body_nor_a_place_is_refused_with_the_choices() -> None:
    with pytest.raises(InputError, match="'cpu' is no body or place") as told:
        situation_of(scene(table(), CUP), ("cpu", "table"))
    assert "cup" in str(told.value)


def stands(foot: float, at: tuple[float, float] = (0.0, 0.0), *others: object) -> float:
    """Height of what a foot at this height stands on, on a table that carries a low board."""
    low = replace(table("board", height=0.3), surfaces=(
        Surface("board", "board", Pose((0.0, 0.0, 0.15)), (0.4, 0.4)),))  # fmt: skip
    return support_of(scene(table(), low), np.array(at), foot, others)[0]  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("foot", "at", "height"),
    [
        (0.6, (0.0, 0.0), 0.5),
        (0.5 - BELOW + 1e-6, (0.0, 0.0), 0.5),
        (0.5 - BELOW - 1e-6, (0.0, 0.0), 0.3),
        (0.2, (0.0, 0.0), 0.0),
        (0.6, (0.499, 0.299), 0.5),
        (0.6, (0.501, 0.0), 0.0),
        (0.6, (0.0, 0.301), 0.0),
    ],
)
def test_it_stands_on_the_highest_place_below_it(
    foot: float, at: tuple[float, float], height: float
) -> None:
    assert stands(foot, at) == pytest.approx(height)


def test_what_is_related_or_moves_is_no_furniture() -> None:
    assert stands(0.6, (0.0, 0.0), "table") == pytest.approx(0.3)
    loose = replace(table(), movable=True)
    assert support_of(scene(loose), np.zeros(2), 0.6) == (0.0, 0.0, 0.0, 0.0, 2.0, 2.0)


def test_the_ground_is_centred_where_it_stands() -> None:
    assert support_of(scene(), np.array([1.0, -2.0]), 0.0) == (0.0, 0.0, 1.0, -2.0, 2.0, 2.0)
    assert GROUND[:4] == (0.0,) * 4


@pytest.mark.parametrize(
    ("front", "yaw", "sides"),
    [
        (0.0, 0.3, (0.5, 0.3)),
        (math.pi / 2, 0.3 + math.pi / 2, (0.3, 0.5)),
        (math.pi, 0.3 + math.pi, (0.5, 0.3)),
        (-math.pi / 2, 0.3 - math.pi / 2, (0.3, 0.5)),
    ],
)
def test_length_is_along_the_front(front: float, yaw: float, sides: tuple[float, float]) -> None:
    turned = replace(table(), pose=Pose.from_xyz_yaw(1.0, 2.0, 0.25, 0.3), front=front)
    row = place_row(turned, turned.surfaces[0])
    assert row == pytest.approx((0.5, yaw, 1.0, 2.0, *sides))


def test_a_turned_table_ends_where_it_ends() -> None:
    turned = replace(table(), pose=Pose.from_xyz_yaw(0.0, 0.0, 0.25, math.pi / 4))
    along, across = 0.45 / math.sqrt(2), 0.35 / math.sqrt(2)
    found = [
        support_of(scene(turned), np.array(at), 0.6)[0]
        for at in ((along, along), (-across, across), (-0.25 / math.sqrt(2), 0.25 / math.sqrt(2)))
    ]
    assert found == pytest.approx([0.5, 0.0, 0.5])


def test_joined_batches_say_what_each_said() -> None:
    """Of other shapes with fewer corners, too."""
    there = scene(table(), CUP, PLATE)
    one, other = (
        situation_of(there, ("cup", "plate")),
        situation((THING, 0.1, 0, 0), (BOX, 0, 0, 1)),
    )
    both = joined([one, other])
    assert len(both) == 2 and both.shape.tolist() == [[0, 1], [2 + THING, 2 + BOX]]
    for row, part in enumerate((one, other)):
        for place in range(2):
            mine, theirs = both.shape[row, place], part.shape[0, place]
            count = part.counts[theirs]
            assert both.counts[mine] == count
            assert (both.corners[mine, :count] == part.corners[theirs, :count]).all()
            assert (both.corners[mine, count:] == part.corners[theirs, count - 1]).all()
            assert (both.half[mine] == part.half[theirs]).all()
    assert (both.p == np.concatenate([one.p, other.p])).all()


def test_rows_are_copies() -> None:
    every = situation((THING, 0.1, 0.0, 0.0), (BOX, 0.0, 0.0, 1.0))
    twice = every.rows([0, 0])
    twice.p[0, 0] = twice.R[0, 0] = twice.support[0] = 7.0
    assert len(twice) == 2 and every.p.max() < 1.0 and twice.p[1].max() < 1.0
    assert every.R.max() <= 1.0 and every.support.max() < 1.0
