"""Closing a hand of three boxes on a body in compiled code: contacts by arithmetic."""

from __future__ import annotations

import numpy as np
import pytest

from tamp.geometric.collision.tables import TableRows, pose_rows
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Box, Part, Sphere
from tamp.geometric.streams import hand_kernels
from tamp.geometric.streams.hand_kernels import CONTACT_PRECISION_M, closed

WIDE = 0.08
FINGER = Part(Box((0.01, 0.01, 0.04)))
"""The pads are at y = 0 of a closed hand, the tool's origin in their middle."""
PALM = Part(Box((0.04, 0.12, 0.02)), Pose((0.0, 0.0, -0.04)))


def asked(
    body: tuple[Part, ...], tool: Pose = Pose(), opening: float = WIDE, back: float = 0.0
) -> tuple[bool, float, float]:  # fmt: skip
    rows = TableRows()
    parts = np.array([rows.row(one) for one in (FINGER, FINGER, PALM)])
    places = [Pose((0.0, 0.005, 0.0)), Pose((0.0, -0.005, 0.0)), PALM.pose]
    along = np.array([[0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 0.0]])
    body_rows = np.array([rows.row(part) for part in body])
    body_poses = pose_rows(np.array([part.pose.matrix for part in body]))
    pose = np.concatenate([tool.rotation.ravel(), tool.position])
    found = closed(
        pose, opening, back, 0.02, np.array([0, 1, 2, 3]), parts,
        pose_rows(np.array([one.matrix for one in places])), along, body_rows, body_poses, rows.vertices(),
    )  # fmt: skip
    return bool(found[0]), float(found[1]), float(found[2])


def box(width: float, y: float = 0.0, x: float = 0.0, z: float = 0.0) -> tuple[Part, ...]:
    return (Part(Box((0.03, width, 0.03)), Pose((x, y, z))),)


@pytest.mark.parametrize(
    ("width", "y"), [(0.05, 0.0), (0.05, 0.01), (0.03, -0.02), (0.002, 0.0), (0.0101, 0.02)]
)
def test_each_finger_stops_where_the_body_begins(width: float, y: float) -> None:
    """Half its width and more on the side to which it is off; thin ones are not jumped over."""
    fits, left, right = asked(box(width, y))
    assert fits
    assert left == pytest.approx(width / 2 + y, abs=2 * CONTACT_PRECISION_M)
    assert right == pytest.approx(width / 2 - y, abs=2 * CONTACT_PRECISION_M)


def test_turned_and_moved_together_nothing_changes() -> None:
    tool = Pose.from_xyz_rpy((0.4, -0.2, 0.7), (0.5, -1.0, 2.0))
    part = Part(Box((0.03, 0.05, 0.03)), tool @ Pose((0.0, 0.01, 0.0)))
    fits, left, right = asked((part,), tool)
    assert fits
    assert (left, right) == pytest.approx((0.035, 0.015), abs=2 * CONTACT_PRECISION_M)


@pytest.mark.parametrize(
    "body",
    [
        box(0.05, z=0.2), box(0.05, x=0.2), box(WIDE + 0.002), box(0.05, y=0.02), box(0.05, z=-0.03),
    ],
    ids=["beyond the tips", "beside", "too wide", "in the left finger", "in the palm"],
)  # fmt: skip
def test_what_is_not_between_the_open_fingers_is_not_grasped(body: tuple[Part, ...]) -> None:
    assert not asked(body)[0]


def test_a_body_on_one_side_of_the_middle_is_met_by_the_other_finger_too() -> None:
    """Fingers close 2 cm beyond the middle, no farther."""
    fits, left, right = asked(box(0.01, y=0.02))
    assert fits and (left, right) == pytest.approx((0.025, -0.015), abs=2 * CONTACT_PRECISION_M)
    assert not asked(box(0.005, y=0.0275))[0]


def test_the_nearest_of_several_parts_stops_a_finger() -> None:
    two = (*box(0.02, y=0.0), *box(0.004, y=0.02), *box(0.3, z=0.9))
    fits, left, right = asked(two)
    assert fits and (left, right) == pytest.approx((0.022, 0.01), abs=2 * CONTACT_PRECISION_M)


def test_a_ball_is_met_at_its_sides() -> None:
    fits, left, right = asked((Part(Sphere(0.02), Pose((0.0, 0.0, 0.0))),))
    assert fits and (left, right) == pytest.approx((0.02, 0.02), abs=2 * CONTACT_PRECISION_M)


@pytest.mark.parametrize(("z", "free"), [(0.0, True), (-0.10, False), (-0.2, True), (-0.13, False)])
def test_the_open_hand_draws_back_along_its_axis(z: float, free: bool) -> None:
    """The body is within the fingers' reach, or a bar across the hand's way lies behind its palm."""
    body = (*box(0.05), Part(Box((0.3, 0.3, 0.005)), Pose((0.0, 0.0, z)))) if z else box(0.05)
    assert asked(body, back=0.1) == (free, 0.0, 0.0)
    assert asked(body)[0]


def test_a_part_is_placed_after_tool_and_shift() -> None:
    """R_tool (p + shift along) + t, rotations multiplied; as plain Python beside matrices."""
    place = hand_kernels._place.py_func
    tool, part = (
        Pose.from_xyz_rpy((1, 2, 3), (0.3, 0.2, 0.1)),
        Pose.from_xyz_rpy((4, 5, 6), (1, 2, 3)),
    )
    along, placed = np.array([[0.0, 0.6, 0.8]]), np.zeros((1, 12))
    row = np.concatenate([tool.rotation.ravel(), tool.position])
    place(pose_rows(part.matrix[None]), 0, row, along, 0.5, placed)
    shifted: Array = part.matrix.copy()
    shifted[:3, 3] += 0.5 * along[0]
    expected = tool.matrix @ shifted
    assert placed[0, :9].reshape(3, 3) == pytest.approx(expected[:3, :3])
    assert placed[0, 9:] == pytest.approx(expected[:3, 3])
