"""A folder of one's own meshes, one a subfolder as the YCB set comes, or one a file: objects to
make data with.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from hashlib import sha256
from pathlib import Path

import numpy as np

from grounding.body_geometry import BodyGeometry
from grounding.folder_files import files_below
from tamp.errors import InputError
from tamp.geometric.loading.meshes import load_mesh
from tamp.geometric.scene.scene import Part

SMALLEST, LARGEST = 0.02, 0.28
"""Metres: what is smaller or larger is not moved by a hand."""

SUFFIXES = (".urdf", ".obj", ".stl", ".ply")
"""Of meshes; where a subfolder has several, the first of these, since a PLY may be a cloud of
points.
"""


@dataclass(frozen=True)
class MeshFolder:
    """A folder of one's own meshes, and their unit.

    Attributes:
        path: The folder.
        scale: What makes the meshes' lengths metres; 0.001 for millimetres.
    """

    path: Path
    scale: float = 1.0

    @property
    def key(self) -> str:
        """Return the hash of the meshes' contents: what its objects depend on."""
        content = sha256(repr(self.scale).encode())
        for name, file in _files(self.path).items():
            content.update(name.encode() + file.read_bytes())
        return content.hexdigest()


@dataclass(frozen=True, eq=False)
class MeshObjects:
    """The objects of a mesh folder.

    Attributes:
        templates: Name to parts in metres; of the usable ones.
        warnings: What was repaired in a mesh, and what was left out and why.
    """

    templates: dict[str, tuple[Part, ...]]
    warnings: tuple[str, ...]


@lru_cache(maxsize=4)
def read_folder(folder: MeshFolder) -> MeshObjects:
    """Read one object for each subfolder, named after it, of its first mesh at any depth; and for
    each mesh beside them.

    Raises:
        InputError: There is no such folder, it has no meshes, one of them is no mesh, or none is
            usable.
    """
    files = _files(folder.path)
    if not files:
        what = "no meshes in this folder" if folder.path.is_dir() else "no such folder"
        remedy = (
            f"One of {', '.join(SUFFIXES)} in a subfolder for each object"
            if folder.path.is_dir()
            else ""
        )
        raise InputError(what, file=folder.path, remedy=remedy)

    found: dict[str, tuple[Part, ...]] = {}
    warnings: list[str] = []

    for name, file in files.items():
        try:
            mesh = load_mesh(file, (folder.scale, folder.scale, folder.scale))
        except InputError as error:
            raise _with_option(error, file) from None
        warnings += [f"{file}: {text}" for text in mesh.warnings]
        reason = unusable(mesh.parts)
        if reason is None:
            found[name] = mesh.parts
        else:
            warnings.append(f"{file}: left out, {reason}")

    if not found:
        raise InputError(f"none of its meshes can be used: {warnings[-1]}", file=folder.path)
    return MeshObjects(found, tuple(warnings))


def unusable(parts: tuple[Part, ...]) -> str | None:
    """Return why no data are made with a body of these parts; None when it is of a hand's size and
    rests on some face.
    """
    form = BodyGeometry(parts)
    size = float(np.ptp(form.corners, axis=0).max())
    if not SMALLEST < size < LARGEST:
        return (
            f"it is {size:.3g} m large, and not between {SMALLEST} and {LARGEST} m; "
            f"--mesh-scale makes it metres"
        )
    return None if form.faces else "it rests on no face"


def _files(folder: Path) -> dict[str, Path]:
    """Return the meshes by name."""
    found: dict[str, Path] = {}
    by_place: dict[Path, list[Path]] = {}
    for file in files_below(folder):
        if file.suffix.lower() in SUFFIXES:
            by_place.setdefault(folder / file.relative_to(folder).parts[0], []).append(file)

    for place in sorted(by_place):
        first = min(by_place[place], key=lambda file: (SUFFIXES.index(file.suffix.lower()), file))
        found.setdefault(place.name if place.is_dir() else place.stem, first)
    return found


def _with_option(error: InputError, file: Path) -> InputError:
    """Reword a mistake of units, which is mended by an option here, where a problem file has a
    key.
    """
    remedy = error.remedy.replace("say scale: ", "say --mesh-scale ")
    return InputError(
        error.message,
        file=error.file or file,
        line=error.line,
        choices=error.choices,
        remedy=remedy,
    )
