"""Furniture that data are made with: what things stand on, and what they stand in. Training and
test pieces differ.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.random import Generator as Random

from grounding.objects import SPLITS
from grounding.relation_scene import Region, region_of
from tamp.geometric.loading.furniture import FURNITURE, FurnitureOptions
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Part, Surface

PIECES = {"train": 8, "test": 3}
"""How many of each kind of furniture."""
_SEED = 20261126


@dataclass(frozen=True, eq=False)
class FurnitureSupport:
    """A piece of furniture and the place on or in it that is meant."""

    parts: tuple[Part, ...]
    region: Region


@lru_cache(maxsize=4)
def support_templates(relation: str, split: str) -> Mapping[str, FurnitureSupport]:
    """Make the supports for `on`, containers for `inside`, by name; deterministic."""
    rng = np.random.default_rng([_SEED, SPLITS.index(split), relation == "on"])
    found: dict[str, FurnitureSupport] = {}
    for kind, make in (_SUPPORTS if relation == "on" else _CONTAINERS).items():
        for number in range(PIECES[split]):
            body = make(rng)
            places = [*body.cavities] if relation == "inside" else [*body.surfaces]
            place = places[int(rng.integers(len(places)))]
            found[f"{kind}_{split}_{number}"] = FurnitureSupport(body.parts, region_of(body, place))
    return found


def household_supports(relation: str, split: str) -> dict[str, FurnitureSupport]:
    """Return all pieces of a household scene by name: the relation's first, then what is stood
    on.
    """
    return {**support_templates(relation, split), **support_templates("on", split)}


def scaled_region(region: Region, factor: float) -> Region:
    """Scale the region of a support that is made larger."""
    matrix = region.matrix.copy()
    matrix[:3, 3] *= factor
    return replace(region, matrix=matrix, size=region.size * factor, box=region.box * factor)


def _table(rng: Random) -> Body:
    return _furniture("table", rng.uniform([0.5, 0.4, 0.35], [1.4, 0.9, 0.95]), FurnitureOptions())


def _block(rng: Random) -> Body:
    x, y, z = (float(v) for v in rng.uniform([0.25, 0.25, 0.1], [0.8, 0.7, 0.8]))
    part = Part(Box((x, y, z)), Pose((0.0, 0.0, z / 2)))
    surface = Surface("block", "block", Pose(), (x, y))
    return Body(
        "block", (part,), Pose(), False, surfaces=(replace(surface, pose=Pose((0.0, 0.0, z))),)
    )


def _board(rng: Random) -> Body:
    """Make a thin board that hangs at some height."""
    x, y, height = (float(v) for v in rng.uniform([0.3, 0.18, 0.2], [1.0, 0.45, 1.4]))
    part = Part(Box((x, y, 0.03)), Pose((0.0, 0.0, height - 0.015)))
    surface = Surface("board", "board", Pose(), (x, y))
    return Body(
        "board", (part,), Pose(), False, surfaces=(replace(surface, pose=Pose((0.0, 0.0, height))),)
    )


def _round(rng: Random) -> Body:
    """Make a round table on one leg; the surface is the largest square on it."""
    radius, height = (float(v) for v in rng.uniform([0.25, 0.4], [0.6, 0.9]))
    plate = Part(Cylinder(radius, 0.04), Pose((0.0, 0.0, height - 0.02)))
    leg = Part(Cylinder(0.05, height - 0.04), Pose((0.0, 0.0, (height - 0.04) / 2)))
    surface = Surface("round", "round", Pose(), (radius * 2**0.5, radius * 2**0.5))
    return Body(
        "round",
        (plate, leg),
        Pose(),
        False,
        surfaces=(replace(surface, pose=Pose((0.0, 0.0, height))),),
    )


def _top(rng: Random) -> Body:
    size = rng.uniform([0.5, 0.3, 0.5], [1.1, 0.55, 1.2])
    return _furniture("cupboard", size, FurnitureOptions(rows=int(rng.integers(1, 3))))


def _shelf(rng: Random) -> Body:
    size = rng.uniform([0.5, 0.28, 0.7], [1.1, 0.45, 1.4])
    body = _furniture(
        "shelf", size, FurnitureOptions(rows=int(rng.integers(2, 4)), back=bool(rng.random() < 0.5))
    )
    return replace(body, surfaces=body.surfaces[:-1])  # a board with another one above it


def _open_box(rng: Random) -> Body:
    return _furniture(
        "open_box",
        rng.uniform([0.25, 0.22, 0.1], [0.65, 0.5, 0.2]),
        FurnitureOptions(thickness=0.02),
    )


def _bin(rng: Random) -> Body:
    return _furniture(
        "open_box",
        rng.uniform([0.22, 0.22, 0.2], [0.45, 0.4, 0.36]),
        FurnitureOptions(thickness=0.01),
    )


def _drawer(rng: Random) -> Body:
    """Make a drawer drawn out of nothing, at some height: wide, shallow, thin walls."""
    size = rng.uniform([0.3, 0.3, 0.09], [0.6, 0.5, 0.16])
    body, lift = (
        _furniture("open_box", size, FurnitureOptions(thickness=0.012)),
        Pose((0.0, 0.0, float(rng.uniform(0.1, 0.8)))),
    )
    parts = tuple(replace(part, pose=lift @ part.pose) for part in body.parts)
    return replace(
        body, parts=parts, cavities=(replace(body.cavities[0], pose=lift @ body.cavities[0].pose),)
    )


def _compartment(rng: Random) -> Body:
    size = rng.uniform([0.5, 0.32, 0.6], [1.0, 0.55, 1.2])
    rows, columns = int(rng.integers(2, 4)), int(rng.integers(1, 3))
    return _furniture("cupboard", size, FurnitureOptions(rows=rows, columns=columns))


_SUPPORTS = {
    "table": _table,
    "block": _block,
    "board": _board,
    "round": _round,
    "top": _top,
    "shelf": _shelf,
}
_CONTAINERS = {"open_box": _open_box, "bin": _bin, "drawer": _drawer, "compartment": _compartment}


def _furniture(kind: str, size: np.ndarray, options: FurnitureOptions) -> Body:
    x, y, z = (float(v) for v in size)
    built = FURNITURE[kind].build(kind, (x, y, z), options)
    return Body(kind, built.parts, Pose(), False, surfaces=built.surfaces, cavities=built.cavities)
