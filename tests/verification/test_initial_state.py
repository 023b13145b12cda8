"""How far poses and bases are apart, and what a plan may say of the start."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tamp.geometric.scene.pose import Pose, base_difference, pose_difference
from tamp.geometric.scene.scene import Box
from tamp.verification.initial_state import kinds_of
from tests.geometric.making import body, crate, scene, table

_ANGLE = st.floats(-math.pi, math.pi)


@given(st.floats(0.0, math.pi), st.tuples(_ANGLE, _ANGLE, _ANGLE), st.sampled_from(["x", "y", "z"]))
def test_a_turn_about_any_axis_is_its_angle(
    angle: float, start: tuple[float, float, float], axis: str
) -> None:
    first = Pose.from_xyz_rpy((0.3, -0.2, 0.1), start)
    turn = Pose.from_xyz_rpy((0, 0, 0), tuple(angle if axis == one else 0.0 for one in "xyz"))
    moved, turned = pose_difference(first.matrix, (first @ turn).matrix)
    assert moved == pytest.approx(0.0, abs=1e-12)
    assert turned == pytest.approx(angle, abs=1e-7)


def test_tiny_and_half_turns_are_exact() -> None:
    # The angle's cosine alone would lose one of a millionth of a radian.
    assert pose_difference(np.eye(4), Pose.from_xyz_yaw(0, 0, 0, 1e-6).matrix)[1] == pytest.approx(
        1e-6, rel=1e-3
    )
    assert pose_difference(np.eye(4), Pose.from_xyz_yaw(0, 0, 0, math.pi).matrix)[
        1
    ] == pytest.approx(math.pi)


def test_a_move_is_a_straight_distance() -> None:
    assert pose_difference(Pose((1, 2, 3)).matrix, Pose((1, 5, 7)).matrix) == pytest.approx(
        (5.0, 0.0)
    )


@pytest.mark.parametrize(
    ("second", "far"),
    [
        ((0.0, 0.0, 0.0), 0.0),
        ((0.3, -0.4, 0.0), 0.4),  # the larger coordinate counts
        ((0.0, 0.0, 2 * math.pi), 0.0),
        ((0.0, 0.0, -4 * math.pi), 0.0),
        ((0.0, 0.0, 2 * math.pi + 0.2), 0.2),
        ((0.1, 0.0, math.pi), math.pi),
    ],
)
def test_bases_are_the_same_after_a_full_turn(
    second: tuple[float, float, float], far: float
) -> None:
    assert base_difference(np.zeros(3), np.array(second)) == pytest.approx(far, abs=1e-12)
    assert base_difference(np.array(second), np.zeros(3)) == pytest.approx(far, abs=1e-12)


@pytest.mark.parametrize(
    ("name", "kinds"),
    [
        ("cup", {"body", "movable", "surface"}),
        ("table", {"body", "fixed", "surface"}),
        ("crate", {"body", "fixed"}),
        ("crate_inside", {"container"}),
        ("Cup", set()),  # PDDL's names are lower case
        ("nothing", set()),
    ],
)
def test_the_scene_says_what_an_object_is(name: str, kinds: set[str]) -> None:
    assert (
        kinds_of(scene(table(), crate(), body("Cup", Box((0.1, 0.1, 0.1)), (0, 0, 0.6))), name)
        == kinds
    )
