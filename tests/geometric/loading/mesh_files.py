"""Meshes as files, and what their convex pieces hold."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial import ConvexHull

from tamp.geometric.loading.meshes import MeshGeometry
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Hull

ONE = (1.0, 1.0, 1.0)


CUBE = [(x, y, z) for x in (0, 0.1) for y in (0, 0.1) for z in (0, 0.1)]


CUBE_FACES = [
    (0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4),
    (1, 5, 7), (1, 7, 3),
]  # fmt: skip


def write_obj(path: Path, vertices: object, faces: object) -> Path:
    rows = [f"v {' '.join(str(float(c)) for c in vertex)}" for vertex in np.asarray(vertices)]
    rows += [f"f {' '.join(str(int(i) + 1) for i in face)}" for face in np.asarray(faces)]
    path.write_text("\n".join(rows) + "\n")
    return path


def corner(width: float = 0.2) -> tuple[Array, Array]:
    """A cube without one octant, closed, (n, 3) and (m, 3): cuts along the notch meet inside it."""
    half = width / 2
    full = [
        (i, j, k) for i in range(2) for j in range(2) for k in range(2) if (i, j, k) != (1, 1, 1)
    ]
    squares = []
    for cell in full:
        for axis in range(3):
            for side in (0, 1):
                beside = tuple(c + (2 * side - 1) * (a == axis) for a, c in enumerate(cell))
                if beside in full:
                    continue
                u, v = (axis + 1) % 3, (axis + 2) % 3
                base = np.array(cell, dtype=float)
                base[axis] += side
                steps = [np.eye(3)[u], np.eye(3)[v]]
                square = [base, base + steps[0], base + steps[0] + steps[1], base + steps[1]]
                squares.append(square if side else square[::-1])
    points = np.array(squares).reshape(-1, 3) * half
    vertices, index = np.unique(points, axis=0, return_inverse=True)
    quads = index.reshape(-1, 4)
    return vertices, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def beyond(points: Array, pieces: list[Array]) -> Array:
    """How far each point (n, 3) lies outside of the nearest piece, metres; negative inside."""
    distances = [
        (points @ e[:, :3].T + e[:, 3]).max(axis=1)
        for e in (ConvexHull(piece).equations for piece in pieces)
    ]
    return np.min(distances, axis=0)


def on_surface(vertices: Array, faces: Array, count: int) -> Array:
    """Random points (count, 3) on a surface."""
    rng = np.random.default_rng(0)
    corners = vertices[faces]
    areas = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    weights = rng.dirichlet((1, 1, 1), size=count)
    return np.einsum(
        "ij,ijk->ik", weights, corners[rng.choice(len(faces), size=count, p=areas / areas.sum())]
    )


def hulls(mesh: MeshGeometry) -> list[Array]:
    return [part.shape.vertices for part in mesh.parts if isinstance(part.shape, Hull)]
