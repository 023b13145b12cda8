"""Meshes from OBJ, STL, PLY and one-link URDF files, as convex pieces."""

from __future__ import annotations

import importlib.util
import os
from dataclasses import dataclass, replace
from pathlib import Path

from tamp.data import shipped
from tamp.errors import InputError, closest
from tamp.world.mesh_pieces import mesh_pieces
from tamp.world.pose import Pose
from tamp.world.scaling import scale_part, scale_pose
from tamp.world.scene import Part
from tamp.world.urdf_link import read_link

Scale = tuple[float, float, float]
SUFFIXES = (".obj", ".stl", ".ply", ".urdf")
_PYBULLET = "pybullet_data"


@dataclass(frozen=True)
class Mesh:
    """A mesh file as a body's geometry.

    Attributes:
        parts: Convex parts in the file's frame, metres.
        files: The files that were read.
        warnings: What had to be repaired or guessed.
        visual: The mesh file to draw, None for a URDF of primitives.
        visual_scale: Factors that make it metres.
        visual_pose: Pose of the scaled visual in the body's frame.
        colour: The URDF's colour, when it gives one.
    """

    parts: tuple[Part, ...]
    files: tuple[Path, ...]
    warnings: tuple[str, ...] = ()
    visual: Path | None = None
    visual_scale: Scale = (1.0, 1.0, 1.0)
    visual_pose: Pose = Pose()
    colour: tuple[float, float, float, float] | None = None


def find_mesh(name: str, folder: Path) -> Path:
    """The file that `mesh:` means: relative to the problem's folder or its `assets/`, shipped, or in `pybullet_data/`.

    Raises:
        InputError: There is no such file.
    """
    path = Path(os.path.expanduser(name))
    if path.parts[:1] == (_PYBULLET,):
        spec = importlib.util.find_spec(_PYBULLET)
        roots = [Path(place).parent for place in (spec.submodule_search_locations or ())] if spec else []
        if not roots:
            raise InputError(f"no mesh file '{name}'", remedy="pybullet is not installed")
    else:
        roots = [folder, folder / "assets", shipped("problems") / "assets"]
    for root in roots:
        if (root / path).is_file():
            return root / path
    beside = {
        str(path.parent / file.name)
        for folder in (root / path.parent for root in roots)
        if folder.is_dir()
        for file in folder.iterdir()
        if file.suffix.lower() in SUFFIXES
    }
    nearest = closest(name, sorted(beside))
    raise InputError(f"no mesh file '{name}'", remedy=f"Did you mean '{nearest}'?" if nearest else "")


def load_mesh(path: Path, scale: Scale = (1.0, 1.0, 1.0)) -> Mesh:
    """A mesh file as convex parts in the file's frame.

    Args:
        path: An OBJ, STL, PLY or one-link URDF file.
        scale: Factors for the file's x, y, z that make it metres.

    Raises:
        InputError: The file is no usable mesh; without the line of the problem file, which the caller knows.
    """
    if path.suffix.lower() == ".urdf":
        return _load_urdf(path, scale)
    hulls, warnings = mesh_pieces(path, scale)
    return Mesh(tuple(Part(hull) for hull in hulls), (path,), warnings, path, scale)


def _load_urdf(path: Path, scale: Scale) -> Mesh:
    """Every collision element of the one link is a part or several; the first visual mesh is drawn."""
    factor = scale[0]
    if scale != (factor, factor, factor):
        raise InputError(f"'{path.name}' can only be scaled alike in all directions", remedy="scale: one number")
    link = read_link(path)
    parts: list[Part] = []
    warnings: list[str] = []
    for element in link.collisions:
        pose = scale_pose(element.pose, factor)
        if element.shape is not None:
            parts.append(scale_part(Part(element.shape, element.pose), factor))
        if element.mesh is not None:
            hulls, repaired = mesh_pieces(element.mesh, _times(element.scale, factor))
            parts += [Part(hull, pose) for hull in hulls]
            warnings += repaired
    files = dict.fromkeys([path, *(element.mesh for element in link.collisions if element.mesh)])
    mesh = Mesh(tuple(parts), tuple(files), tuple(warnings), colour=link.colour)
    visual = next((element for element in link.visuals if element.mesh is not None), None)
    if visual is None:
        return mesh
    return replace(
        mesh,
        visual=visual.mesh,
        visual_scale=_times(visual.scale, factor),
        visual_pose=scale_pose(visual.pose, factor),
    )


def _times(scale: Scale, factor: float) -> Scale:
    return (scale[0] * factor, scale[1] * factor, scale[2] * factor)
