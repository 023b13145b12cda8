"""Links of a URDF that are left out of the robot that is made: another arm of its body."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from tamp.commands.robot_folder.arm import outwards
from tamp.commands.robot_folder.description import MOVING, Description, read_description
from tamp.commands.robot_folder.wanted import Wanted
from tamp.errors import InputError


def description_for(wanted: Wanted) -> Description:
    """Read the URDF that is wanted, without the shapes and masses of the links that are left out.

    Raises:
        InputError: As `read_description`; a link to be left out is unknown.
    """
    description = read_description(wanted.urdf)
    if not wanted.without:
        return description
    gone = left_out(description, wanted.without, wanted.base or description.root, wanted.tip)
    return replace(
        description,
        links={name: () if name in gone else some for name, some in description.links.items()},
        masses={name: 0.0 if name in gone else mass for name, mass in description.masses.items()},
    )


def left_out(description: Description, links: Sequence[str], base: str, tip: str) -> frozenset[str]:
    """List links and all that hangs on them, but for the arm between base and tip.

    Raises:
        InputError: One is unknown.
    """
    first, link = "", tip
    while link != base and (joint := description.joint_to(link)) is not None:
        first = joint.child if joint.kind in MOVING else first
        link = joint.parent
    arm = {first, *(joint.child for joint in outwards(description, first))}

    gone: set[str] = set()
    for name in links:
        if name not in description.links:
            raise InputError(f"--without: unknown link '{name}'", file=description.file, found=name,
                             choices=tuple(description.links))  # fmt: skip
        gone |= {name, *(joint.child for joint in outwards(description, name))}
    return frozenset(gone - arm)
