"""A mesh file's triangles, checked (watertight, none degenerate), and repaired where holes are."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tamp.errors import InputError
from tamp.geometric.loading.mesh_file import read_triangles
from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Int

MAX_MESH_SIZE_M = 5.0
MIN_MESH_SIZE_M = 0.001


@dataclass(frozen=True, eq=False)
class MeshSurface:
    """Triangles in metres.

    Attributes:
        vertices: (n, 3).
        faces: (m, 3), counter-clockwise seen from outside when the surface is closed.
        volume: Of the solid, cubic metres; None when the surface stays open.
        warnings: What was repaired, or stays open.
    """

    vertices: Array
    faces: NDArray[np.integer]
    volume: float | None
    warnings: tuple[str, ...]


def read_surface(path: Path, scale: tuple[float, float, float]) -> MeshSurface:
    """Read a mesh file. Imports trimesh, which takes half a second.

    Args:
        path: OBJ, STL, PLY, COLLADA or glTF.
        scale: Factors that make it metres; negative ones mirror it.

    Raises:
        InputError: Not a mesh, empty, not finite, flat, or of a size that can only be a mistake of
            units.
    """
    import trimesh

    name = path.name
    with np.errstate(over="ignore", invalid="ignore"):  # what is too large is refused in words
        vertices, faces = read_triangles(path)
        used = np.unique(faces)
        if not np.isfinite(vertices[used]).all():
            raise InputError(f"the mesh '{name}' holds coordinates that are not finite numbers")
        vertices = np.where(np.isfinite(vertices), vertices, 0.0) * np.array(scale)
        if np.prod(np.sign(scale)) < 0:  # mirrored: what was outside stays outside
            faces = faces[:, ::-1]
        _check_size(name, np.ptp(vertices[used], axis=0))
    return _closed(name, trimesh.Trimesh(vertices, faces, process=False))


def _closed(name: str, mesh: Any) -> MeshSurface:
    """Merge equal corners; where the surface is open then, repair what can be, and say so."""
    mesh = _merged(mesh, None)
    if not len(mesh.faces):
        raise InputError(f"the mesh '{name}' is degenerate: all its triangles have no area")

    warnings: tuple[str, ...] = ()
    gaps = open_edges(mesh.faces)
    if gaps:
        if mesh.is_watertight:  # only its triangles are turned differently
            mesh.fix_normals(multibody=True)
        else:
            # Corners that a writer rounded apart lie within a ten-thousandth of the size.
            digits = max(0, int(np.ceil(-np.log10(float(mesh.extents.max()) * 1e-4))))
            nearer = _merged(mesh.copy(), digits)
            if len(nearer.faces) and open_edges(nearer.faces) < gaps:
                mesh = nearer
            mesh.fill_holes()
            # Sheets that were closed by their backs have no volume to divide by.
            with np.errstate(divide="ignore", invalid="ignore"):
                if mesh.is_watertight:
                    mesh.fix_normals(multibody=True)

        left = open_edges(mesh.faces)
        what = (
            f"{left} stay open, it was taken as a surface with holes"
            if left
            else "they were closed"
        )
        warnings = (f"the mesh '{name}' is not watertight ({gaps} open edges): {what}",)

    vertices, faces = np.array(mesh.vertices), np.array(mesh.faces)
    volume = None
    if not open_edges(faces):
        a, b, c = vertices[faces].transpose(1, 0, 2)
        volume = float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)
        if volume < 0:  # inside out
            faces, volume = faces[:, ::-1], -volume
    return MeshSurface(vertices, faces, volume or None, warnings)


def _merged(mesh: Any, digits: int | None) -> Any:
    """Merge corners equal to so many digits, without the triangles that this makes empty."""
    mesh.merge_vertices(merge_tex=True, merge_norm=True, digits_vertex=digits)
    a, b, c = mesh.faces.T
    mesh.update_faces((a != b) & (b != c) & (c != a))
    mesh.remove_unreferenced_vertices()
    return mesh


def open_edges(faces: Int[NDArray[np.integer], "m 3"]) -> int:
    """Count the boundary edges, not run through as often forwards as backwards; 0 for a closed
    (watertight), consistently turned surface.

    An edge at which two closed bodies touch belongs to four triangles and is not open.
    """
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    sign = np.where(edges[:, 0] < edges[:, 1], 1, -1)
    _, index = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
    return int((np.bincount(index.ravel(), weights=sign) != 0).sum())


def _check_size(name: str, extents: Array) -> None:
    largest = float(extents.max())
    size = " x ".join(f"{side:.4g}" for side in extents)
    if largest > MAX_MESH_SIZE_M:
        factor = 0.001 if largest > 20 else 0.01
        raise InputError(
            f"the mesh '{name}' is {size} m large",
            remedy=f"Lengths are metres: say scale: {factor:g}",
        )
    if largest < MIN_MESH_SIZE_M:
        raise InputError(
            f"the mesh '{name}' is {size} m small", remedy="Lengths are metres: say scale: 1000"
        )
    if np.sort(extents)[1] < 1e-6:
        raise InputError(f"the mesh '{name}' is degenerate: its points lie on one line")
