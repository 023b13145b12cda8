"""The SRDF beside a URDF: where packages of descriptions and of MoveIt's settings have it."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from dataclasses import replace
from itertools import islice
from pathlib import Path

from tamp.commands.robot_folder.description import Description
from tamp.commands.robot_folder.srdf import Srdf, read_srdf
from tamp.errors import InputError
from tamp.geometric.loading.xml_file import read_xml

MOST = 50
"""SRDFs that are looked at beside one URDF."""

BESIDE = ("*.srdf", "config/*.srdf", "srdf/*.srdf")
"""In the URDF's folder and in the one above it;"""

PACKAGES = "*moveit_config/config/*.srdf"
"""in these, and in the one above the URDF's package."""


def srdf_for(
    description: Description, named: Path | None, urdf: Path
) -> tuple[Srdf | None, tuple[str, ...]]:
    """Read the SRDF that was named, or the one found beside the URDF; return sentences about it.

    Args:
        description: The URDF.
        named: By the user.
        urdf: The file that the user named, which may be an MJCF.

    Raises:
        InputError: The named one cannot be read; one that was found and cannot is a sentence.
    """
    if named is not None:
        if not named.is_file():
            raise InputError(f"--srdf: no such file: {named}")
        found = read_srdf(named, description)
        return found, found.remarks

    file, remarks = _choose(sorted(_beside(urdf.absolute())), description.name, urdf.stem)
    if file is None:
        return None, tuple(remarks)
    try:
        found = read_srdf(file, description)
    except InputError as error:
        return None, (*remarks, f"{error}: not read")
    return replace(found, remarks=()), (*remarks, f"{file} is read, too", *found.remarks)


def _beside(urdf: Path) -> Iterator[Path]:
    """List SRDFs where they usually lie."""
    folder, package = urdf.parent, urdf.parent.parent
    patterns = [(one, pattern) for one in (folder, package) for pattern in BESIDE[one != folder :]]
    patterns += [(one, PACKAGES) for one in (folder, package, package.parent)]
    with contextlib.suppress(OSError):  # a folder that may not be looked into
        found = (file for one, pattern in patterns for file in one.glob(pattern))
        yield from islice(dict.fromkeys(file for file in found if file.is_file()), MOST)


def _choose(files: list[Path], robot: str, stem: str) -> tuple[Path | None, list[str]]:
    """Choose the file for a robot: by its name, then by the file's."""
    names: dict[Path, str] = {}
    remarks: list[str] = []
    for file in files:
        try:
            names[file] = read_xml(file).get("name", "")
        except InputError as error:
            remarks.append(f"{error.at(file)}: not read")

    same = [file for file, name in names.items() if name == robot] or [
        file for file in names if file.stem == stem or not robot
    ]
    for wanted in (stem, robot):
        exact = [file for file in same if file.stem == wanted]
        if len(exact) == 1:
            return exact[0], remarks
    if len(same) == 1:
        return same[0], remarks

    if same:
        shown = ", ".join(str(file) for file in same)
        remarks.append(f"several SRDFs are for '{robot}', none is read: --srdf says which: {shown}")
    elif names:
        shown = ", ".join(sorted({f"{file.name} (for '{name}')" for file, name in names.items()}))
        remarks.append(f"no SRDF for '{robot}' beside the URDF, only {shown}: --srdf takes one")
    return None, remarks
