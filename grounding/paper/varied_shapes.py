"""Furniture of random kinds and sizes, and all shapes that an encoder of clouds is shown beside it:
what the codes of three supports do not tell apart, those of two hundred do.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache

import numpy as np
from numpy.random import Generator as Random

from grounding.household import SHAPES
from grounding.mesh_folder import unusable
from grounding.objects import object_templates
from grounding.relation_scene import region_of
from grounding.supports import FurnitureSupport
from tamp.geometric.loading.furniture import FURNITURE, FurnitureOptions
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Part, Surface

PIECES = 210
"""Pieces of furniture, each kind as many."""

HOUSEHOLD_SHAPES = 200
"""Household shapes that are drawn beside the training objects, each kind as many."""

LEAST_SIZE_M = (0.35, 0.35, 0.2)
MOST_SIZE_M = (1.6, 1.1, 1.5)
"""Width, depth and height of a piece, drawn uniformly, metres."""

_SEED = 20261130


@lru_cache(maxsize=4)
def varied_supports(count: int = PIECES, seed: int = 0) -> Mapping[str, FurnitureSupport]:
    """Make pieces of furniture whose top is meant, by name; deterministic.

    Args:
        count: How many.
        seed: Of kinds' sizes; others are other pieces.
    """
    rng = np.random.default_rng([_SEED, seed])
    kinds = list(_KINDS)
    found: dict[str, FurnitureSupport] = {}
    for number in range(count):
        kind = kinds[number % len(kinds)]
        size = rng.uniform(LEAST_SIZE_M, MOST_SIZE_M)
        parts = _KINDS[kind](tuple(float(v) for v in size), rng)
        top = float(size[2])
        side = (float(size[0]), float(size[1]))
        if kind == "round":
            edge = min(side) / 2**0.5  # of the largest square on it
            side = (edge, edge)
        surface = Surface(kind, kind, Pose((0.0, 0.0, top)), side)
        body = Body(kind, parts, Pose(), False, surfaces=(surface,))
        found[f"{kind}_{number:03d}"] = FurnitureSupport(parts, region_of(body, surface))
    return found


@lru_cache(maxsize=2)
def varied_shapes(seed: int = 0) -> Mapping[str, tuple[Part, ...]]:
    """Return what an encoder is trained on, by name, parts in metres; deterministic: furniture
    first, the training objects (pybullet's meshes among them), and household shapes of other sizes.
    """
    rng = np.random.default_rng([_SEED, seed, 1])
    found = dict(object_templates("train"))
    makers = list(SHAPES.items())
    for number in range(HOUSEHOLD_SHAPES):
        name, make = makers[number % len(makers)]
        found[f"{name}_varied_{number:03d}"] = make(rng)
    bodies = {name: parts for name, parts in found.items() if unusable(parts) is None}
    pieces = {name: support.parts for name, support in varied_supports(seed=seed).items()}
    return {**pieces, **bodies}


Size = tuple[float, ...]


def _table(size: Size, rng: Random) -> tuple[Part, ...]:
    """Make a table: a plate on four legs of any thickness, near its corners or further in."""
    x, y, height = size
    plate = float(rng.uniform(0.02, 0.08))
    leg = float(rng.uniform(0.03, 0.12))
    inset = float(rng.uniform(0.0, 0.2))
    return (
        _board((x, y, plate), height),
        *_legs((x * (1 - inset), y * (1 - inset)), leg, height - plate),
    )


def _chest(size: Size, rng: Random) -> tuple[Part, ...]:
    """Make a closed chest on short legs."""
    x, y, height = size
    foot = float(rng.uniform(0.03, 0.4)) * height
    leg = float(rng.uniform(0.03, 0.1))
    return _board((x, y, height - foot), height), *_legs((x, y), leg, foot)


def _block(size: Size, rng: Random) -> tuple[Part, ...]:
    """Make a solid block."""
    x, y, height = size
    return (_board((x, y, height), height),)


def _round(size: Size, rng: Random) -> tuple[Part, ...]:
    """Make a round table on one leg, some with a foot."""
    x, y, height = size
    radius, plate = min(x, y) / 2, float(rng.uniform(0.02, 0.06))
    stem = Cylinder(float(rng.uniform(0.02, 0.08)), height - plate)
    top = Part(Cylinder(radius, plate), Pose((0.0, 0.0, height - plate / 2)))
    parts = (top, Part(stem, Pose((0.0, 0.0, (height - plate) / 2))))
    if rng.random() < 0.5:
        return parts
    foot = Cylinder(float(rng.uniform(0.3, 0.8)) * radius, 0.03)
    return (*parts, Part(foot, Pose((0.0, 0.0, 0.015))))


def _cabinet(size: Size, rng: Random) -> tuple[Part, ...]:
    """Make an open cabinet with a back, of one to three rows, some on a plinth."""
    return _carcass("cupboard", size, rng, back=True)


def _shelf(size: Size, rng: Random) -> tuple[Part, ...]:
    """Make a shelf, with a back or without."""
    return _carcass("shelf", size, rng, back=bool(rng.random() < 0.5))


def _counter(size: Size, rng: Random) -> tuple[Part, ...]:
    """Make a plate on two side walls."""
    x, y, height = size
    plate, wall = (float(v) for v in rng.uniform(0.02, 0.1, 2))
    side = Box((wall, y, height - plate))
    walls = [
        Part(side, Pose((sign * (x - wall) / 2, 0.0, (height - plate) / 2))) for sign in (-1, 1)
    ]
    return (_board((x, y, plate), height), *walls)


_KINDS: Mapping[str, Callable[[Size, Random], tuple[Part, ...]]] = {
    "table": _table,
    "chest": _chest,
    "block": _block,
    "round": _round,
    "cabinet": _cabinet,
    "shelf": _shelf,
    "counter": _counter,
}


def _carcass(kind: str, size: Size, rng: Random, *, back: bool) -> tuple[Part, ...]:
    x, y, height = size
    rows = int(rng.integers(1, 2 + (height > 0.5) + (height > 0.9)))
    columns = int(rng.integers(1, 2 + (x > 0.7)))
    plinth = float(rng.uniform(0.02, 0.15)) * height if rng.random() < 0.5 else 0.0
    options = FurnitureOptions(rows=rows, columns=columns, back=back, plinth=plinth)
    return FURNITURE[kind].build(kind, (x, y, height), options).parts


def _board(size: tuple[float, float, float], top: float) -> Part:
    """Make a box whose upper face is at a height."""
    return Part(Box(size), Pose((0.0, 0.0, top - size[2] / 2)))


def _legs(within: tuple[float, float], width: float, height: float) -> list[Part]:
    """Make four legs at the corners of a rectangle about the origin."""
    along, across = ((side - width) / 2 for side in within)
    return [
        Part(Box((width, width, height)), Pose((sx * along, sy * across, height / 2)))
        for sx in (-1, 1)
        for sy in (-1, 1)
    ]
