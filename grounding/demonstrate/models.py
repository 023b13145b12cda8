"""Bodies to show relations with: as entries of a problem file, of a size that a hand can hold."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from numpy.random import Generator as Random

HAND = 0.072
"""Metres that the hand can take, with room to spare: what is shown can be planned."""

Entry = dict[str, Any]
"""A body as a problem file has it: its shape and what goes with it, without its place."""


def _round(value: float) -> float:
    return round(float(value), 3)


def _scale(rng: Random, low: float, high: float) -> float:
    """Sample a factor in steps of 0.05: a mesh of a new size takes half a second to be read."""
    return round(0.05 * round(float(rng.uniform(low, high)) / 0.05), 2)


def _box(rng: Random) -> Entry:
    edges = rng.uniform(0.03, [0.1, 0.13, 0.18])
    edges[edges.argmin()] = min(edges.min(), HAND)
    return {"box": [_round(edge) for edge in edges]}


def _can(rng: Random) -> Entry:
    radius, height = rng.uniform([0.02, 0.05], [HAND / 2, 0.17])
    return {"cylinder": {"radius": _round(radius), "height": _round(height)}}


def _cup(rng: Random) -> Entry:
    return {"mesh": "pybullet_data/objects/mug.urdf", "scale": _scale(rng, 0.65, 0.9)}


def _bowl(rng: Random) -> Entry:
    return {"mesh": "objects/bowl.obj", "scale": _scale(rng, 0.75, 1.25)}


def _bottle(rng: Random) -> Entry:
    return {"mesh": "objects/mustard_bottle.obj", "scale": _scale(rng, 0.7, 1.15)}


def _plate(rng: Random) -> Entry:
    radius, height = rng.uniform([0.09, 0.01], [0.14, 0.025])
    return {"cylinder": {"radius": _round(radius), "height": _round(height)}}


def _stick(rng: Random) -> Entry:
    length, width, height = rng.uniform([0.13, 0.015, 0.012], [0.22, 0.03, 0.02])
    return {"box": [_round(length), _round(width), _round(height)]}


def _container(rng: Random) -> Entry:
    width, depth, height = rng.uniform([0.24, 0.2, 0.06], [0.4, 0.3, 0.14])
    return {
        "furniture": "open_box",
        "size": [_round(width), _round(depth), _round(height)],
        "thickness": 0.012,
    }


MODELS: Mapping[str, Callable[[Random], Entry]] = {
    "box": _box,
    "can": _can,
    "cup": _cup,
    "bowl": _bowl,
    "bottle": _bottle,
    "plate": _plate,
    "stick": _stick,
    "container": _container,
}
"""Makers by kind."""

ANY = ("box", "box", "box", "can", "can", "cup", "bottle", "bowl")
"""What an `object` may be; boxes and cans more often, for they stand on each other."""


def sample_body(kind: str, rng: Random) -> tuple[str, Entry]:
    """Sample a body of a kind; return what to call it, and its entry."""
    chosen = ANY[int(rng.integers(len(ANY)))] if kind == "object" else kind
    return chosen, MODELS[chosen](rng)


def sample_furniture(rng: Random) -> tuple[str, Entry, str]:
    """Sample what things stand on: its name, its entry, and the name of its surface."""
    which = int(rng.integers(4))
    if which == 0:
        width, depth, height = (_round(v) for v in rng.uniform([0.8, 0.4, 0.5], [1.1, 0.5, 1.1]))
        entry = {"furniture": "cupboard", "size": [width, depth, height], "compartments": 2}
        return "cupboard", entry, "cupboard_top"
    if which == 1:
        width, depth, height = (_round(v) for v in rng.uniform([0.7, 0.5, 0.15], [1.1, 0.7, 0.45]))
        entry = {"furniture": "table", "size": [width, depth, height], "legs": False}
        return "bench", entry, "bench"
    width, depth, height = (_round(v) for v in rng.uniform([0.9, 0.55, 0.5], [1.3, 0.8, 1.05]))
    return "table", {"furniture": "table", "size": [width, depth, height]}, "table"
