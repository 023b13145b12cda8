"""Furniture: its parts fill its outer size, its places are free, reachable space above wood."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tamp.geometric.loading.furniture import FURNITURE, FurnitureOptions
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Box, Part

SIZE = (0.9, 0.42, 1.1)
CASES = [
    ("table", FurnitureOptions()),
    ("table", FurnitureOptions(legs=False)),
    ("shelf", FurnitureOptions(rows=3)),
    ("shelf", FurnitureOptions(rows=2, columns=2, back=True)),
    ("cupboard", FurnitureOptions(rows=2)),
    ("cupboard", FurnitureOptions(rows=2, columns=3, plinth=0.3, thickness=0.015)),
    ("cupboard", FurnitureOptions(back=False)),
    ("open_box", FurnitureOptions()),
    ("open_box", FurnitureOptions(thickness=0.02)),
]


def _inside(parts: tuple[Part, ...], points: Array) -> Array:
    """Which points (n, 3) lie inside a box."""
    inside = np.zeros(len(points), dtype=bool)
    for part in parts:
        assert isinstance(part.shape, Box)
        local = part.pose.inverse().apply(points)
        inside |= (np.abs(local) < np.array(part.shape.size) / 2 - 1e-9).all(axis=1)
    return inside


@pytest.mark.parametrize(("kind", "options"), CASES)
def test_parts_fill_the_outer_size(kind: str, options: FurnitureOptions) -> None:
    piece = FURNITURE[kind].build("it", SIZE, options)
    low, high = bounds(piece.parts, Pose())
    assert np.allclose(low, [-0.45, -0.21, 0.0]) and np.allclose(high, [0.45, 0.21, 1.1])


@pytest.mark.parametrize(("kind", "options"), CASES)
def test_no_part_lies_in_another(kind: str, options: FurnitureOptions) -> None:
    piece = FURNITURE[kind].build("it", SIZE, options)
    boxes = [bounds((part,), Pose()) for part in piece.parts]
    pairs = [(a, b) for i, a in enumerate(boxes) for b in boxes[i + 1 :]]
    for (low, high), (other_low, other_high) in pairs:
        overlap = np.minimum(high, other_high) - np.maximum(low, other_low)
        assert overlap.min() < 1e-9
    assert pairs or options == FurnitureOptions(legs=False)


@pytest.mark.parametrize(("kind", "options"), CASES)
def test_places_are_free_and_stand_on_wood(kind: str, options: FurnitureOptions) -> None:
    piece = FURNITURE[kind].build("it", SIZE, options)
    places = [*piece.surfaces, *piece.cavities]
    assert places
    grid = np.stack(np.meshgrid(*[np.linspace(-0.49, 0.49, 7)] * 2), axis=-1).reshape(-1, 2)
    for place in places:
        flat = grid * place.size[:2]
        height = place.size[2] if len(place.size) == 3 else min(place.clearance, 0.3)  # type: ignore[union-attr]
        for level in np.linspace(0.01, 0.99, 5) * height:
            points = place.pose.apply(np.column_stack([flat, np.full(len(flat), level)]))
            assert not _inside(piece.parts, points).any()
        below = place.pose.apply(np.column_stack([flat, np.full(len(flat), -0.005)]))
        assert _inside(piece.parts, below).all()


def test_compartments_are_numbered_bottom_up_and_left_to_right() -> None:
    """Seen from the front, which faces -y, left is -x."""
    piece = FURNITURE["cupboard"].build("c", SIZE, FurnitureOptions(rows=2, columns=2))
    assert [cavity.name for cavity in piece.cavities] == ["c_1", "c_2", "c_3", "c_4"]
    positions = [cavity.pose.position for cavity in piece.cavities]
    assert (
        positions[0][0] < positions[1][0] and positions[0][2] == positions[1][2] < positions[2][2]
    )
    assert [surface.name for surface in piece.surfaces] == ["c_top"]


def test_the_front_is_open_and_the_back_is_not() -> None:
    piece = FURNITURE["cupboard"].build("c", SIZE, FurnitureOptions(rows=1))
    along = np.linspace(-0.3, 0.2, 60)
    line = np.column_stack([np.zeros(60), along, np.full(60, 0.5)])
    hit = along[_inside(piece.parts, line)]
    assert len(hit) and hit.min() > 0.18
    open_back = FURNITURE["cupboard"].build("c", SIZE, FurnitureOptions(rows=1, back=False))
    assert not _inside(open_back.parts, line).any()


def test_shelf_boards_know_their_clearance() -> None:
    piece = FURNITURE["shelf"].build("s", SIZE, FurnitureOptions(rows=3))
    assert [surface.name for surface in piece.surfaces] == ["s_1", "s_2", "s_3", "s_top"]
    assert piece.surfaces[0].clearance == pytest.approx((1.1 - 4 * 0.02) / 3)
    assert piece.surfaces[-1].clearance == float("inf")


def test_single_places_are_named_as_the_body() -> None:
    assert FURNITURE["table"].build("desk", SIZE, FurnitureOptions()).surfaces[0].name == "desk"
    assert FURNITURE["open_box"].build("bin", SIZE, FurnitureOptions()).cavities[0].name == "bin"


@pytest.mark.parametrize(
    ("kind", "options"),
    [
        ("table", FurnitureOptions(thickness=1.2)),
        ("cupboard", FurnitureOptions(rows=60)),
        ("shelf", FurnitureOptions(columns=50)),
        ("cupboard", FurnitureOptions(plinth=1.09)),
        ("open_box", FurnitureOptions(thickness=0.3)),
    ],
)
def test_boards_that_leave_no_room_are_refused(kind: str, options: FurnitureOptions) -> None:
    with pytest.raises(ValueError, match="room"):
        FURNITURE[kind].build("it", SIZE, options)
    assert (
        FURNITURE[kind]
        .build("it", SIZE, replace(options, rows=1, columns=1, thickness=None, plinth=0.0))
        .parts
    )
