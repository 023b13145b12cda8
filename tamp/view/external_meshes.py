"""Meshes from elsewhere: what a page shows, its reader has."""

from __future__ import annotations

import importlib.util
import os
from collections.abc import Iterable
from pathlib import Path

from tamp.errors import InputError
from tamp.system.files import shipped

PUBLIC = ("pybullet_data", "tamp", "grounding")
"""Packages whose meshes anybody has, as those of shipped problems."""


def check_inside(meshes: Iterable[Path], problem: Path) -> None:
    """Refuse to put meshes into a page that do not lie beside or below the problem that names them.

    A problem from somebody else may name any file of this machine, and the page may go to anybody.

    Raises:
        InputError: The first such mesh.
    """
    folders = [Path(os.path.realpath(problem)).parent, *_public()]
    for mesh in meshes:
        if not any(Path(os.path.realpath(mesh)).is_relative_to(folder) for folder in folders):
            what = "the page would show this mesh, which is outside of the problem's folder"
            remedy = "Move it there, or say that its shape may be given away: --allow-outside"
            raise InputError(what, file=mesh, remedy=remedy)


def _public() -> list[Path]:
    found = [importlib.util.find_spec(name) for name in PUBLIC]
    folders = [
        Path(spec.origin).resolve().parent
        for spec in found
        if spec is not None and spec.origin is not None
    ]
    return [*folders, shipped("problems").resolve()]
