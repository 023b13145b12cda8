"""URDFs for tests: an arm of boxes with any joints."""

from __future__ import annotations

import re
from pathlib import Path

INERTIAL = '<inertial><mass value="1.5"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>'
SIX = (
    ("pan", "revolute", "0 0 1", "0 0 0.1", "-3.1 3.1"),
    ("lift", "revolute", "0 1 0", "0 0.1 0.06", "-3.1 3.1"),
    ("elbow", "revolute", "0 1 0", "0 -0.1 0.4", "-2.9 2.9"),
    ("wrist1", "revolute", "0 1 0", "0 0 0.35", "-3.1 3.1"),
    ("wrist2", "revolute", "0 0 1", "0 0.1 0", "-3.1 3.1"),
    ("wrist3", "continuous", "0 1 0", "0 0 0.1", ""),
)
"""An arm like many on sale: name, kind, axis, origin and limits of each joint."""

LIFT = ("lift0", "prismatic", "0 0 1", "0 0 0.1", "0 0.3")

FIVE = (
    ("pan", "revolute", "0 0 1", "0 0 0.1", "-3.1 3.1"),
    ("lift", "revolute", "1 0 0", "0.06 0 0.06", "-3.1 3.1"),
    ("elbow", "revolute", "1 0 0", "-0.06 0 0.4", "-2.9 2.9"),
    ("wrist", "revolute", "1 0 0", "0 0 0.35", "-3.1 3.1"),
    ("roll", "continuous", "0 1 0", "0 0.1 0", ""),
)
"""An arm of a desk: the tool stays in the upright plane through the first joint's axis."""


def arm_text(joints=SIX, extra: str = "") -> str:
    """A URDF whose link after each joint is a box along the way to the next."""
    lines = ['<robot name="boxes">', _link("foot", "0.12 0.12 0.1", "0 0 0.05")]
    parent = "foot"
    for number, (name, kind, axis, origin, limits) in enumerate(joints):
        after = joints[number + 1][3] if number + 1 < len(joints) else "0 0.05 0"
        x, y, z = (float(word) for word in after.split())
        size = " ".join(f"{max(0.05, abs(word) - 0.04):.3f}" for word in (x, y, z))
        lines.append(_link(f"{name}_link", size, f"{x / 2} {y / 2} {z / 2}"))
        limit = ""
        if limits:
            low, high = limits.split()
            limit = f'<limit lower="{low}" upper="{high}" velocity="2" effort="2000"/>'
        lines.append(
            f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{name}_link"/>'
            f'<origin xyz="{origin}"/><axis xyz="{axis}"/>{limit}</joint>'
        )
        parent = f"{name}_link"
    lines.append(
        f'<link name="tool"/><joint name="tool_joint" type="fixed"><parent link="{parent}"/><child link="tool"/>'
        '<origin xyz="0 0.06 0" rpy="-1.5708 0 0"/></joint>'
    )
    return "\n".join([*lines, extra, "</robot>"]) + "\n"


def write_arm(folder: Path, joints=SIX, extra: str = "") -> Path:
    """Write it."""
    file = folder / "arm.urdf"
    file.write_text(arm_text(joints, extra), encoding="utf-8")
    return file


def _link(name: str, size: str, at: str) -> str:
    return (
        f'<link name="{name}">{INERTIAL}<collision><origin xyz="{at}"/>'
        f'<geometry><box size="{size}"/></geometry></collision></link>'
    )


BODY = """
<link name="body"><inertial><mass value="30"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
<collision><origin xyz="0 0 0.28"/><geometry><box size="0.5 0.7 0.5"/></geometry></collision></link>
"""


def two_armed() -> str:
    """Write a body with the arm of boxes on its left and on its right."""
    text = '<robot name="two">' + BODY
    for side, y in (("l", 0.22), ("r", -0.22)):
        inside = re.sub(r"</?robot[^>]*>", "", arm_text())
        inside = re.sub(r'\b(link name|joint name|link)="', rf'\1="{side}_', inside)
        text += inside + (
            f'<joint name="{side}_stands" type="fixed"><parent link="body"/><child link="{side}_foot"/>'
            f'<origin xyz="0.1 {y} 0.53"/></joint>'
        )
    return text + "</robot>"
