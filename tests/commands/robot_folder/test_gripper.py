"""Our grippers: fingers that meet and open, cups that pull no more than the air, and where they are bolted."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np
import pytest

from tamp.commands.robot_folder.arm import find_arm
from tamp.commands.robot_folder.description import read_description
from tamp.commands.robot_folder.gripper import (
    AXES,
    LARGEST_CUP,
    MOST_VACUUM,
    PALM,
    SMALLEST_CUP,
    TIP,
    USUAL_VACUUM,
    WIDEST,
    Gripper,
    along,
    outward_axis,
    suction_cup,
    two_fingers,
)
from tamp.errors import InputError
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Hull
from tests.commands.robot_folder.urdf import SIX, write_arm

MOUNT = Pose((0.0, 0.0, 0.02))


def finger_points(gripper: Gripper, opening: float) -> list[Array]:
    """Vertices of both fingers in the hand's frame, each half the opening out."""
    return [
        joint.origin.apply(np.concatenate([hull.vertices for hull in hulls]))
        + opening / 2 * np.array(joint.axis)
        for joint, hulls in zip(gripper.fingers, gripper.finger_hulls, strict=True)
    ]


def volume(hull: Hull) -> float:
    a, b, c = (hull.vertices[hull.faces[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6


@pytest.mark.parametrize("opening", [0.01, 0.08, WIDEST])
def test_fingers_are_as_far_apart_as_they_open(opening: float) -> None:
    """Along the tool's y, the left one on its positive side; closed they meet in the tool's plane."""
    gripper = two_fingers(opening, 50.0, MOUNT)
    y = gripper.T_hand_tool.rotation[:, 1]
    for width in (0.0, opening):
        left, right = finger_points(gripper, width)
        at = gripper.T_hand_tool.position
        assert ((left - at) @ y).min() == pytest.approx(width / 2)
        assert ((right - at) @ y).max() == pytest.approx(-width / 2)
    assert all(joint.upper == opening / 2 and joint.lower == 0.0 for joint in gripper.fingers)
    assert (gripper.opening, gripper.force, gripper.T_tip_hand) == (opening, 50.0, MOUNT)


@pytest.mark.parametrize("opening", [0.01, 0.08, WIDEST])
def test_the_tool_is_a_tips_depth_before_their_ends_and_the_palm_carries_them(
    opening: float,
) -> None:
    gripper = two_fingers(opening, 50.0, MOUNT)
    (palm,) = gripper.hand
    points = np.concatenate(finger_points(gripper, opening))
    assert points[:, 2].max() - gripper.T_hand_tool.position[2] == pytest.approx(TIP)
    assert points[:, 2].min() == pytest.approx(palm.vertices[:, 2].max()) == pytest.approx(PALM[2])
    assert palm.vertices[:, 2].min() == pytest.approx(0.0)
    assert np.abs(points[:, 1]).max() <= palm.vertices[:, 1].max()


@pytest.mark.parametrize("opening", [0.0099, 0.2001, -0.1, math.nan])
def test_what_could_not_close_or_is_too_wide_is_refused(opening: float) -> None:
    with pytest.raises(InputError, match=r"opens from 0.01 to 0.2 m"):
        two_fingers(opening, 50.0, MOUNT)


@pytest.mark.parametrize("radius", [SMALLEST_CUP, 0.02, LARGEST_CUP])
def test_a_cup_has_its_rim_at_the_tool_and_pulls_as_an_ejector_does(radius: float) -> None:
    """The prism that stands for it contains the rim's circle and is hardly larger: by 1 / cos(pi / 24)."""
    gripper = suction_cup(radius, None, MOUNT)
    palm, cup = gripper.hand
    low, high = cup.vertices[:, 2].min(), cup.vertices[:, 2].max()
    assert high == pytest.approx(gripper.T_hand_tool.position[2])
    assert low == pytest.approx(palm.vertices[:, 2].max())
    area = volume(cup) / (high - low)
    assert math.pi * radius**2 < area < 1.01 * math.pi * radius**2
    rim = np.linalg.norm(cup.vertices[:, :2], axis=1)
    assert rim == pytest.approx(np.full(48, radius / math.cos(math.pi / 24)), rel=1e-4)
    assert gripper.force == pytest.approx(USUAL_VACUUM * math.pi * radius**2, abs=0.05)
    assert gripper.suction is not None and gripper.suction.radius == radius
    assert gripper.fingers == () and gripper.opening == 0.0 and gripper.name == "hand"


def test_a_cup_pulls_with_what_is_asked_but_not_with_more_than_the_air() -> None:
    most = MOST_VACUUM * math.pi * 0.02**2
    assert suction_cup(0.02, 0.99 * most, MOUNT).force == 0.99 * most
    with pytest.raises(InputError, match="127 N at most"):
        suction_cup(0.02, 1.01 * most, MOUNT)
    for radius in (0.0029, 0.1501, -1.0):
        with pytest.raises(InputError, match=r"has a radius of 0.003 to 0.15 m"):
            suction_cup(radius, None, MOUNT)


@pytest.mark.parametrize("axis", AXES)
def test_a_hand_along_an_axis_has_its_z_there(axis: str) -> None:
    R = along(axis).rotation
    expected = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}[axis[-1]]
    assert R[:, 2] == pytest.approx(-np.array(expected) if axis[0] == "-" else expected)
    assert pytest.approx(np.eye(3)) == R @ R.T
    assert np.linalg.det(R) == pytest.approx(1.0)
    assert along("z") == Pose()


def test_no_axis_is_refused_with_the_choices() -> None:
    with pytest.raises(InputError, match="unknown axis 'w'"):
        along("w")


def arm_with(folder: Path, axis: str, step: tuple[float, ...], turn: str) -> str:
    """The axis that is found for an arm whose last joint turns about `axis` of its link, `step` after the one
    before; the tip is turned by `turn`.
    """
    x, y, z = step
    last = ("wrist3", "continuous", axis, f"{x} {y} {z}", "")
    file = write_arm(folder, (*SIX[:-1], last))
    text = file.read_text().replace('xyz="0 0.06 0" rpy="-1.5708 0 0"', f'xyz="0 0 0" rpy="{turn}"')
    file.write_text(text)
    return outward_axis(find_arm(read_description(file), "foot", "tool", {}))


@pytest.mark.parametrize(
    ("axis", "step", "turn", "out"),
    [
        ("0 0 1", (0.0, 0.0, 0.1), "0 0 0", "z"), ("0 0 -1", (0.0, 0.0, 0.1), "0 0 0", "z"),
        ("0 0 1", (0.0, 0.0, -0.1), "0 0 0", "-z"), ("0 1 0", (0.0, 0.1, 0.0), "0 0 0", "y"),
        ("0 1 0", (0.0, -0.1, 0.0), "0 0 0", "-y"), ("1 0 0", (-0.1, 0.0, 0.0), "0 0 0", "-x"),
        ("0 1 0", (0.0, 0.1, 0.0), "-1.5707963 0 0", "z"), ("0 1 0", (0.0, 0.1, 0.0), "1.5707963 0 0", "-z"),
    ],
)  # fmt: skip
def test_the_axis_out_of_the_arm_is_that_of_the_last_joint_away_from_the_one_before(
    axis: str, step: tuple[float, ...], turn: str, out: str, tmp_path: Path
) -> None:
    """Whichever way round the joint counts, and however the tip is turned."""
    assert arm_with(tmp_path, axis, step, turn) == out


def test_all_axes_are_named_once() -> None:
    assert {axis[-1] for axis in AXES} == set("xyz")
    assert set(AXES) == {sign + axis for sign, axis in itertools.product(("", "-"), "xyz")}
