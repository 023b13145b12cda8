"""Parametric furniture, built of boxes, with the surfaces and cavities that follow from it.

The frame is on the floor under the centre: x along the width of the front, y the depth, the front
faces -y, z up. Sizes are outer sizes [width, depth, height] in metres.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cavity, Part, Surface

Size = tuple[float, float, float]
_LEG_WIDTH_M = 0.05


@dataclass(frozen=True)
class FurnitureOptions:
    """The options of a piece of furniture beside its size.

    Attributes:
        rows: Compartments above each other.
        columns: Compartments beside each other.
        thickness: Of the boards, metres; None for the kind's usual one.
        legs: Whether a table stands on four legs; else it is solid.
        back: Whether there is a back wall; None for the kind's usual answer.
        plinth: Height of the closed foot under the lowest board, metres.
    """

    rows: int = 1
    columns: int = 1
    thickness: float | None = None
    legs: bool = True
    back: bool | None = None
    plinth: float = 0.0


@dataclass(frozen=True)
class Furniture:
    """The geometry of a piece of furniture in its own frame."""

    parts: tuple[Part, ...]
    surfaces: tuple[Surface, ...] = ()
    cavities: tuple[Cavity, ...] = ()


@dataclass(frozen=True)
class Kind:
    """A kind of furniture: how it is built, and which options it understands."""

    build: Callable[[str, Size, FurnitureOptions], Furniture]
    options: tuple[str, ...]


def _table(name: str, size: Size, options: FurnitureOptions) -> Furniture:
    width, depth, height = size
    thickness = options.thickness or 0.04
    top = Surface(name, name, _at(0, 0, height), (width, depth))

    if not options.legs:
        return Furniture(
            (_board((-width / 2, width / 2), (-depth / 2, depth / 2), (0, height)),), (top,)
        )

    _need(
        height > thickness,
        f"a table {height:g} m high has no room under a top {thickness:g} m thick",
    )
    _need(
        min(width, depth) > 2 * _LEG_WIDTH_M,
        f"a table narrower than {2 * _LEG_WIDTH_M:g} m has no room for legs: say legs: false",
    )

    across, along = (width - _LEG_WIDTH_M) / 2, (depth - _LEG_WIDTH_M) / 2
    legs = [
        Part(
            Box((_LEG_WIDTH_M, _LEG_WIDTH_M, height - thickness)),
            _at(x, y, (height - thickness) / 2),
        )
        for x in (-across, across)
        for y in (-along, along)
    ]

    plate = _board((-width / 2, width / 2), (-depth / 2, depth / 2), (height - thickness, height))
    return Furniture((plate, *legs), (top,))


def _shelf(name: str, size: Size, options: FurnitureOptions) -> Furniture:
    parts, compartments = _carcass(size, options, back=bool(options.back))
    boards = [
        Surface(f"{name}_{i}", name, pose, inner[:2], clearance=inner[2])
        for i, (pose, inner) in enumerate(compartments, start=1)
    ]
    top = Surface(f"{name}_top", name, _at(0, 0, size[2]), size[:2])
    return Furniture(parts, (*boards, top))


def _cupboard(name: str, size: Size, options: FurnitureOptions) -> Furniture:
    parts, compartments = _carcass(size, options, back=options.back is not False)
    cavities = tuple(
        Cavity(f"{name}_{i}", name, pose, inner)
        for i, (pose, inner) in enumerate(compartments, start=1)
    )
    return Furniture(parts, (Surface(f"{name}_top", name, _at(0, 0, size[2]), size[:2]),), cavities)


def _open_box(name: str, size: Size, options: FurnitureOptions) -> Furniture:
    width, depth, height = size
    wall = options.thickness or 0.01
    inner = (width - 2 * wall, depth - 2 * wall, height - wall)
    _need(min(inner) > 0, f"walls {wall:g} m thick leave no room inside")
    half_x, half_y = width / 2, depth / 2
    above = (wall, height)
    parts = (
        _board((-half_x, half_x), (-half_y, half_y), (0, wall)),
        _board((-half_x, wall - half_x), (-half_y, half_y), above),
        _board((half_x - wall, half_x), (-half_y, half_y), above),
        _board((wall - half_x, half_x - wall), (-half_y, wall - half_y), above),
        _board((wall - half_x, half_x - wall), (half_y - wall, half_y), above),
    )
    return Furniture(parts, (), (Cavity(name, name, _at(0, 0, wall), inner),))


FURNITURE: Mapping[str, Kind] = {
    "table": Kind(_table, ("thickness", "legs")),
    "shelf": Kind(_shelf, ("compartments", "thickness", "back", "plinth")),
    "cupboard": Kind(_cupboard, ("compartments", "thickness", "back", "plinth")),
    "open_box": Kind(_open_box, ("thickness",)),
}
"""Builders by name; each raises ValueError, with a sentence, when the boards leave no room."""

PORTABLE_KINDS = ("open_box",)
"""Kinds that may be moved: `fixed: false`."""


def _carcass(
    size: Size, options: FurnitureOptions, back: bool
) -> tuple[tuple[Part, ...], list[tuple[Pose, Size]]]:
    """Build sides, boards and dividers, and the compartments (floor's centre, inner size): bottom
    up, then left to right.
    """
    width, depth, height = size
    board, foot, rows, columns = (
        options.thickness or 0.02,
        options.plinth,
        options.rows,
        options.columns,
    )

    behind = board if back else 0.0
    inner = (
        (width - (columns + 1) * board) / columns,
        depth - behind,
        (height - foot - (rows + 1) * board) / rows,
    )

    _need(
        min(inner) > 0,
        f"{rows} x {columns} compartments with boards {board:g} m thick leave no room inside",
    )

    half, front, rear = width / 2, -depth / 2, depth / 2 - behind
    parts = [
        _board((side - board / 2, side + board / 2), (front, rear), (foot, height))
        for side in (board / 2 - half, half - board / 2)
    ]

    inside = (board - half, half - board)
    floors = [foot + board + row * (inner[2] + board) for row in range(rows + 1)]
    parts += [_board(inside, (front, rear), (floor - board, floor)) for floor in floors]

    lefts = [board - half + column * (inner[0] + board) for column in range(columns)]
    for left in lefts[1:]:
        parts += [
            _board((left - board, left), (front, rear), (floor, floor + inner[2]))
            for floor in floors[:-1]
        ]

    if back:
        parts.append(_board((-half, half), (rear, depth / 2), (foot, height)))
    if foot > 0:
        parts.append(_board((-half, half), (front, depth / 2), (0, foot)))

    centre = (front + rear) / 2
    return tuple(parts), [
        (_at(left + inner[0] / 2, centre, floor), inner) for floor in floors[:-1] for left in lefts
    ]  # fmt: skip


def _board(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Part:
    """Return a box between limits."""
    size = (x[1] - x[0], y[1] - y[0], z[1] - z[0])
    return Part(Box(size), _at(math.fsum(x) / 2, math.fsum(y) / 2, math.fsum(z) / 2))


def _at(x: float, y: float, z: float) -> Pose:
    return Pose((float(x), float(y), float(z)))


def _need(condition: bool, message: str) -> None:
    if not condition:
        raise ValueError(message)
