"""Demonstrations for the tests: a cup left of a plate, seen from the front of a table; and bodies of
each kind of shape.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.random import Generator as Random

from grounding.relations.demonstration_file import Label
from grounding.relations.demonstration_text import BodyEntry, DemonstrationFile, write_demonstration
from tamp.geometric.scene.pose import Pose

Way = Callable[[Random], tuple[float, float, bool]]


def left(rng: Random) -> tuple[float, float, bool]:
    return -float(rng.uniform(0.01, 0.1)), float(rng.uniform(-0.03, 0.03)), True


def elsewhere(rng: Random) -> tuple[float, float, bool]:
    gap, side = float(rng.uniform(0.01, 0.1)), float(rng.uniform(0.16, 0.25))
    return [(gap, 0.0, False), (0.1, side, False), (0.1, -side, False), (-0.25, 0.0, False)][
        int(rng.integers(4))
    ]


def beside(rng: Random) -> tuple[float, float, bool]:
    """Left or right of it: what holds both ways round."""
    return (
        float(rng.choice([-1, 1]) * rng.uniform(0.01, 0.05)),
        float(rng.uniform(-0.02, 0.02)),
        True,
    )


def far(rng: Random) -> tuple[float, float, bool]:
    way, side = float(rng.choice([-1, 1])), float(rng.choice([-1, 1]))
    return [(way * rng.uniform(0.15, 0.3), 0.0, False), (0.1, side * 0.25, False)][
        int(rng.integers(2))
    ]


def write_one(path: Path, rng: Random, way: Way, name: str = "left_of", **fixed: float) -> None:
    """One scene: a cup beside a plate, as `way` has its gap to the right and how far it is behind."""
    height, yaw = fixed.get("height", rng.uniform(0.4, 0.9)), fixed.get("yaw", rng.uniform(-3, 3))
    front = Pose.from_xyz_yaw(rng.uniform(1, 2), rng.uniform(-1, 1), 0, yaw)
    plate, radius = (
        fixed.get("plate", rng.uniform(0.07, 0.1)),
        fixed.get("cup", rng.uniform(0.03, 0.045)),
    )
    tall = 2 * radius if "cup" in fixed else rng.uniform(0.08, 0.14)
    gap, behind, holds = way(rng)
    middle = rng.uniform(-0.1, 0.2)
    x = middle + np.sign(gap) * (plate + radius + abs(gap)) if abs(behind) < 0.1 else middle + gap
    table = {"furniture": "table", "size": [1.4, 0.9, round(float(height), 4)]}
    turns = rng.uniform(-3, 3, 2) if "yaw" not in fixed else np.zeros(2)
    bodies = {
        "table": BodyEntry(table, front),
        "plate": BodyEntry(
            {"cylinder": {"radius": round(float(plate), 5), "height": 0.02}},
            front @ Pose.from_xyz_yaw(middle, 0, height + 0.011, turns[0]),
        ),
        "cup": BodyEntry(
            {"cylinder": {"radius": round(float(radius), 5), "height": round(float(tall), 5)}},
            front @ Pose.from_xyz_yaw(x, behind, height + 0.001 + tall / 2, turns[1]),
        ),
    }
    write_demonstration(path, DemonstrationFile(bodies, [Label(name, ("cup", "plate"), holds)]))


def write_demos(
    folder: Path,
    seed: int = 0,
    good: int = 10,
    bad: int = 10,
    way: Way | None = None,
    **fixed: float,
) -> Path:
    """A folder of demonstrations of `left_of`."""
    rng = np.random.default_rng(seed)
    for number in range(good + bad):
        write_one(
            folder / f"left_of_{number:03d}.yaml",
            rng,
            (way or left) if number < good else (far if way else elsewhere),
            **fixed,
        )
    return folder


BODIES = {
    "desk": BodyEntry(
        {"furniture": "table", "size": [1.2, 0.7, 0.72]}, Pose.from_xyz_yaw(1.5, 0.0, 0.0, 0.4)
    ),
    "cup": BodyEntry(
        {"cylinder": {"radius": 0.04, "height": 0.1}, "colour": "red"}, Pose((1.5, 0.1, 0.771))
    ),
    "plate": BodyEntry(
        {"box": [0.2, 0.2, 0.02], "front": "90 deg"}, Pose.from_xyz_yaw(1.4, -0.2, 0.731, 1.0)
    ),
    "bowl": BodyEntry(
        {"mesh": "objects/bowl.obj", "fixed": True},
        Pose.from_xyz_rpy((1.9, 0.2, 0.9), (1.0, 0.2, 0.0)),
    ),
}


def everything(*labels: Label) -> DemonstrationFile:
    """All of `BODIES`, with what is said of them."""
    return DemonstrationFile(BODIES, labels, "A cup\nbeside a plate.")
