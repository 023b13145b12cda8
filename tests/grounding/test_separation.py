"""Separations: exact where boxes face each other, never more than the true distance elsewhere."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grounding.separation import Obstacles, separations
from tamp.geometric.collision.fcl_bodies import FclBody, gap
from tests.grounding.forms import at, box, can, turned

CUBE = box(0.2, 0.2, 0.2)
_ANGLE = st.floats(-math.pi, math.pi)


@pytest.mark.parametrize(
    ("x", "y", "z", "apart"),
    [
        (0.5, 0, 0, 0.3),
        (0, -0.5, 0.05, 0.3),
        (0, 0, 0.21, 0.01),
        (0.15, 0, 0, -0.05),
        (0.05, 0, 0.19, -0.01),
        (0, 0, 0.15, -0.05),
        (0, 0, 0, -0.2),  # no line between the middles says that they only touch
    ],
)
def test_upright_boxes_are_apart_by_the_gap_between_their_faces(
    x: float, y: float, z: float, apart: float
) -> None:
    found = separations(CUBE, at(CUBE, x, y, z).matrix[None], Obstacles([at(CUBE, 0, 0, 0)]))
    assert found == pytest.approx(np.array([[apart]]))


def test_cans_beside_each_other_are_apart_between_their_rims() -> None:
    found = separations(
        can(0.1, 0.3),
        at(CUBE, 0.3, 0.4, 0.0).matrix[None],
        Obstacles([at(can(0.15, 0.3), 0, 0, 0)]),
    )
    assert found[0, 0] == pytest.approx(0.25, abs=0.005)  # of prisms with 32 sides


def test_a_scenes_own_read_only_pose_may_be_asked_about() -> None:
    pose = at(CUBE, 0.5, 0.0, 0.0).matrix
    pose.flags.writeable = False
    assert separations(CUBE, pose[None], Obstacles([at(CUBE, 0, 0, 0)])) == pytest.approx(
        np.array([[0.3]])
    )
    assert pose[0, 3] == 0.5


def test_each_pose_is_measured_from_each_obstacle() -> None:
    poses = np.stack([at(CUBE, x, 0, 0).matrix for x in (0.0, 1.0, 2.0)])
    found = separations(
        CUBE, poses, Obstacles([at(CUBE, 3.0, 0, 0), at(box(0.4, 0.4, 0.4), 0, 5.0, 0)])
    )
    assert found.shape == (3, 2)
    assert found[:, 0] == pytest.approx([2.8, 1.8, 0.8])
    assert (found[:, 1] > 4.6).all()


def test_nothing_around_is_no_column() -> None:
    assert separations(CUBE, np.eye(4)[None], Obstacles([])).shape == (1, 0)


@given(_ANGLE, _ANGLE, _ANGLE, st.floats(-0.6, 0.6), st.floats(-0.6, 0.6), st.floats(-0.4, 0.4))
@settings(max_examples=80)
def test_it_is_never_more_than_the_distance_that_fcl_measures(
    roll: float, pitch: float, yaw: float, x: float, y: float, z: float
) -> None:
    form, other = box(0.1, 0.2, 0.3), box(0.3, 0.2, 0.1)
    pose, stand = turned(roll, pitch, yaw, (x, y, z)), at(other, 0, 0, 0, 0.4)
    found = float(separations(form, pose[None], Obstacles([stand]))[0, 0])
    first, second = FclBody(form.parts), FclBody(other.parts)
    true = gap(first.place(0, pose), second.place(0, stand.matrix))
    assert found <= true + 1e-6
    if true <= 0.0:
        assert found <= 1e-6
