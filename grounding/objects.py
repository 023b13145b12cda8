"""The objects that data are made with: household shapes, pybullet's meshes, a folder of one's own.
Training and test objects are disjoint.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

import numpy as np

from grounding.bullet_objects import bullet_objects
from grounding.household import SHAPES, YCB
from grounding.mesh_folder import MeshFolder, read_folder, unusable
from tamp.geometric.scene.scene import Part

SPLITS = ("train", "test")
HOUSEHOLD = {"train": 7, "test": 3}
"""How many of each household shape."""
RANDOM = {"train": range(0, 60), "test": range(500, 520)}
"""Which of pybullet's random shapes."""
MESHES: Mapping[str, Mapping[str, float]] = {
    "train": {
        "duck_vhacd.urdf": 1.0,
        "lego/lego.urdf": 1.5,
        "jenga/jenga.urdf": 1.0,
        "domino/domino.urdf": 1.0,
    },
    "test": {"objects/mug.urdf": 0.85, "teddy_vhacd.urdf": 1.0},
}
"""Meshes of pybullet_data and the factors that make them a hand's size."""
_SEED = 20261125


@lru_cache(maxsize=4)
def object_templates(
    split: str, folder: MeshFolder | None = None
) -> Mapping[str, tuple[Part, ...]]:
    """Return the objects of a split by name, parts in metres; deterministic.

    Args:
        split: "train" or "test".
        folder: Of one's own meshes: those objects join the household ones.

    Raises:
        InputError: As for `read_folder`.
    """
    rng = np.random.default_rng([_SEED, SPLITS.index(split)])
    found: dict[str, tuple[Part, ...]] = {}
    for name, make in SHAPES.items():
        for number in range(HOUSEHOLD[split]):
            found[f"{name}_{split}_{number}"] = make(rng)

    if split == "test":
        found |= YCB
    kept = bullet_objects()
    names = [f"random_{number:03d}" for number in RANDOM[split]]
    names += [Path(path).stem for path in MESHES[split]]
    found |= {name: kept[name] for name in names}

    if folder is not None:
        found |= read_folder(folder).templates
    return {name: parts for name, parts in found.items() if unusable(parts) is None}
