"""Demonstrations of the benchmark's relations as files, as the page or a person's script would write them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.random import Generator as Random

from benchmarks.relations.geometry import Batch, pick
from benchmarks.relations.hand import shown
from benchmarks.relations.relations import RELATIONS
from grounding.relations.demonstration_file import Label
from grounding.relations.demonstration_text import BodyEntry, DemonstrationFile, write_demonstration
from tamp.geometric.scene.pose import Pose

NAMES = ("object", "other", "third")


def entries(s: Batch, row: int) -> dict[str, BodyEntry]:
    """One scene of a batch as bodies of a problem file: a table, and the arguments."""
    top, (x, y), (a, b) = float(s["top"][row]), s["centre"][row].tolist(), (2 * s["half"][row]).tolist()
    table = {"furniture": "table", "size": [round(a, 4), round(b, 4), round(top, 4)], "legs": "false"}
    if top < 0.2:
        table["thickness"] = 0.02
    bodies = {"table": BodyEntry(table, Pose.from_xyz_yaw(x, y, 0.0, float(s["yaw"][row])))}
    for i in range(s["cyl"].shape[1]):
        h = s["h"][row, i].round(4)
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = s["R"][row, i], s["p"][row, i]
        shape: dict[str, object] = {"box": (2 * h).round(4).tolist()}
        if s["cyl"][row, i]:
            shape = {"cylinder": {"radius": float(h[0]), "height": round(2 * float(h[2]), 4)}}
        if s["wall"][row, i] > 0:
            wall = float(s["wall"][row, i])
            size = (2 * h).tolist()
            shape = {"furniture": "open_box", "size": [round(one, 4) for one in size], "thickness": wall}
            matrix[:3, 3] -= matrix[:3, 2] * h[2]
        bodies[NAMES[i]] = BodyEntry(shape, Pose.from_matrix(matrix))
    return bodies


def write(folder: Path, name: str, good: int, bad: int, rng: Random, lazy: str = "") -> list[Path]:
    """Write demonstrations of a relation, as many of each label, and return the files."""
    paths: list[Path] = []
    for count, holds in ((good, True), (bad, False)):
        s = shown(name, count, holds, rng, lazy=lazy) if count else None
        for row in range(count):
            assert s is not None
            label = Label(name, NAMES[: RELATIONS[name].arguments], holds)
            path = folder / f"{name}_{len(paths) + 1:03d}.yaml"
            write_demonstration(path, DemonstrationFile(entries(pick(s, [row]), 0), [label]))
            paths.append(path)
    return paths


def degrees(angle: float) -> str:
    return f"{math.degrees(angle):g} deg"
