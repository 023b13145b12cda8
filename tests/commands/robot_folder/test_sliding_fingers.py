"""A URDF's own two fingers: wherever their joints count from, the gripper closes at 0 and opens outwards."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tamp.commands.robot_folder.gripper import TIP, Gripper
from tamp.commands.robot_folder.sliding_fingers import APART, FASTEST, INSIDE, own_fingers
from tamp.errors import InputError
from tamp.geometric.robot.urdf import Joint
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Hull
from tests.geometric.making import cuboid, hull

THICK, LONG, OUT = 0.012, 0.05, 0.06
"""Metres of a finger along its way, of its length, and from the hand's frame to its own."""

PALM = hull(cuboid((0.05, 0.12, 0.06)) + np.array([0.0, 0.0, 0.03]))
WAY = 0.04


def finger(side: float, *, pad: float = 0.0, kind: str = "plain") -> tuple[Joint, Hull]:
    """A finger on the side y > 0 or y < 0; its pad is `pad` beside the middle at the inner end of its way.

    kinds: plain, whose joint counts outwards from 0; inwards, whose axis points to the middle and which is open
    at 0; shifted, whose values are from 1 to 1.04; turned, whose frame is turned about x by 180 degrees.
    """
    axis, low, high, origin = np.array([0.0, side, 0.0]), 0.0, WAY, Pose((0.0, 0.0, OUT))
    middle = np.array([0.0, side * (THICK / 2 + pad), LONG / 2])
    if kind == "inwards":
        axis, low, high = -axis, 0.0, WAY
        origin = Pose((0.0, side * WAY, OUT))
    elif kind == "shifted":
        low, high = 1.0, 1.0 + WAY
        origin = Pose((0.0, -side * 1.0, OUT))
    elif kind == "turned":
        origin = Pose((0.0, 0.0, OUT), (1.0, 0.0, 0.0, 0.0))
        axis, middle = -axis, middle * [1.0, -1.0, -1.0]
    x, y, z = (float(value) for value in axis)
    joint = Joint(f"f{side:+.0f}", "prismatic", "hand", "f", origin, (x, y, z), low, high, 0.0)
    return joint, hull(cuboid((0.02, THICK, LONG)) + middle)


def made(
    kinds: tuple[str, str] = ("plain", "plain"), pad: float = 0.0, opening: float | None = None
) -> Gripper:
    (left, one), (right, two) = (
        finger(1.0, pad=pad, kind=kinds[0]),
        finger(-1.0, pad=pad, kind=kinds[1]),
    )
    return own_fingers((left, right), (PALM,), ((one,), (two,)), Pose(), opening, 40.0)


def pads(gripper: Gripper, opening: float) -> tuple[Array, Array]:
    """Vertices of both in the tool's frame, each half the opening from where its joint counts from."""
    T_tool_hand = gripper.T_hand_tool.inverse()
    found = [
        T_tool_hand.apply(
            joint.origin.apply(np.concatenate([h.vertices for h in hulls]) + opening / 2 * np.array(joint.axis))
        )
        for joint, hulls in zip(gripper.fingers, gripper.finger_hulls, strict=True)
    ]  # fmt: skip
    return found[0], found[1]


@pytest.mark.parametrize("first", ["plain", "inwards", "shifted", "turned"])
@pytest.mark.parametrize("second", ["plain", "inwards", "shifted", "turned"])
@pytest.mark.parametrize("pad", [0.0, 0.003, -0.002])
def test_pads_meet_at_zero_and_part_by_the_opening(first: str, second: str, pad: float) -> None:
    """Where they end a little apart or in each other, 0 is where they would meet, and that much more is open."""
    gripper = made((first, second), pad)
    assert gripper.opening == pytest.approx(2 * (WAY + pad))
    for opening in (0.0, gripper.opening):
        one, two = pads(gripper, opening)
        assert one[:, 1].min() == pytest.approx(opening / 2)
        assert two[:, 1].max() == pytest.approx(-opening / 2)


@pytest.mark.parametrize("kind", ["plain", "inwards", "turned"])
def test_the_tool_points_out_of_the_hand_with_the_tips_before_it(kind: str) -> None:
    gripper = made((kind, kind))
    one, two = pads(gripper, 0.0)
    assert max(one[:, 2].max(), two[:, 2].max()) == pytest.approx(TIP)
    assert gripper.T_hand_tool.rotation[:, 2] == pytest.approx([0.0, 0.0, 1.0])
    assert (one[:, 0].min() + one[:, 0].max()) / 2 == pytest.approx(0.0, abs=1e-9)
    R = gripper.T_hand_tool.rotation
    assert np.linalg.det(R) == pytest.approx(1.0)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_hand_that_points_elsewhere_has_its_tool_there(side: float) -> None:
    """Everything turned about y by 90 degrees, this way or that: z becomes x, or -x."""
    turn = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (0.0, side * np.pi / 2, 0.0))
    both = (finger(1.0), finger(-1.0))
    moved = [replace(joint, origin=turn @ joint.origin) for joint, _ in both]
    hulls = [one for _, one in both]
    palm = hull(turn.apply(PALM.vertices))
    gripper = own_fingers(
        (moved[0], moved[1]), (palm,), ((hulls[0],), (hulls[1],)), Pose(), None, 40.0
    )
    straight = made()
    expected = (turn @ straight.T_hand_tool).position
    assert gripper.T_hand_tool.position == pytest.approx(expected, abs=1e-9)
    assert gripper.T_hand_tool.rotation[:, 2] == pytest.approx([side, 0.0, 0.0], abs=1e-9)


def test_the_least_that_both_can_do_is_the_opening() -> None:
    (left, one), (right, two) = finger(1.0), finger(-1.0)
    gripper = own_fingers(
        (left, replace(right, upper=0.03)), (PALM,), ((one,), (two,)), Pose(), None, 40.0
    )
    assert gripper.opening == pytest.approx(0.06)


def test_an_opening_may_be_less_than_they_can_do_but_not_more() -> None:
    assert made(opening=0.05).opening == 0.05
    with pytest.raises(InputError, match=r"--opening 0.09.*open 0.08 m"):
        made(opening=0.09)


@pytest.mark.parametrize(
    ("pad", "said"),
    [
        (-INSIDE / 2 - 1e-4, "in each other"), (APART / 2 + 1e-4, "apart"),
        (-INSIDE / 2 + 1e-4, None), (APART / 2 - 1e-4, None),
    ],
)  # fmt: skip
def test_fingers_that_end_far_apart_or_in_each_other_cannot_close(
    pad: float, said: str | None
) -> None:
    if said is None:
        assert made(pad=pad).opening > 0
        return
    with pytest.raises(InputError, match=said):
        made(pad=pad)


def test_speeds_are_what_the_file_says_up_to_the_fastest() -> None:
    (left, one), (right, two) = finger(1.0), finger(-1.0)
    pair = (replace(left, velocity=0.03), replace(right, velocity=3.0))
    gripper = own_fingers(pair, (PALM,), ((one,), (two,)), Pose(), None, 40.0)
    assert [joint.velocity for joint in gripper.fingers] == [0.03, FASTEST]


def test_what_does_not_grip_is_refused() -> None:
    (left, one), (right, two) = finger(1.0), finger(-1.0)

    def refused(first: Joint, second: Joint, hulls: tuple = ((one,), (two,))) -> str:
        with pytest.raises(InputError) as caught:
            own_fingers((first, second), (PALM,), hulls, Pose(), None, 40.0)
        return str(caught.value)

    assert "no collision shapes" in refused(left, right, ((one,), ()))
    assert "does not move" in refused(replace(left, upper=0.0), right)
    assert "do not move towards each other" in refused(left, replace(right, axis=(1.0, 0.0, 0.0)))
    assert "cannot open" in refused(replace(left, upper=0.002), right)
