"""Robots as data. Nothing else in the code names one."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from tamp.geometric.robot.urdf import Joint
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Part

LIMIT_MARGIN_RAD = math.radians(0.5)
"""Radians that plans keep from a joint's limits; of one that slides a tenth as many metres."""

TURNING_RADII_M = (0.05, 20.0)
"""Of the tightest circle of a car: the least and the most."""

DRIVES = ("omnidirectional", "differential", "car", "fixed")
"""How a base moves: in any direction, turning on the spot and straight ahead, along arcs and
straight ahead, or not at all."""


@dataclass(frozen=True)
class Link:
    """A rigid link: convex parts in the link's own frame."""

    name: str
    parts: tuple[Part, ...]


@dataclass(frozen=True)
class Suction:
    """A suction cup, its rim about the tool's origin and across the tool's z.

    Attributes:
        radius: Of the rim, metres.
        tilt: By how much what it seals on may lean against its axis, radians.
    """

    radius: float
    tilt: float


@dataclass(frozen=True)
class Robot:
    """A base that carries an arm with a parallel gripper, or with a suction cup.

    A configuration is [base x, base y, base yaw, q1..qn] in metres and radians, or metres for a
    prismatic joint.

    Attributes:
        links: All of them: base, foot, those of the arm's joints, hand, fingers.
        base, foot, hand: Names of links: what stands on the floor, what the arm begins with, and
            what carries the fingers, or the cup. The arm's and the fingers' own are their joints'
            children.
        T_base_arm: The arm's foot in the base's frame, which is on the floor under the base's
            centre.
        joints: The arm's, from the foot on; each turns about its own z, or slides along it.
        T_flange_hand: The hand in the last arm link's frame.
        T_hand_tool: The tool in the hand's frame: between the pads, z along the fingers, y the
            closing direction. Of a cup: in the middle of its rim, z out of it.
        fingers: The left and the right finger's prismatic joint; at opening w each stands at w / 2.
            A suction gripper has none.
        lower, upper: The range of the arm's joints in plans: the maker's, LIMIT_MARGIN_RAD less on
            both sides.
        velocity, acceleration: Limits of base x, base y, base yaw and the joints, per second
            (squared).
        home: The arm's compact carrying configuration, in which the base drives.
        opening: The largest opening of the fingers, metres; 0 of a suction gripper.
        force: With which each finger presses, or the most that a cup pulls with, newtons.
        payload: The most that the arm lifts, kilograms.
        allowed: Pairs of links, each sorted, that are never checked for collision.
        urdf: The arm's and the hand's description.
        folder: Where the robot is kept: robot.yaml, geometry.npz and reachability.npz.
        drive: One of DRIVES.
        turning_radius: Of a car, metres: of the tightest circle that the base's centre drives.
        locked: Index of the joint that, fixed, leaves an arm that closed-form inverse kinematics
            knows; None where there is none.
        effort: The most that each of the arm's joints exerts, newton metres or newtons.
        suction: The cup of a suction gripper; None where fingers grasp.
        arm: The arm's name among those of one body.
        prefix: What the names of the arm's links and joints begin with, beside those in its URDF.
        beside: The other arms of one body: each a robot of the same base and links, which holds
            this arm still. An arm alone has none.
        still_links: Links that are not the arm's and stand still: their poses in the base's frame.
        tabled: Of an arm of a body: the folder of the robot whose table of reach it takes, and that
            one's foot in its base's frame. None: the robot's own.
        described: Folders with the covers of links, each with what the links' names begin with
            beside those in the folder; none: the robot's own.
    """

    name: str
    links: tuple[Link, ...]
    base: str
    foot: str
    hand: str
    T_base_arm: Pose
    joints: tuple[Joint, ...]
    T_flange_hand: Pose
    T_hand_tool: Pose
    fingers: tuple[Joint, ...]
    lower: tuple[float, ...]
    upper: tuple[float, ...]
    velocity: tuple[float, ...]
    acceleration: tuple[float, ...]
    home: tuple[float, ...]
    opening: float
    allowed: frozenset[tuple[str, str]]
    urdf: Path
    folder: Path
    drive: str = "omnidirectional"
    turning_radius: float | None = None
    locked: int | None = None
    effort: tuple[float, ...] = field(default=())
    force: float = 50.0
    payload: float = math.inf
    suction: Suction | None = None
    arm: str = "arm"
    prefix: str = ""
    beside: tuple[Robot, ...] = ()
    still_links: Mapping[str, Pose] = field(default_factory=dict[str, Pose])
    described: tuple[tuple[str, Path], ...] = ()
    tabled: tuple[Path, Pose] | None = None

    def link(self, name: str) -> Link:
        """Return the link of that name.

        Raises:
            KeyError: There is none.
        """
        return next((link for link in self.links if link.name == name), None) or _no_link(name)

    @property
    def finger_links(self) -> tuple[Link, ...]:
        """Return the links of the fingers, in the order of their joints."""
        return tuple(self.link(finger.child) for finger in self.fingers)

    @property
    def finger_speed(self) -> float:
        """Return the speed of each finger, metres a second; 0 where there are none."""
        return min((finger.velocity for finger in self.fingers), default=0.0)

    @property
    def grippers(self) -> frozenset[str]:
        """Return the names of the links that grasp: the hand and the fingers."""
        return frozenset((self.hand, *(finger.child for finger in self.fingers)))

    @property
    def prismatic(self) -> tuple[bool, ...]:
        """Return for each joint of the arm whether it slides."""
        return tuple(joint.kind == "prismatic" for joint in self.joints)

    def frame_of(self, name: str) -> tuple[int, Pose]:
        """Return which frame moves a link, and the link's pose in it: 0 for the base's frame, k for
        that of the arm's k-th joint. A finger's is that of the closed hand.
        """
        if name == self.base:
            return 0, Pose()
        if name == self.foot:
            return 0, self.T_base_arm
        if name in self.still_links:
            return 0, self.still_links[name]
        for number, joint in enumerate(self.joints, start=1):
            if joint.child == name:
                return number, Pose()
        return len(self.joints), self.T_flange_hand

    @property
    def arms(self) -> tuple[Robot, ...]:
        """Return all arms of the body, this one first."""
        return (replace(self, beside=()), *self.beside)

    @property
    def files(self) -> tuple[Path, ...]:
        """Return the files that a plan for this robot rests on."""
        names = ("robot.yaml", "geometry.npz", "reachability.npz")
        folders = dict.fromkeys((self.folder, *(folder for _, folder in self.described)))
        files = (folder / name for folder in folders for name in names)
        return tuple(file for file in files if not self.described or file.is_file())


def _no_link(name: str) -> Link:
    raise KeyError(name)
