"""Rigid transforms. Inner names cancel: T_world_tool = T_world_base @ T_base_tool."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from jaxtyping import Float

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Pose:
    """A position and an orientation of one frame in another.

    Attributes:
        position: x, y, z in metres.
        quaternion: x, y, z, w, of unit norm.
    """

    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    quaternion: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)

    @cached_property
    def matrix(self) -> Float[Array, "4 4"]:
        """Return the homogeneous matrix, shape (4, 4), read-only."""
        x, y, z, w = self.quaternion
        matrix = np.array(
            [
                [
                    1 - 2 * (y * y + z * z),
                    2 * (x * y - z * w),
                    2 * (x * z + y * w),
                    self.position[0],
                ],
                [
                    2 * (x * y + z * w),
                    1 - 2 * (x * x + z * z),
                    2 * (y * z - x * w),
                    self.position[1],
                ],
                [
                    2 * (x * z - y * w),
                    2 * (y * z + x * w),
                    1 - 2 * (x * x + y * y),
                    self.position[2],
                ],
                [0.0, 0.0, 0.0, 1.0],
            ]
        )

        matrix.flags.writeable = False
        return matrix

    @property
    def rotation(self) -> Float[Array, "3 3"]:
        """Return the rotation matrix, shape (3, 3)."""
        return self.matrix[:3, :3]

    @property
    def yaw(self) -> float:
        """Rotation about z of the frame's x axis, radians in (-pi, pi]."""
        return math.atan2(self.matrix[1, 0], self.matrix[0, 0])

    @classmethod
    def from_matrix(cls, matrix: Float[Array, "4 4"]) -> Pose:
        """Build a pose from a homogeneous matrix, shape (4, 4)."""
        return cls(_floats3(matrix[:3, 3]), quaternion_from_matrix(matrix[:3, :3]))

    @classmethod
    def from_xyz_yaw(cls, x: float, y: float, z: float, yaw: float) -> Pose:
        """Build a pose upright at (x, y, z) metres, turned by yaw radians about z."""
        return cls((float(x), float(y), float(z)), (0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)))

    @classmethod
    def from_xyz_rpy(cls, xyz: tuple[float, float, float], rpy: tuple[float, float, float]) -> Pose:
        """Build a pose from a position in metres and URDF's roll, pitch, yaw in radians (fixed axes
        x, y, z).
        """
        (cr, cp, cy), (sr, sp, sy) = ([f(angle / 2) for angle in rpy] for f in (math.cos, math.sin))
        quaternion = (
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
            cr * cp * cy + sr * sp * sy,
        )
        return cls((float(xyz[0]), float(xyz[1]), float(xyz[2])), quaternion)

    def __matmul__(self, other: Pose) -> Pose:
        return Pose.from_matrix(self.matrix @ other.matrix)

    def inverse(self) -> Pose:
        """Return the inverse transform: the other frame's pose in this one."""
        rotation = self.rotation.T
        x, y, z, w = self.quaternion
        return Pose(_floats3(-rotation @ np.array(self.position)), (-x, -y, -z, w))

    def apply(self, points: Float[Array, "n 3"]) -> Float[Array, "n 3"]:
        """Express points of the inner frame in the outer one. Shape (n, 3), metres."""
        return points @ self.rotation.T + self.matrix[:3, 3]


def quaternion_from_matrix(rotation: Float[Array, "3 3"]) -> tuple[float, float, float, float]:
    """Convert a rotation matrix, shape (3, 3), to the unit quaternion x, y, z, w with w >= 0
    (Shepperd's method).
    """
    r = rotation
    trace = r[0, 0] + r[1, 1] + r[2, 2]
    squares = (r[0, 0], r[1, 1], r[2, 2], trace)
    largest = max(range(4), key=squares.__getitem__)
    if largest == 3:
        q = (r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], 1.0 + trace)
    else:
        i, j, k = largest, (largest + 1) % 3, (largest + 2) % 3
        parts = [0.0, 0.0, 0.0, 0.0]
        parts[i] = 1.0 - trace + 2.0 * r[i, i]
        parts[j] = r[j, i] + r[i, j]
        parts[k] = r[k, i] + r[i, k]
        parts[3] = r[k, j] - r[j, k]
        q = tuple(parts)
    scale = math.sqrt(sum(c * c for c in q)) * (1.0 if q[3] >= 0 else -1.0)
    x, y, z, w = (float(c) / scale for c in q)
    return (x, y, z, w)


def pose_difference(
    T_first: Float[Array, "4 4"], T_second: Float[Array, "4 4"]
) -> tuple[float, float]:
    """Measure metres and radians between two poses of shape (4, 4)."""
    cosine = (np.trace(T_first[:3, :3].T @ T_second[:3, :3]) - 1) / 2
    skew = T_first[:3, :3].T @ T_second[:3, :3]
    sine = (
        np.linalg.norm([skew[2, 1] - skew[1, 2], skew[0, 2] - skew[2, 0], skew[1, 0] - skew[0, 1]])
        / 2
    )
    return float(np.linalg.norm(T_first[:3, 3] - T_second[:3, 3])), math.atan2(
        float(sine), float(cosine)
    )


def base_difference(first: Float[Array, " 3"], second: Float[Array, " 3"]) -> float:
    """Measure the largest difference of two base configurations x, y, yaw; a full turn is none."""
    turn = (first[2] - second[2] + math.pi) % (2 * math.pi) - math.pi
    return float(max(np.abs(first[:2] - second[:2]).max(), abs(turn)))


def _floats3(values: Array) -> tuple[float, float, float]:
    return (float(values[0]), float(values[1]), float(values[2]))
