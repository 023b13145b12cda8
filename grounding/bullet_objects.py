"""The convex parts of pybullet_data's objects that training uses, kept as arrays: neither pybullet
nor its files are needed.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

import numpy as np

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Hull, Part, Shape

OBJECTS_FILE = Path(__file__).parent / "assets" / "bullet_objects.npz"
"""Written by benchmarks/build_training_objects.py, with the licence beside it."""


@lru_cache(maxsize=1)
def bullet_objects() -> Mapping[str, tuple[Part, ...]]:
    """Return the parts of each object by its name, metres."""
    with np.load(OBJECTS_FILE, allow_pickle=False) as file:
        arrays = {key: file[key] for key in file.files}

    vertices = np.split(arrays["vertices"], np.cumsum(arrays["vertex_counts"])[:-1])
    faces = np.split(arrays["faces"], np.cumsum(arrays["face_counts"])[:-1])
    found: dict[str, list[Part]] = {name: [] for name in arrays["names"].tolist()}
    names = list(found)

    for number, owner in enumerate(arrays["owners"].tolist()):
        x, y, z, *turn = arrays["poses"][number].tolist()
        pose = Pose((x, y, z), (turn[0], turn[1], turn[2], turn[3]))
        size = arrays["boxes"][number].tolist()
        shape = _shape(vertices[number], faces[number], (size[0], size[1], size[2]))
        found[names[owner]].append(Part(shape, pose))

    return {name: tuple(parts) for name, parts in found.items()}


def packed(objects: Mapping[str, tuple[Part, ...]]) -> dict[str, np.ndarray]:
    """Pack objects of hulls and boxes into arrays.

    Raises:
        TypeError: A part is of another shape.
    """
    parts = [(owner, part) for owner, some in enumerate(objects.values()) for part in some]
    hulls = [part.shape if isinstance(part.shape, Hull) else None for _, part in parts]
    boxes = [part.shape.size if isinstance(part.shape, Box) else (0.0,) * 3 for _, part in parts]
    if any(hull is None and not all(box) for hull, box in zip(hulls, boxes, strict=True)):
        raise TypeError("only hulls and boxes can be packed")

    empty = np.zeros((0, 3))
    vertices = [empty if hull is None else hull.vertices for hull in hulls]
    faces = [empty.astype(np.int32) if hull is None else hull.faces for hull in hulls]

    return {
        "names": np.array(list(objects)),
        "owners": np.array([owner for owner, _ in parts], dtype=np.int32),
        "poses": np.array([[*part.pose.position, *part.pose.quaternion] for _, part in parts]),
        "boxes": np.array(boxes),
        "vertices": np.concatenate(vertices),
        "vertex_counts": np.array([len(some) for some in vertices]),
        "faces": np.concatenate(faces).astype(np.int32),
        "face_counts": np.array([len(some) for some in faces]),
    }


def _shape(vertices: np.ndarray, faces: np.ndarray, size: tuple[float, float, float]) -> Shape:
    if all(size):
        return Box(size)
    vertices.flags.writeable = faces.flags.writeable = False
    return Hull(vertices, faces)
