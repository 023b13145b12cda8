"""The gripper in a URDF: what hangs on the arm's tip, and its two fingers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from tamp.commands.robot_folder.arm import GRIPPER, LinkGroup, outwards
from tamp.commands.robot_folder.description import MOVING, Description
from tamp.commands.robot_folder.joint_motion import stands
from tamp.errors import InputError
from tamp.geometric.loading.urdf_link import Element
from tamp.geometric.robot.urdf import Joint
from tamp.geometric.scene.pose import Array, Pose

BODIES = (*GRIPPER, "hand", "palm")
"""Words in the names of links that are bodies of grippers."""


def tip_is_hand(description: Description, tip: str, fingers: Sequence[Joint]) -> bool:
    """Check whether the tip itself is what carries the fingers: nothing else with a shape hangs on
    it.
    """
    below = {finger.child for finger in fingers}
    for joint in outwards(description, tip):
        if joint.parent in below:
            below.add(joint.child)
        elif joint.child not in below and description.links[joint.child]:
            return False
    return True


def tip_is_replaced(description: Description, tip: str) -> bool:
    """Check whether the tip is the body of a gripper of which a jaw hangs on it: one of ours takes
    the place of both.
    """
    carries = any(
        joint.parent == tip and joint.kind in MOVING for joint in description.joints.values()
    )
    return carries and any(word in tip.lower() for word in BODIES)


def find_hand(
    description: Description,
    tip: str,
    fingers: tuple[Joint, Joint],
    fixed: Mapping[str, float],
    bare: bool = False,
) -> tuple[LinkGroup, tuple[Joint, Joint], tuple[LinkGroup, LinkGroup]]:
    """Find the hand, the fingers' joints with their origins in the tip's frame, and the fingers;
    `bare`: the tip's own shapes are the hand's.

    Raises:
        InputError: The fingers do not hang on the tip.
    """
    roots = {finger.child: finger for finger in fingers}
    place: dict[str, tuple[str, Array]] = {tip: (tip, np.eye(4))}
    origins: dict[str, Array] = {}
    for joint in outwards(description, tip):
        owner, T = place[joint.parent]
        T = T @ joint.origin.matrix
        if joint.child in roots and owner == tip:
            origins[joint.child] = T
            place[joint.child] = joint.child, np.eye(4)
        else:
            place[joint.child] = owner, T @ stands(description, joint, fixed)

    for finger in fingers:
        if finger.child not in origins:
            raise InputError(
                f"the gripper: joint '{finger.name}' does not hang on the arm's tip '{tip}'",
                file=description.file,
                remedy="Name a tip above the fingers, such as the link that carries the hand",
            )

    hand = f"{tip}_hand"
    joints = [
        replace(one, parent=hand, origin=Pose.from_matrix(origins[one.child])) for one in fingers
    ]
    groups = [
        _group(description, place, owner, owner == tip and not bare) for owner in (tip, *roots)
    ]
    return (
        replace(groups[0], name=hand), (joints[0], joints[1]), (groups[1], groups[2]),
    )  # fmt: skip


def _group(
    description: Description, place: Mapping[str, tuple[str, Array]], owner: str, below: bool
) -> LinkGroup:
    """Collect what moves with a link; `below`: without the link itself."""
    links = [
        link for link, (own, _) in place.items() if own == owner and not (below and link == owner)
    ]
    elements: list[Element] = []
    for link in links:
        pose = Pose.from_matrix(place[link][1])
        elements += [
            Element(pose @ one.pose, one.shape, one.mesh, one.scale)
            for one in description.links[link]
        ]
    mass = sum(description.masses[link] for link in links)
    return LinkGroup(owner, tuple(elements), mass, tuple(links))
