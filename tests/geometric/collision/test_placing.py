"""Forward kinematics of the kernels, and how far a part is said to move, worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp.geometric.collision import gjk, placing
from tamp.geometric.collision.tables import FRAME, TableRows, pose_rows
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Part, Sphere
from tests.geometric.plain_kernels import plain

K = plain(gjk, placing)
QUARTER = math.pi / 2


def joint(origin: Pose, slides: bool = False) -> Array:
    return np.append(pose_rows(origin.matrix[None])[0], float(slides))


JOINTS = np.array(
    [
        joint(Pose((0.5, 0.0, 0.3))),
        # Its z is the y of the joint before.
        joint(Pose.from_xyz_rpy((0.0, 0.0, 1.0), (-QUARTER, 0.0, 0.0)), slides=True),
    ]
)


def placed_frames(*conf: float) -> Array:
    frames = np.full((3, 12), np.nan)
    K.place_frames(np.array(conf), JOINTS, frames)
    return frames


def test_frames_follow_base_turn_and_slide() -> None:
    frames = placed_frames(1.0, 2.0, QUARTER, QUARTER, 0.2)
    assert frames[0, 9:] == pytest.approx([1.0, 2.0, 0.0])
    assert frames[0, :9] == pytest.approx([0, -1, 0, 1, 0, 0, 0, 0, 1], abs=1e-12)
    # 0.5 m ahead is +y for a base that looks along +y; then the joint turns it to look along -x.
    assert frames[1, 9:] == pytest.approx([1.0, 2.5, 0.3])
    assert frames[1, :9] == pytest.approx([-1, 0, 0, 0, -1, 0, 0, 0, 1], abs=1e-12)
    # Its y is -y of the world, along which the last one slides.
    assert frames[2, 9:] == pytest.approx([1.0, 2.5 - 0.2, 1.3])
    assert frames[2, [2, 5, 8]] == pytest.approx([0.0, -1.0, 0.0], abs=1e-12)


def reached(frame: int, at: Pose, *change: float, radius: float = 0.1) -> Array:
    """The row of a ball's reach when the robot goes by `change`: x, y, yaw and the joints, all at 0 before."""
    row = TableRows().row(Part(Sphere(radius)))[None]
    row[0, FRAME] = frame
    signed = np.array(change)
    sizes = np.abs(signed)
    sizes[0] = math.hypot(*change[:2])
    placed, reach = np.empty((1, 12)), np.full((1, 10), np.nan)
    frames, poses = placed_frames(0.0, 0.0, 0.0, 0.0, 0.0), pose_rows(at.matrix[None])
    K.place_part(0, frames, np.concatenate([sizes, signed]), JOINTS, row, poses, placed, reach)
    return reach[0]


SPEED, BEND, TURN, ALL = -4, -3, -2, -1


def test_a_part_that_nothing_moves_has_only_its_place() -> None:
    reach = reached(1, Pose((0.4, 0.0, 0.0)), 0.0, 0.0, 0.0, 0.0, 0.0)
    assert reach[:3] == pytest.approx([0.9, 0.0, 0.3])
    assert reach[3:5].tolist() == [0.0, 0.0] and reach[-4:].tolist() == [0.0] * 4


def test_a_joint_that_turns_moves_the_ball_by_its_lever() -> None:
    """The ball's farthest point is 0.4 + 0.1 m from the axis; half a radian moves it 0.25 m at most."""
    reach = reached(
        1, Pose((0.4, 0.0, 0.0)), 0.0, 0.0, 0.0, 0.5, 9.0
    )  # the next joint is beyond it
    assert reach[3:5] == pytest.approx([0.0, 0.25]) and reach[ALL] == pytest.approx(0.25)
    assert reach[SPEED] == pytest.approx(0.4 * 0.5 + 0.1 * 0.5)
    assert (reach[BEND], reach[TURN]) == pytest.approx((0.25 * 0.5, 0.5))


def test_the_base_drives_and_turns_all_that_is_on_it() -> None:
    """Driving 3 by 4 is 5; turning by 2 rad moves what is 0.9 + 0.1 m from its axis by 2 m."""
    drives = reached(1, Pose((0.4, 0.0, 0.0)), 3.0, -4.0, 0.0, 0.0, 0.0)
    assert (drives[ALL], drives[SPEED], drives[BEND], drives[TURN]) == pytest.approx((5, 5, 0, 0))
    turns = reached(1, Pose((0.4, 0.0, 0.0)), 0.0, 0.0, -2.0, 0.0, 0.0)
    assert (turns[ALL], turns[SPEED]) == pytest.approx((2.0, 0.9 * 2 + 0.1 * 2))
    assert (turns[BEND], turns[TURN]) == pytest.approx((2.0 * 2.0, 2.0))
    assert turns[3:5].tolist() == [0.0, 0.0]  # by joints alone it does not move


def test_a_slide_moves_all_points_alike_and_bends_with_what_turns_before_it() -> None:
    reach = reached(2, Pose(), 0.0, 0.0, 0.0, 0.0, -0.2)
    assert reach[3:6] == pytest.approx([0.0, 0.0, 0.2])
    assert (reach[SPEED], reach[BEND], reach[TURN]) == pytest.approx((0.2, 0.0, 0.0))
    # With the joint before turning by 0.5 the centre is on its axis: only the radius counts, 0.05 m.
    both = reached(2, Pose(), 0.0, 0.0, 0.0, 0.5, -0.2)
    assert both[3:6] == pytest.approx([0.0, 0.05, 0.25])
    assert both[BEND] == pytest.approx(0.05 * 0.5 + 0.2 * 2 * 0.5)
    assert both[SPEED] == pytest.approx(0.2 + 0.1 * 0.5)


def test_velocities_add_up_with_their_signs() -> None:
    """The base turns one way, the joint the other: the centre's velocities, 0.9 m and 0.4 m times 1, are subtracted."""
    against = reached(1, Pose((0.4, 0.0, 0.0)), 0.0, 0.0, 1.0, -1.0, 0.0)
    along = reached(1, Pose((0.4, 0.0, 0.0)), 0.0, 0.0, 1.0, 1.0, 0.0)
    assert against[SPEED] == pytest.approx(0.9 - 0.4)  # and the ball does not turn
    assert along[SPEED] == pytest.approx(0.9 + 0.4 + 0.1 * 2)
    assert against[ALL] == along[ALL] == pytest.approx(1.0 + 0.5)
