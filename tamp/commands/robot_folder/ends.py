"""Ends of the arms of a URDF: a flange, or a hand whose fingers hang on it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tamp.commands.robot_folder.arm import FEWEST, outwards
from tamp.commands.robot_folder.description import MOVING, Description
from tamp.errors import InputError
from tamp.geometric.robot.urdf import Joint

FRAMES = ("tool", "flange", "eef", "ee_", "attachment")
"""Words in the names of frames where grippers are bolted to."""

FINGERS = ("finger", "knuckle", "jaw", "thumb", "gripper", "hand_")
"""Words in the names of joints that move a gripper's fingers, and no wrist."""

WRISTS = ("yaw", "pitch", "roll", "wrist", "arm")
"""Words in the names of joints that move a gripper as a whole."""

FREE = ("floating", "planar")
"""Kinds of joints that stand for a base that moves."""

SHOWN = 8
"""Choices that an error names."""


@dataclass(frozen=True)
class End:
    """One way to take an arm out of a URDF.

    Attributes:
        base: The link that it begins with: the root, or what a free or planar joint moves.
        tip: The link that it ends with.
        joints: Moving ones between.
        fingers: Two sliding joints of a gripper below the tip, by name.
        turning: Whether a gripper hangs there whose fingers turn: ours takes its place.
    """

    base: str
    tip: str
    joints: int
    fingers: tuple[str, str] | None = None
    turning: bool = False


def choose_end(description: Description, closes: Callable[[End], bool] = lambda _: True) -> End:
    """Return the only end of a URDF with one chain.

    Args:
        description: The URDF.
        closes: Whether the fingers of an end make a gripper; only such are named in a choice.

    Raises:
        InputError: There is none, or which there are.
    """
    found = ends(description)
    if len(found) == 1:
        return found[0]
    if not found:
        raise InputError(
            "no chain of joints that move", file=description.file,
            remedy="A URDF of an arm is expected; expand it with xacro first if it has macros",
        )  # fmt: skip
    shown = ", ".join(
        f"--arm {end.base} {end.tip}{_own(end) if closes(end) else ''}" for end in found[:SHOWN]
    )
    raise InputError(
        f"the URDF branches: {len(found)} chains end somewhere", file=description.file,
        remedy=f"Say which is the arm: {shown}",
    )  # fmt: skip


def _own(end: End) -> str:
    return "" if end.fingers is None else f" --gripper {' '.join(end.fingers)}"


def ends(description: Description) -> tuple[End, ...]:
    """List where chains of moving joints end, those with the most joints first: the last link
    before a gripper, before other branches, or before nothing.
    """
    found: list[End] = []

    def follow(base: str, link: str, way: Sequence[str], moved: int) -> None:
        """Go on from a link; `way`: the links since the last moving joint, itself the last."""
        branches = _branches(description, link)
        if len(branches) == 1 and branches[0].kind not in MOVING:
            only = branches[0]
            free = only.kind in FREE
            follow(only.child if free else base, only.child, (*way, only.child), moved)
            return

        fingers = [joint for joint in branches if is_finger(description, joint)]
        if moved >= FEWEST and fingers and len(fingers) == len(branches):
            found.append(_hand_end(base, fingers, way, moved))
            return

        if not branches:
            if moved >= FEWEST:
                found.append(End(base, _flange(description, link), moved))
            return

        for joint in branches:
            moves = joint.kind in MOVING
            start = joint.child if joint.kind in FREE else base
            follow(
                start, joint.child, (joint.child,) if moves else (*way, joint.child), moved + moves
            )

    follow(description.root, description.root, (description.root,), 0)
    return tuple(sorted(found, key=lambda end: -end.joints))


def _branches(description: Description, link: str) -> list[Joint]:
    """List the joints that a link carries and that move something, wheels left out."""
    children = [joint for joint in description.joints.values() if joint.parent == link]
    return [
        joint for joint in children
        if any(one.kind in MOVING for one in (joint, *outwards(description, joint.child)))
    ]  # fmt: skip


def is_finger(description: Description, joint: Joint) -> bool:
    """Check whether the first joint that moves from here on moves a finger."""
    first = next(one for one in (joint, *outwards(description, joint.child)) if one.kind in MOVING)
    names = (first.name.lower(), first.child.lower())
    if any(word in names[0] for word in WRISTS) and "finger" not in names[0]:
        return False
    return first.name in description.mimics or any(
        word in name for word in FINGERS for name in names
    )


def _hand_end(base: str, fingers: Sequence[Joint], way: Sequence[str], moved: int) -> End:
    """End above a hand: where it is bolted on."""
    above = way[-2] if len(way) > 1 else way[-1]
    if len(fingers) == 2 and all(joint.kind == "prismatic" for joint in fingers):
        return End(base, above, moved, (fingers[0].name, fingers[1].name))
    named = [link for link in way[:-1] if any(word in link.lower() for word in FRAMES)]
    return End(base, (named or [above])[0], moved, turning=True)


def _flange(description: Description, link: str) -> str:
    """Return the frame at a chain's last link where a gripper is bolted on, else the link."""
    fixed = [joint.child for joint in description.joints.values() if joint.parent == link]
    frames = [name for name in fixed if not description.links[name]]
    named = [name for name in frames if any(word in name for word in FRAMES)]
    return (named or (frames if len(frames) == 1 else []) or [link])[0]
