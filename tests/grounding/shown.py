"""Scenes that show a relation, as problem files, and data sets made of them."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grounding.collect import collect, read_demonstrations
from grounding.dataset import Dataset

SCENE = """robot: {{model: panda_mobile, base: [0.0, 0.0, 0.0]}}
room: {{x: [-2.5, 2.5], y: [-2.5, 2.5]}}
bodies:
  table: {{furniture: table, size: [1.2, 0.7, {height}], at: [1.6, 0.0, 0.0]}}
  can: {{cylinder: {{radius: 0.033, height: 0.102}}, on: table, at: [{x}, 0.02]}}
  jar: {{box: [0.05, 0.06, {tall}], on: table, at: [-0.3, 0.1], yaw: {yaw} deg}}
goal: {goal}
"""
GOAL = "(and (upright jar table) (not (upright can table)))"


def scene(
    path: Path,
    goal: str = GOAL,
    height: float = 0.7,
    tall: float = 0.15,
    yaw: float = 0,
    x: float = 0.3,
) -> Path:
    path.write_text(SCENE.format(goal=goal, height=height, tall=tall, yaw=yaw, x=x))
    return path


Arrays = dict[str, NDArray[Any]]


def changed(path: Path, change: Callable[[Arrays], object]) -> None:
    """Write the arrays anew as a user's own script would, with the card beside them as it was."""
    with np.load(path) as archive:
        arrays = {name: archive[name] for name in archive.files}
    change(arrays)
    np.savez(path, allow_pickle=False, **arrays)
    card = path.with_suffix(".json")
    entries = json.loads(card.read_text())
    entries.pop("sha256", None)
    card.write_text(json.dumps(entries))


def demonstrations(folder: Path, count: int = 6, goal: str = GOAL, **same: float) -> Dataset:
    """Scenes that vary in everything but what is said."""
    files: list[Path] = []
    for n in range(count):
        varied = {"height": 0.5 + 0.04 * n, "tall": 0.1 + 0.02 * n, "yaw": 25.0 * n, **same}
        files.append(scene(folder / f"{n}.yaml", goal, **varied))
    return collect("upright", read_demonstrations("upright", files))
