"""Messages of the page: read and checked, for any program may send anything."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose

FARTHEST_BODY_M = 20.0
"""Metres from the world's origin at which a body may be shown."""

LARGEST_NUMBER = 1e6
"""No number of a pose is larger; `nan` is not smaller either."""

LONGEST_WORD = 1000
"""Characters of a word."""

Message = Mapping[str, Any]
"""What the page sends, and what it gets."""


def read_poses(message: Message, movable: tuple[str, ...]) -> dict[str, Pose]:
    """Read the poses T_world_body of bodies, 16 numbers each, row by row.

    Raises:
        InputError: A body cannot be moved, or a pose is none.
    """
    given = message.get("poses")
    if not isinstance(given, dict):
        raise InputError("the poses are missing")
    poses: dict[str, Pose] = {}
    for name, numbers in given.items():
        if name not in movable:
            raise InputError(f"'{name}' cannot be moved", found=name, choices=movable)
        poses[name] = _pose(name, numbers)
    return poses


def read_word(message: Message, key: str) -> str:
    """Read a word.

    Raises:
        InputError: It is missing, or too long.
    """
    value = message.get(key)
    if not isinstance(value, str) or len(value) > LONGEST_WORD:
        raise InputError(f"'{key}' is missing")
    return value


def read_angle(message: Message, key: str) -> float:
    """Read an angle, radians.

    Raises:
        InputError: It is missing, or no finite number.
    """
    value = message.get(key)
    if (
        isinstance(value, bool)
        or not isinstance(value, int | float)
        or not abs(value) < LARGEST_NUMBER
    ):
        raise InputError(f"'{key}' is no finite number")
    return float(value)


def _pose(name: str, numbers: object) -> Pose:
    """Check that 16 numbers are a rigid transform, and make it exactly one."""
    if not isinstance(numbers, list) or len(numbers) != 16:
        raise InputError(f"the pose of {name} has not 16 numbers")
    if not all(isinstance(one, int | float) and abs(one) < LARGEST_NUMBER for one in numbers):
        raise InputError(f"the pose of {name} holds what is no finite number")
    matrix = np.array(numbers, dtype=float).reshape(4, 4)
    turn = matrix[:3, :3]
    skewed = np.abs(turn @ turn.T - np.eye(3)).max() > 1e-3 or np.linalg.det(turn) < 0
    if skewed or np.abs(matrix[3] - [0.0, 0.0, 0.0, 1.0]).max() > 1e-3:
        raise InputError(f"the pose of {name} is no rigid transform")
    if np.abs(matrix[:3, 3]).max() > FARTHEST_BODY_M:
        raise InputError(f"{name} is farther than {FARTHEST_BODY_M:g} m away")
    return Pose.from_matrix(matrix)
