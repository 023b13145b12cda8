"""What the page may send, and what is refused of what any program may send."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from grounding.demonstrate.message import (
    FARTHEST_BODY_M,
    LONGEST_WORD,
    read_angle,
    read_poses,
    read_word,
)
from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose

THERE = Pose.from_xyz_rpy((1.0, -2.0, 0.5), (0.3, -0.4, 2.0))
MOVABLE = ("cup", "plate")


def numbers(**changed: float) -> list[float]:
    """The sixteen numbers of `THERE`, row by row, some of them others: n3=..."""
    listed = THERE.matrix.ravel().tolist()
    for name, value in changed.items():
        listed[int(name[1:])] = value
    return listed


def refused(poses: Any) -> str:
    with pytest.raises(InputError) as caught:
        read_poses({"poses": poses}, MOVABLE)
    return str(caught.value)


def test_poses_are_read_row_by_row() -> None:
    found = read_poses(
        {"poses": {"cup": numbers(), "plate": np.eye(4, dtype=int).ravel().tolist()}}, MOVABLE
    )
    assert np.allclose(found["cup"].matrix, THERE.matrix)
    assert found["plate"] == Pose()
    assert read_poses({"poses": {}}, MOVABLE) == {}


def test_a_pose_is_made_exactly_rigid() -> None:
    """The page's numbers have few digits; a quaternion has length 1 whatever they are."""
    rounded = [round(one, 4) for one in numbers()]
    pose = read_poses({"poses": {"cup": rounded}}, MOVABLE)["cup"]
    assert np.linalg.norm(pose.quaternion) == pytest.approx(1.0, abs=1e-12)
    assert np.allclose(pose.matrix, THERE.matrix, atol=1e-4)


@pytest.mark.parametrize("poses", [None, [], "cup", 3])
def test_without_poses(poses: object) -> None:
    assert refused(poses) == "the poses are missing"
    with pytest.raises(InputError, match="the poses are missing"):
        read_poses({}, MOVABLE)


def test_what_cannot_be_moved() -> None:
    said = refused({"table": numbers()})
    assert said.startswith("'table' cannot be moved") and "cup" in said and "plate" in said


@pytest.mark.parametrize("given", [None, numbers()[:15], [*numbers(), 0.0], "0" * 16])
def test_not_sixteen_numbers(given: object) -> None:
    assert refused({"cup": given}) == "the pose of cup has not 16 numbers"


@pytest.mark.parametrize("odd", [math.nan, math.inf, -1e6, "1", None, [1.0]])
def test_what_is_no_finite_number(odd: Any) -> None:
    assert refused({"cup": numbers(n3=odd)}) == "the pose of cup holds what is no finite number"


@pytest.mark.parametrize(
    "given",
    [
        numbers(n0=numbers()[0] + 0.01),
        (2.0 * THERE.matrix).ravel().tolist(),
        np.diag([1.0, 1.0, -1.0, 1.0]).ravel().tolist(),
        np.zeros(16).tolist(),
        numbers(n12=0.5),
        THERE.matrix.ravel(order="F").tolist(),  # column by column
        numbers(n15=2.0),
    ],
)
def test_what_is_no_rigid_transform(given: list[float]) -> None:
    assert refused({"cup": given}) == "the pose of cup is no rigid transform"


@pytest.mark.parametrize("axis", [3, 7, 11])
def test_a_body_that_is_too_far_away(axis: int) -> None:
    near, far = ({f"n{axis}": -FARTHEST_BODY_M * share} for share in (1.0, 1.0001))
    assert read_poses({"poses": {"cup": numbers(**near)}}, MOVABLE)
    assert refused({"cup": numbers(**far)}) == "cup is farther than 20 m away"


def test_words() -> None:
    assert read_word({"text": "left_of a b"}, "text") == "left_of a b"
    assert read_word({"text": "x" * LONGEST_WORD}, "text") == "x" * LONGEST_WORD
    for message in ({}, {"text": None}, {"text": 3}, {"text": "x" * (LONGEST_WORD + 1)}):
        with pytest.raises(InputError, match="'text' is missing"):
            read_word(message, "text")


def test_angles() -> None:
    assert read_angle({"yaw": -1.5}, "yaw") == -1.5
    whole = read_angle({"yaw": 2}, "yaw")
    assert whole == 2.0 and isinstance(whole, float)
    for odd in (None, "1", True, math.nan, math.inf, 1e6, -1e6, [1.0]):
        with pytest.raises(InputError, match="'yaw' is no finite number"):
            read_angle({"yaw": odd}, "yaw")
