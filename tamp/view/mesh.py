"""Triangles to draw."""

from __future__ import annotations

import io
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tamp.errors import InputError
from tamp.geometric.loading.mesh_file import MOST_BYTES, Beside, ascii_text, quiet, read_triangles
from tamp.geometric.loading.raw_file import read_raw
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Box, Cylinder, Shape, Sphere

Colour = tuple[float, float, float, float]
_GREY = (0.8, 0.8, 0.8, 1.0)
ROUND = 40
"""Corners of what is round."""

FARTHEST_DRAWN_M = 1e6
"""Metres from a mesh's own origin beyond which a browser's numbers of 32 bits draw nothing."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles of one colour: vertices (n, 3) in metres, faces (m, 3), counter-clockwise from
    outside.
    """

    vertices: Array
    faces: NDArray[np.integer]
    colour: Colour

    def moved(self, T_a_b: Array) -> Mesh:
        """Transform the mesh of frame b to frame a; T_a_b of shape (4, 4)."""
        return Mesh(self.vertices @ T_a_b[:3, :3].T + T_a_b[:3, 3], self.faces, self.colour)


def unit(vectors: Array) -> Array:
    """Normalize vectors to length 1, shape (..., 3); what has no direction stays 0."""
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)


def shape_mesh(shape: Shape, colour: Colour) -> Mesh:
    """Triangulate a convex shape in its own frame."""
    if isinstance(shape, Box):
        return _box(shape, colour)
    if isinstance(shape, Cylinder):
        half = shape.height / 2
        return _turned(
            [(0.0, -half), (shape.radius, -half), (shape.radius, half), (0.0, half)], colour
        )
    if isinstance(shape, Sphere):
        tilts = np.linspace(-math.pi / 2, math.pi / 2, ROUND // 2)
        return _turned(
            [(shape.radius * math.cos(a), shape.radius * math.sin(a)) for a in tilts], colour
        )
    return Mesh(np.asarray(shape.vertices, dtype=float), shape.faces, colour)


def read_mesh(
    file: Path, scale: Sequence[float], colour: Colour | None, cell: float = 0.0
) -> list[Mesh]:
    """Read the triangles of a mesh file, a mesh for each of its colours.

    Args:
        file: OBJ, STL, PLY, COLLADA or glTF.
        scale: Factors that make it metres; negative ones mirror it.
        colour: Of all of it; None keeps the file's own.
        cell: Metres: details smaller than this are left out; 0 keeps everything.

    Raises:
        InputError: It cannot be read.
    """
    pieces = _coloured(file) if colour is None else [(*read_triangles(file), colour)]
    groups: dict[Colour, list[tuple[Array, NDArray[np.integer]]]] = {}
    mirrored = float(np.prod(scale)) < 0
    for vertices, faces, own in pieces:
        if not np.isfinite(vertices).all():
            raise InputError(
                f"the mesh '{file.name}' holds coordinates that are not finite numbers"
            )
        with np.errstate(over="ignore"):
            scaled = vertices * np.asarray(scale)
        if np.abs(scaled).max(initial=0.0) > FARTHEST_DRAWN_M:
            raise InputError(f"the mesh '{file.name}' reaches farther than can be drawn")
        turned = faces[:, ::-1] if mirrored else faces
        groups.setdefault(colour or own, []).append((scaled, turned))
    meshes = [_joined(pieces, own) for own, pieces in groups.items()]
    return [simplified(mesh, cell) if cell else mesh for mesh in meshes]


def _coloured(file: Path) -> Iterator[tuple[Array, NDArray[np.integer], Colour]]:
    """Yield the geometries of a file with the colours of their materials."""
    if file.suffix.lower() == ".dae":
        yield *read_triangles(file), _GREY
        return
    import trimesh  # takes half a second

    quiet()
    content = read_raw(file, MOST_BYTES)
    content = ascii_text(content) if file.suffix.lower() == ".obj" else content
    beside: Any = Beside(file.parent)
    try:
        with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is refused later
            loaded: Any = trimesh.load_scene(
                io.BytesIO(content),
                file_type=file.suffix.lower()[1:],
                resolver=beside,
                process=False,
            )
            found = [
                (
                    np.asarray(one.vertices, dtype=float),
                    np.asarray(one.faces, dtype=np.int64),
                    _material(one),
                )
                for one in loaded.dump()
                if isinstance(one, trimesh.Trimesh)
            ]
    except Exception as error:  # trimesh raises whatever its readers stumble on
        raise InputError(
            f"cannot read the mesh '{file.name}': {' '.join(str(error).split())[:200]}"
        ) from None
    yield from found


def simplified(mesh: Mesh, cell: float) -> Mesh:
    """Simplify a mesh by vertex clustering: the vertices in each cube of that many metres become
    one, their mean.
    """
    cubes = np.round(mesh.vertices / cell).astype(np.int64)
    _, member = np.unique(cubes, axis=0, return_inverse=True)
    member = member.ravel()
    counts = np.bincount(member)
    means = (
        np.stack([np.bincount(member, mesh.vertices[:, axis]) for axis in range(3)], axis=1)
        / counts[:, None]
    )
    faces = member[mesh.faces]
    faces = faces[
        (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 0] != faces[:, 2])
    ]
    return Mesh(means, faces, mesh.colour)


def _joined(pieces: list[tuple[Array, NDArray[np.integer]]], colour: Colour) -> Mesh:
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in pieces])
    faces = [faces + start for (_, faces), start in zip(pieces, starts[:-1], strict=True)]
    return Mesh(np.concatenate([vertices for vertices, _ in pieces]), np.concatenate(faces), colour)


def _material(geometry: object) -> Colour:
    visual = getattr(geometry, "visual", None)
    material = getattr(visual, "material", None)
    rgba = getattr(material, "main_color", None)
    if rgba is None:
        return _GREY
    red, green, blue, alpha = (float(part) / 255.0 for part in rgba)
    return (red, green, blue, alpha)


def _box(shape: Box, colour: Colour) -> Mesh:
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    squares = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [(a, b, c) for a, b, c, _ in squares] + [(a, c, d) for a, _, c, d in squares]
    return Mesh(corners * np.array(shape.size), np.array(faces), colour)


def _turned(profile: list[tuple[float, float]], colour: Colour) -> Mesh:
    """Make the surface of revolution of a profile of (radius, z), from the bottom to the top, about
    z.
    """
    angles = np.linspace(0.0, 2 * math.pi, ROUND, endpoint=False)
    rings = [
        np.stack([r * np.cos(angles), r * np.sin(angles), np.full(ROUND, z)], axis=1)
        for r, z in profile
    ]
    faces: list[tuple[int, int, int]] = []
    for ring in range(len(profile) - 1):
        low, high = ring * ROUND, (ring + 1) * ROUND
        for i in range(ROUND):
            j = (i + 1) % ROUND
            faces += [(low + i, low + j, high + j), (low + i, high + j, high + i)]
    return Mesh(np.concatenate(rings), np.array(faces), colour)
