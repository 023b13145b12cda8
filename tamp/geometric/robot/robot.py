"""Robots as data. Nothing else in the code names one."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from tamp.geometric.robot.urdf import Joint, read_joints
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Hull, Part


@dataclass(frozen=True)
class Link:
    """A rigid link: convex parts in the link's own frame."""

    name: str
    parts: tuple[Part, ...]


@dataclass(frozen=True)
class Robot:
    """An omnidirectional base that carries an arm of seven joints with a parallel gripper.

    A configuration is [base x, base y, base yaw, q1..q7] in metres and radians.

    Attributes:
        links: The base first, then the arm's from its foot to the last, the hand, the left and the
            right finger.
        T_base_arm: The arm's foot in the base's frame, which is on the floor under the base's
            centre.
        joints: The arm's seven joints, from the foot on.
        T_flange_hand: The hand in the last arm link's frame.
        T_hand_tool: The tool in the hand's frame: between the pads, z along the fingers, y the
            closing direction.
        fingers: The left and the right finger's prismatic joint; at opening w each stands at w / 2.
        lower, upper: The range of the arm's joints in plans, radians: the maker's, MARGIN less on
            both sides.
        velocity, acceleration: Limits of base x, base y, base yaw and the joints, per second
            (squared).
        home: The arm's compact carrying configuration, in which the base drives.
        opening: The largest opening of the fingers, metres.
        force: With which each finger presses, newtons.
        payload: The most that the arm lifts, kilograms.
        allowed: Pairs of links, each sorted, that are never checked for collision.
        urdf: The arm's and the hand's description.
    """

    name: str
    links: tuple[Link, ...]
    T_base_arm: Pose
    joints: tuple[Joint, ...]
    T_flange_hand: Pose
    T_hand_tool: Pose
    fingers: tuple[Joint, Joint]
    lower: tuple[float, ...]
    upper: tuple[float, ...]
    velocity: tuple[float, ...]
    acceleration: tuple[float, ...]
    home: tuple[float, ...]
    opening: float
    allowed: frozenset[tuple[str, str]]
    urdf: Path
    force: float = 50.0
    payload: float = math.inf


MARGIN = math.radians(0.5)
"""Radians that plans keep from the limits of the arm's joints."""

PANDA_LOWER = (-2.8973, -1.7628, -2.8973, -3.0718, -2.8973, -0.0175, -2.8973)
"""The Panda's joints by its maker, radians, at least,"""

PANDA_UPPER = (2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973)
"""and at most."""


FINGER_SPEED = 0.05
"""Metres a second of each finger of Franka's hand, by its data sheet."""


def panda_mobile() -> Robot:
    """Return our box-shaped base with Franka's Panda and its hand, mounted near the base's front
    edge.

    There, rather than 5 cm further back, twice as many base poses reach the middle of a table from
    above. The collision hulls are precomputed by benchmarks/build_robot_hulls.py. Ranges and
    velocities of the joints are the maker's ("Robot and interface specifications" of the Franka
    Control Interface), not the URDF's, whose ranges are wider; accelerations are a third of the
    maker's, so that a held object is not shaken. The maker's limits of the jerk (3,750 to 10,000
    rad/s3) are not looked at: accelerations change in steps, which the arm's controller rounds off.
    """
    urdf = panda_urdf()
    named = read_joints(urdf)
    joints = tuple(named[f"panda_joint{i}"] for i in range(1, 8))

    base = Box((0.8, 0.7, 0.33))
    hulls = np.load(Path(__file__).parent / "assets" / "panda_mobile.npz")
    names = [f"panda_link{i}" for i in range(8)] + [
        "panda_hand",
        "panda_leftfinger",
        "panda_rightfinger",
    ]

    return Robot(
        name="panda_mobile",
        links=(
            Link("base", (Part(base, Pose((0.0, 0.0, 0.02 + base.size[2] / 2))),)),
            *(
                Link(name, (Part(_hull(hulls[f"{name}/vertices"], hulls[f"{name}/faces"])),))
                for name in names
            ),
        ),
        T_base_arm=Pose((0.3, 0.0, 0.35)),
        joints=joints,
        T_flange_hand=named["panda_joint8"].origin @ named["panda_hand_joint"].origin,
        T_hand_tool=Pose((0.0, 0.0, 0.1034)),
        fingers=(
            replace(named["panda_finger_joint1"], velocity=FINGER_SPEED),
            replace(named["panda_finger_joint2"], velocity=FINGER_SPEED),
        ),
        lower=tuple(low + MARGIN for low in PANDA_LOWER),
        upper=tuple(high - MARGIN for high in PANDA_UPPER),
        velocity=(0.6, 0.6, 1.0, 2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61),
        acceleration=(0.8, 0.8, 1.5, 5.0, 2.5, 3.3, 4.1, 5.0, 6.6, 6.6),
        home=(0.0, -1.0, 0.0, -2.0, 0.0, 1.0, math.pi / 4),
        opening=0.08,
        allowed=frozenset(_pairs(PANDA_ALLOWED)),
        urdf=urdf,
        force=50.0,  # the hand presses with 70 N for long, 140 N for a moment
        payload=3.0,
    )


PANDA_ALLOWED = """
base            panda_link0 panda_link1 panda_link2 panda_link3
panda_link0     panda_link1 panda_link2 panda_link3 panda_link4
panda_link1     panda_link2 panda_link3 panda_link4
panda_link2     panda_link3 panda_link4
panda_link3     panda_link4 panda_link5 panda_link6 panda_link7 panda_hand
panda_link3     panda_leftfinger panda_rightfinger
panda_link4     panda_link5 panda_link6 panda_link7 panda_hand panda_leftfinger panda_rightfinger
panda_link5     panda_link6
panda_link6     panda_link7 panda_hand panda_leftfinger panda_rightfinger
panda_link7     panda_hand panda_leftfinger panda_rightfinger
panda_hand      panda_leftfinger panda_rightfinger
panda_leftfinger panda_rightfinger
"""
"""Pairs of links that are never checked: the first of a line with each other of it.

Adjacent links and the group of hand and fingers touch by construction. The other pairs cannot meet
within the joint limits: their least distance, by random search and descent, is 1.0 cm (link0-link4)
and 3 cm or more for the rest.

link5-link7 is checked, although Panda's SRDF disables it: the hulls do overlap in 8 % of random
states, so a judge that checks all pairs would reject our plans. It costs nothing: all those states
have q6 < 0.85, most of them with the hand in collision with link5 as well, while a hand that points
down or forward has q6 > 1.
"""


def panda_urdf() -> Path:
    """Return the Panda's description, which comes with its meshes and licence
    (benchmarks/build_robot_meshes.py).
    """
    return Path(__file__).parent / "assets" / "franka_panda" / "panda.urdf"


ROBOTS: dict[str, Callable[[], Robot]] = {"panda_mobile": panda_mobile}
"""The robots that a problem can name."""


def _pairs(text: str) -> list[tuple[str, str]]:
    pairs = []
    for line in text.strip().splitlines():
        first, *others = line.split()
        pairs += [(min(first, other), max(first, other)) for other in others]
    return pairs


def _hull(vertices: np.ndarray, faces: np.ndarray) -> Hull:
    vertices.flags.writeable = faces.flags.writeable = False
    return Hull(vertices, faces)
