"""Write grounding/assets/bullet_objects.npz: the convex parts of the objects of pybullet_data that data are made with.

python benchmarks/build_training_objects.py
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.common import without_options
from grounding.bullet_objects import OBJECTS_FILE, packed
from grounding.objects import MESHES, RANDOM
from tamp.geometric.loading.meshes import find_mesh, load_mesh
from tamp.geometric.scene.scene import Part


def from_files() -> dict[str, tuple[Part, ...]]:
    """The objects as pybullet_data's files have them."""
    wanted = {f"random_{n:03d}": (f"random_urdfs/{n:03d}/{n:03d}.urdf", 1.0) for some in RANDOM.values() for n in some}
    wanted |= {Path(path).stem: (path, scale) for some in MESHES.values() for path, scale in some.items()}
    return {
        name: load_mesh(find_mesh(f"pybullet_data/{path}", Path()), (scale, scale, scale)).parts
        for name, (path, scale) in wanted.items()
    }


if __name__ == "__main__":
    without_options(__doc__)
    np.savez_compressed(OBJECTS_FILE, **packed(from_files()))  # pyright: ignore[reportArgumentType]
