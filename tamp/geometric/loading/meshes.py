"""Meshes and URDF files as bodies' geometry: convex parts, and what to draw."""

from __future__ import annotations

import importlib.util
import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tamp.errors import InputError, closest
from tamp.geometric.loading.mesh_pieces import mesh_pieces
from tamp.geometric.loading.urdf_link import Capsule, Colour, Element
from tamp.geometric.loading.urdf_object import UrdfObject, read_object
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scaling import scale_part, scale_pose
from tamp.geometric.scene.scene import Cylinder, Part, Sphere, Visual
from tamp.system.files import shipped

if TYPE_CHECKING:
    from jaxtyping import Float

Scale = tuple[float, float, float]
MESH_SUFFIXES = (".obj", ".stl", ".ply", ".dae", ".glb", ".gltf", ".urdf")
_PYBULLET = "pybullet_data"
_ENTRIES = 2000


@dataclass(frozen=True)
class MeshGeometry:
    """A mesh file as a body's geometry.

    Attributes:
        parts: Convex parts in the file's frame, metres.
        files: The files that were read.
        warnings: What had to be repaired or guessed.
        visuals: What to draw in place of the parts.
        colour: The URDF's colour, when it gives one.
        sources: The mesh files among several parts: file, factors that make it metres, its pose in
            the body.
        mass, center_of_mass, friction: The URDF's, when it gives them: kilograms, metres in the
            file's frame.
    """

    parts: tuple[Part, ...]
    files: tuple[Path, ...]
    warnings: tuple[str, ...] = ()
    visuals: tuple[Visual, ...] = ()
    colour: Colour | None = None
    sources: tuple[tuple[Path, Scale, Pose], ...] = ()
    mass: float | None = None
    center_of_mass: tuple[float, float, float] | None = None
    friction: float | None = None


def find_mesh(name: str, folder: Path) -> Path:
    """Find the file that `mesh:` means: relative to the problem's folder or its `assets/`, shipped,
    or in `pybullet_data/`.

    Raises:
        InputError: There is no such file.
    """
    path = Path(os.path.expanduser(name))
    shown = name if len(name) <= 80 else f"{name[:77]}..."

    roots = [folder, folder / "assets", shipped("problems") / "assets"]
    sought = [root / path for root in roots]
    if path.parts[:1] == (_PYBULLET,):
        roots = _bullet_roots()
        # Those of its files that shipped problems use come with us.
        sought = [root / path for root in roots]
        sought.append(shipped("problems") / "assets" / Path(*path.parts[1:]))

    try:
        for place in sought:
            if place.is_file():
                return place
        beside = sorted(_meshes_beside(path, roots))
    except OSError as error:  # a name too long to be one, a folder that may not be read
        raise InputError(f"no mesh file '{shown}': {error.strerror}") from None

    nearest = closest(name, beside) if len(name) < 1000 else None
    remedy = f"Did you mean '{nearest}'?" if nearest else ""
    if not roots:
        remedy = "pybullet_data comes with pybullet, which is not installed (Python 3.11 has it)"
    raise InputError(f"no mesh file '{shown}'", remedy=remedy)


def _bullet_roots() -> list[Path]:
    """Return the folders in which pybullet_data lies; none when it is not installed."""
    spec = importlib.util.find_spec(_PYBULLET)
    places = (spec.submodule_search_locations or ()) if spec else ()
    return [Path(place).parent for place in places]


def _meshes_beside(path: Path, roots: list[Path]) -> set[str]:
    """List the mesh files where the named one would be, as they would be named."""
    found: set[str] = set()
    for folder in (root / path.parent for root in roots):
        if not folder.is_dir():
            continue
        with os.scandir(folder) as entries:
            for _, entry in zip(range(_ENTRIES), entries, strict=False):
                if entry.name.lower().endswith(MESH_SUFFIXES) and entry.is_file():
                    found.add(str(path.parent / entry.name))
    return found


def load_mesh(path: Path, scale: Scale = (1.0, 1.0, 1.0)) -> MeshGeometry:
    """Load a mesh file as convex parts in the file's frame.

    Args:
        path: An OBJ, STL, PLY, COLLADA, glTF or URDF file.
        scale: Factors for the file's x, y, z that make it metres; a negative one mirrors it.

    Raises:
        InputError: The file is no usable mesh; without the line of the problem file, which the
            caller knows.
    """
    if path.suffix.lower() == ".urdf":
        return _load_urdf(path, scale)
    hulls, warnings = mesh_pieces(path, scale)
    sources = ((path, scale, Pose()),) if len(hulls) > 1 else ()
    return MeshGeometry(
        tuple(Part(hull) for hull in hulls),
        (path,),
        warnings,
        (Visual(path, scale=scale),),
        sources=sources,
    )


def mesh_triangles(mesh: MeshGeometry) -> Float[Array, "n 3 3"] | None:
    """Return the triangles (n, 3, 3) of the mesh files among several parts, in the body's frame,
    metres; None without any.
    """
    if not mesh.sources:
        return None
    from tamp.geometric.loading.mesh_file import read_triangles

    found: list[Array] = []
    for path, scale, pose in mesh.sources:
        vertices, faces = read_triangles(path)
        faces = faces[:, ::-1] if np.prod(scale) < 0 else faces
        found.append(pose.apply(vertices * np.array(scale))[faces])
    return np.concatenate(found)


def _load_urdf(path: Path, scale: Scale) -> MeshGeometry:
    """Load a URDF file: each collision element is a part or several; the visual ones are drawn."""
    factor = scale[0]
    if scale != (factor, factor, factor) or factor < 0:
        raise InputError(
            f"'{path.name}' can only be scaled alike in all directions",
            remedy="scale: one number > 0",
        )

    described = read_object(path)
    parts: list[Part] = []
    sources: list[tuple[Path, Scale, Pose]] = []
    warnings = list(described.warnings)

    for element in described.collisions:
        made, repaired = _parts(element, factor)
        parts += made
        if element.mesh is not None:
            sources.append(
                (element.mesh, _times(element.scale, factor), scale_pose(element.pose, factor))
            )
        warnings += repaired

    files = dict.fromkeys(
        [path, *(element.mesh for element in described.collisions if element.mesh)]
    )
    centre, doubt = _centre(path, described, tuple(parts), factor)

    return MeshGeometry(
        tuple(parts),
        tuple(files),
        (*dict.fromkeys(warnings), *doubt),
        tuple(_visual(element, factor) for element in described.visuals),
        described.colour,
        tuple(sources),
        described.mass,
        centre,
        described.friction,
    )


def _parts(element: Element, factor: float) -> tuple[list[Part], tuple[str, ...]]:
    """Return the convex parts of an element in a body that is scaled by a factor, and what had to
    be repaired.
    """
    if element.shape is not None:
        return [scale_part(part, factor) for part in primitive_parts(element)], ()
    if element.mesh is None:
        return [], ()
    pose, scale = scale_pose(element.pose, factor), _times(element.scale, factor)
    if _along_axes(pose.rotation):
        hulls, repaired = mesh_pieces(element.mesh, scale)
        return [Part(hull, pose) for hull in hulls], repaired
    # Pieces are exact along the axes in which they are made: made in the body's, its box is exact.
    hulls, repaired = mesh_pieces(element.mesh, scale, pose.quaternion)
    return [Part(hull, Pose(pose.position)) for hull in hulls], repaired


def primitive_parts(element: Element) -> list[Part]:
    """Return the parts of an element that is no mesh: several for a capsule."""
    shape, pose = element.shape, element.pose
    if not isinstance(shape, Capsule):
        return [] if shape is None else [Part(shape, pose)]
    return capsule_parts(shape.radius, shape.length, pose)


def capsule_parts(radius: float, length: float, pose: Pose = Pose()) -> list[Part]:
    """Return a capsule's parts: a cylinder of that length along z, a ball at each end. Metres."""
    ends = (Pose((0.0, 0.0, side * length / 2)) for side in (-1, 1))
    return [
        Part(Cylinder(radius, length), pose),
        *(Part(Sphere(radius), pose @ end) for end in ends),
    ]


def _visual(element: Element, factor: float) -> Visual:
    pose = scale_pose(element.pose, factor)
    if element.mesh is not None:
        return Visual(
            element.mesh, scale=_times(element.scale, factor), pose=pose, colour=element.colour
        )
    return Visual(
        shapes=tuple(scale_part(part, factor) for part in primitive_parts(element)),
        colour=element.colour,
    )


def _centre(
    path: Path, described: UrdfObject, parts: tuple[Part, ...], factor: float
) -> tuple[tuple[float, float, float] | None, tuple[str, ...]]:
    """Return the centre of mass of the scaled body, unless it lies out of the body's box, where
    none can be.
    """
    if described.center_of_mass is None:
        return None, ()
    x, y, z = (factor * value for value in described.center_of_mass)
    low, high = bounds(parts, Pose())
    if np.any(np.array((x, y, z)) < low - 1e-3) or np.any(np.array((x, y, z)) > high + 1e-3):
        where = f"[{x:.3g}, {y:.3g}, {z:.3g}]"
        return None, (
            f"'{path.name}' has its centre of mass at {where}, out of its shape: the shape's is "
            "taken",
        )
    return (x, y, z), ()


def _along_axes(rotation: Array) -> bool:
    """Check whether a rotation (3, 3) maps axes onto axes."""
    return bool(np.all(np.minimum(np.abs(rotation), np.abs(np.abs(rotation) - 1)) < 1e-6))


def _times(scale: Scale, factor: float) -> Scale:
    return (scale[0] * factor, scale[1] * factor, scale[2] * factor)
