"""Numbers as URDF writes them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float


def words(values: Iterable[float]) -> str:
    """Write numbers with all their digits."""
    return " ".join(repr(float(value)) for value in values)


def roll_pitch_yaw(R: Float[Array, "3 3"]) -> tuple[float, float, float]:
    """Return the angles of a rotation (3, 3) about fixed x, y and z, radians."""
    across = math.hypot(R[0, 0], R[1, 0])
    pitch = math.atan2(-R[2, 0], across)
    if across < 1e-9:
        return math.atan2(-R[1, 2], R[1, 1]), pitch, 0.0
    return math.atan2(R[2, 1], R[2, 2]), pitch, math.atan2(R[1, 0], R[0, 0])
