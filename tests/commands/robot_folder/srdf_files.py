"""SRDFs of the arm of boxes, written beside its URDF."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from tamp.commands.robot import Make, _wanted  # pyright: ignore[reportPrivateUsage]
from tamp.commands.robot_folder.description import read_description
from tamp.commands.robot_folder.srdf import Srdf, read_srdf
from tamp.commands.robot_folder.wanted import Wanted
from tests.commands.robot_folder.urdf import arm_text

HEAD = """
<link name="neck"/><link name="eyes"/>
<joint name="nod" type="revolute"><parent link="foot"/><child link="neck"/><limit lower="-1" upper="1"/></joint>
<joint name="look" type="revolute"><parent link="neck"/><child link="eyes"/><limit lower="-1" upper="1"/></joint>
"""

JOINTS = ("pan", "lift", "elbow", "wrist1", "wrist2", "wrist3")
ARM = """<group name="arm"><chain base_link="foot" tip_link="tool"/></group>"""

GRIPPER = """<group name="hand"><link name="hand"/><joint name="left_finger_joint"/></group>
<end_effector name="gripper" parent_link="tool" group="hand"/>"""

MIMIC = '<mimic joint="left_finger_joint"/>'
UPRIGHT = (0.0, -0.8, 1.9, 0.45, 0.0, 0.0)
"""A configuration of the arm of boxes in which it may drive."""


def state(name: str, values: dict[str, float] | tuple[float, ...]) -> str:
    """Write a state of the arm."""
    named = values if isinstance(values, dict) else dict(zip(JOINTS, values, strict=True))
    inside = "".join(f'<joint name="{joint}" value="{value}"/>' for joint, value in named.items())
    return f'<group_state name="{name}" group="arm">{inside}</group_state>'


def off(first: str, second: str, reason: str = "Never") -> str:
    """Write a pair that is not to be checked."""
    return f'<disable_collisions link1="{first}" link2="{second}" reason="{reason}"/>'


def write(folder: Path, srdf: str, urdf: str, name: str = "arm.srdf", robot: str = "boxes") -> Path:
    """Write the arm and an SRDF beside it, whose first entry is on its second line; return the
    arm's file.
    """
    (folder / "arm.urdf").write_text(urdf, encoding="utf-8")
    file = folder / name
    file.parent.mkdir(exist_ok=True)
    file.write_text(f'<robot name="{robot}">\n{srdf}\n</robot>\n', encoding="utf-8")
    return folder / "arm.urdf"


def settled(folder: Path, srdf: str, urdf: str, **options: object) -> Wanted:
    """Settle the choices for an arm with an SRDF beside it."""
    file = write(folder, srdf, urdf)
    return _wanted(replace(Make(str(file), folder / "out"), **options), file)


def read(folder: Path, srdf: str, urdf: str | None = None) -> Srdf:
    """Read an SRDF of the arm."""
    file = write(folder, srdf, urdf or arm_text())
    return read_srdf(folder / "arm.srdf", read_description(file))
