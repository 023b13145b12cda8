"""Grippers that a robot is made with: ours, bolted to the arm's tip, or the URDF's own."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tamp.commands.robot_folder.arm import Arm
from tamp.commands.robot_folder.convex import hull_of
from tamp.errors import InputError
from tamp.geometric.robot.robot import Suction
from tamp.geometric.robot.urdf import Joint
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Hull

AXES = ("x", "-x", "y", "-y", "z", "-z")
"""Of the arm's tip, along which a gripper can point."""

TIP = 0.0094
"""Metres by which the finger tips reach beyond the tool's origin."""

PALM = (0.05, 0.13, 0.06)
"""Edge lengths of our gripper's palm, metres: across, along the fingers' way, out of the arm."""

FINGER = (0.02, 0.014, 0.055)
"""The same of each finger."""

WIDEST = 0.2
"""Metres: the largest opening that our gripper can be made with."""


SMALLEST_CUP, LARGEST_CUP = 0.003, 0.15
"""Metres: radii of the rims that our suction gripper can be made with."""

MOST_VACUUM, USUAL_VACUUM = 101_325.0, 60_000.0
"""Newtons a square metre: the air's, which no cup exceeds, and that of a usual ejector."""

CUP_TILT_RAD = math.radians(5.0)
"""Radians by which what a cup seals on may lean against it."""

USUAL_SPEED = 0.05
"""Metres a second of a finger of which nobody says more."""

STALK = 0.06
"""Metres from the palm to the rim of our cup."""

CUP_CORNERS = 24
"""Corners of the prism that stands for a cup; its rim is within."""


@dataclass(frozen=True, eq=False)
class Gripper:
    """A parallel gripper, or a suction cup, which has no fingers.

    Attributes:
        hand: The palm's hulls in the hand's frame.
        fingers: The left and the right finger's prismatic joint, 0 where they meet.
        finger_hulls: Hulls of each in its frame.
        T_tip_hand: The hand in the arm's tip.
        T_hand_tool: The tool in the hand: z out of it, y the closing direction.
        opening: The largest, metres.
        force: Newtons with which each finger presses.
        mass: Kilograms.
        suction: The cup.
    """

    hand: tuple[Hull, ...]
    fingers: tuple[Joint, ...]
    finger_hulls: tuple[tuple[Hull, ...], ...]
    T_tip_hand: Pose
    T_hand_tool: Pose
    opening: float
    force: float
    mass: float = 0.9
    suction: Suction | None = None

    @property
    def name(self) -> str:
        """Return the name of the hand's link."""
        return self.fingers[0].parent if self.fingers else "hand"


def two_fingers(opening: float, force: float, T_tip_hand: Pose) -> Gripper:
    """Make our gripper: a box with two boxes as fingers, as wide as it opens.

    Raises:
        InputError: It could not close, or is wider than any.
    """
    if not 0.01 <= opening <= WIDEST:
        raise InputError(
            f"--opening {opening:g}: a gripper opens from 0.01 to {WIDEST:g} m",
            remedy="Give its largest opening in metres",
        )
    across, along, out = PALM
    along = max(along, opening + 4 * FINGER[1])
    palm = _box((across, along, out), (0.0, 0.0, out / 2))

    fingers: list[Joint] = []
    hulls: list[tuple[Hull, ...]] = []
    for name, side in (("left", 1.0), ("right", -1.0)):
        centre = (0.0, side * FINGER[1] / 2, FINGER[2] / 2)
        hulls.append((_box(FINGER, centre),))
        fingers.append(
            Joint(f"{name}_finger_joint", "prismatic", "hand", f"{name}_finger",
                  Pose((0.0, 0.0, out)), (0.0, side, 0.0), 0.0, opening / 2, USUAL_SPEED)
        )  # fmt: skip
    tool = Pose((0.0, 0.0, out + FINGER[2] - TIP))
    return Gripper(
        (palm,), (fingers[0], fingers[1]), (hulls[0], hulls[1]), T_tip_hand, tool, opening, force
    )


def suction_cup(radius: float, force: float | None, T_tip_hand: Pose) -> Gripper:
    """Make our suction gripper: a box that carries a cup whose rim has this radius.

    Raises:
        InputError: The cup is of no use, or is to pull with more than the air presses.
    """
    if not SMALLEST_CUP <= radius <= LARGEST_CUP:
        raise InputError(
            f"--suction {radius:g}: the rim of a cup has a radius of {SMALLEST_CUP:g} to "
            f"{LARGEST_CUP:g} m",
            remedy="Give its radius in metres",
        )

    area = math.pi * radius**2
    if force is not None and force > MOST_VACUUM * area:
        raise InputError(
            f"--force {force:g}: a cup of radius {radius:g} m pulls with "
            f"{MOST_VACUUM * area:.3g} N at most",
            remedy="The air presses with no more: give a larger --suction or a smaller --force",
        )

    side = PALM[0]
    palm = _box((side, side, PALM[2]), (0.0, 0.0, PALM[2] / 2))
    angles = (np.arange(CUP_CORNERS) + 0.5) * 2 * math.pi / CUP_CORNERS
    rim = radius / math.cos(math.pi / CUP_CORNERS)
    ring = rim * np.column_stack([np.cos(angles), np.sin(angles)])
    ends = [np.column_stack([ring, np.full(CUP_CORNERS, z)]) for z in (PALM[2], PALM[2] + STALK)]
    cup = hull_of(np.concatenate(ends), "gripper")
    return Gripper(
        (palm, cup), (), (), T_tip_hand, Pose((0.0, 0.0, PALM[2] + STALK)), 0.0,
        round(USUAL_VACUUM * area, 1) if force is None else force, 0.6,
        Suction(radius, CUP_TILT_RAD),
    )  # fmt: skip


def outward_axis(arm: Arm) -> str:
    """Find the axis of the tip that points out of the arm: that about which the last joint turns,
    away from the joints before.
    """
    T, origins = np.eye(4), []
    for joint in arm.joints:
        T = T @ joint.origin.matrix
        origins.append(T[:3, 3])
    tip = T @ arm.T_last_tip.matrix
    out = T[:3, 2]
    before = [origin for origin in reversed(origins) if abs((tip[:3, 3] - origin) @ out) > 1e-3]
    sign = 1.0 if not before or (tip[:3, 3] - before[0]) @ out > 0 else -1.0
    inside = tip[:3, :3].T @ (out * sign)
    number = int(np.argmax(np.abs(inside)))
    return AXES[2 * number + (inside[number] < 0)]


def along(axis: str) -> Pose:
    """Return a hand whose z is an axis of the tip.

    Raises:
        InputError: It is no axis.
    """
    if axis not in AXES:
        raise InputError(f"--axis: unknown axis '{axis}'", found=axis, choices=AXES)
    number = AXES.index(axis)
    z = np.eye(3)[number // 2] * (-1.0 if number % 2 else 1.0)
    x = np.eye(3)[(number // 2 + 1) % 3]
    T = np.eye(4)
    T[:3, 0], T[:3, 1], T[:3, 2] = x, np.cross(z, x), z
    return Pose() if axis == "z" else Pose.from_matrix(T)


def _box(size: tuple[float, float, float], centre: tuple[float, float, float]) -> Hull:
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    return hull_of(signs * np.array(size) / 2 + np.array(centre), "gripper")
