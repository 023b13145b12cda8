"""The convex pieces of a mesh file, computed once and kept in the cache folder."""

from __future__ import annotations

import contextlib
import hashlib
import io
import zipfile
from pathlib import Path

import numpy as np

from tamp.errors import InputError
from tamp.geometric.loading.mesh_file import MOST_BYTES
from tamp.geometric.loading.raw_file import read_raw
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Hull
from tamp.system.files import cache_folder, shipped, write_whole

Scale = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]

# Raise it when the same file would give other pieces.
_VERSION = 2
_ONE_HULL = 1.15


def mesh_pieces(
    path: Path, scale: Scale, turned: Quaternion | None = None
) -> tuple[tuple[Hull, ...], tuple[str, ...]]:
    """Return the convex pieces that contain the mesh, in metres in the file's frame, and what had
    to be repaired.

    Args:
        path: The mesh file.
        scale: Factors that make it metres.
        turned: The orientation (xyzw) of the file's frame in the one in which the pieces are
            wanted; None for the same.

    One hull when it is at most 15 % larger than the mesh. The first call takes a second or two; its
    result is kept in the cache folder under the file's hash, and a later call takes a millisecond.
    Shipped meshes come with their pieces.

    Raises:
        InputError: The file is missing or no usable mesh.
    """
    name = pieces_name(path, scale, turned)
    kept = cache_folder() / "meshes" / name
    for file in (shipped("problems") / "assets" / "pieces" / name, kept):
        found = _read(file)
        if found is not None:
            return found
    hulls, warnings = compute_pieces(path, scale, turned)
    with contextlib.suppress(OSError):  # a read-only home: computed anew next time
        write_whole(kept, packed(hulls, warnings))
    return hulls, warnings


def pieces_name(path: Path, scale: Scale, turned: Quaternion | None = None) -> str:
    """Return the name of the file that keeps the pieces of a mesh at a scale.

    Raises:
        InputError: The mesh cannot be read.
    """
    content = read_raw(path, MOST_BYTES)
    # The suffix decides the reader, and the name stands in warnings.
    asked = (_VERSION, path.name, scale) if turned is None else (_VERSION, path.name, scale, turned)
    return hashlib.sha256(content + repr(asked).encode()).hexdigest()[:32] + ".npz"


def compute_pieces(
    path: Path, scale: Scale, turned: Quaternion | None = None
) -> tuple[tuple[Hull, ...], tuple[str, ...]]:
    """Compute the same pieces anew."""
    from scipy.spatial import ConvexHull, QhullError

    from tamp.geometric.loading.decomposition import decompose
    from tamp.geometric.loading.mesh_surface import read_surface
    from tamp.geometric.scene.convex import hull_of, simplified

    surface = read_surface(path, scale)
    vertices = (
        surface.vertices
        if turned is None
        else surface.vertices @ Pose(quaternion=turned).rotation.T
    )
    try:
        whole = float(ConvexHull(vertices).volume)
        if surface.volume is not None and whole <= _ONE_HULL * surface.volume:
            pieces = [simplified(vertices)]
        else:
            pieces = decompose(vertices, surface.faces)
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        hulls = tuple(_hull(*hull_of(_within(piece, low, high))) for piece in pieces)
    except (QhullError, ValueError):
        raise InputError(
            f"the mesh '{path.name}' is degenerate: it is flat, no closed hull can be made"
        ) from None
    return hulls, surface.warnings


def _within(points: Array, low: Array, high: Array) -> Array:
    """Move a flat piece, which was made 1 mm thick, so that it does not stand out of the mesh's
    bounding box.
    """
    size = np.ptp(points, axis=0)
    move = np.maximum(low - points.min(axis=0), 0.0) - np.maximum(points.max(axis=0) - high, 0.0)
    return points + np.where(size <= high - low, move, 0.0)


def packed(hulls: tuple[Hull, ...], warnings: tuple[str, ...]) -> bytes:
    """Return the content of a file of pieces: plain arrays, no pickles."""
    stream = io.BytesIO()
    np.savez(
        stream,
        vertices=np.concatenate([hull.vertices for hull in hulls]),
        faces=np.concatenate([hull.faces for hull in hulls]).astype(np.int32),
        counts=np.array([(len(hull.vertices), len(hull.faces)) for hull in hulls]),
        warnings=np.array(warnings, dtype=np.str_),
    )
    return stream.getvalue()


def _read(file: Path) -> tuple[tuple[Hull, ...], tuple[str, ...]] | None:
    try:
        with np.load(file, allow_pickle=False) as kept:
            vertices, faces, counts, warnings = (
                kept[key] for key in ("vertices", "faces", "counts", "warnings")
            )
        first_vertex, first_face = np.cumsum(np.vstack([[0, 0], counts]), axis=0).T
        hulls = tuple(
            _hull(
                vertices[first_vertex[i] : first_vertex[i + 1]],
                faces[first_face[i] : first_face[i + 1]],
            )
            for i in range(len(counts))
        )
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        return None  # not there, or broken by whoever wrote it: computed anew
    return hulls, tuple(str(text) for text in warnings)


def _hull(vertices: np.ndarray, faces: np.ndarray) -> Hull:
    vertices, faces = np.array(vertices, dtype=np.float64), np.array(faces, dtype=np.int32)
    vertices.flags.writeable = faces.flags.writeable = False
    return Hull(vertices, faces)
