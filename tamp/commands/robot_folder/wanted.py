"""The choices that a robot is made by."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from tamp.commands.robot_folder.srdf import Srdf


@dataclass(frozen=True)
class Wanted:
    """The choices that a robot is made by.

    Attributes:
        urdf: The URDF.
        base, tip: The links between which the arm is; no base means the robot's root.
        out: The folder that is made.
        drive: One of `robot.DRIVES`.
        turning_radius: Of a car, metres.
        fingers: Two prismatic joints of the URDF's own gripper; without them ours is bolted to
            the tip.
        opening: The gripper's largest, metres.
        force: With which each finger presses, or a cup pulls at most, newtons; None for the usual.
        suction: The radius of the rim of a suction cup, metres; None for fingers.
        payload: Kilograms.
        mount: Where the arm's root is on the base: x, y, z in metres and yaw in radians.
        axis: Of the tip, along which our gripper points: x, -x, y, ...; None finds it.
        height: Metres at which an arm that does not drive is bolted to something.
        home: Its carrying configuration.
        fixed: Where joints stand that are no part of the arm.
        without: Links that are left out, with all that hangs on them but the arm.
        srdf: What MoveIt is told about the robot: its states and pairs are proposals.
        remarks: Sentences about how these choices were made.
    """

    urdf: Path
    tip: str
    out: Path
    base: str | None = None
    drive: str = "omnidirectional"
    turning_radius: float | None = None
    fingers: tuple[str, str] | None = None
    opening: float | None = None
    force: float | None = None
    suction: float | None = None
    payload: float = math.inf
    mount: tuple[float, float, float, float] | None = None
    axis: str | None = None
    height: float = 0.0
    home: tuple[float, ...] | None = None
    fixed: Mapping[str, float] = field(default_factory=dict[str, float])
    without: tuple[str, ...] = ()
    srdf: Srdf | None = None
    remarks: tuple[str, ...] = ()
