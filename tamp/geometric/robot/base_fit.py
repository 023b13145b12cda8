"""Base poses from which an arm with too few joints reaches a pose of the tool."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.robot.chain import Chain
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array, Pose

if TYPE_CHECKING:
    from jaxtyping import Float

SAMPLED_CONFIGURATIONS = 12
"""Configurations at which the arm's freedom is looked at."""

LEAST_SINGULAR_VALUE = 1e-6
"""A Jacobian's singular value up to which a direction counts as none."""

SHIFT, TURN = 0.15, math.radians(30.0)
"""Metres and radians by which a base pose is changed, at most."""

ARM_STARTS = 12
"""Starts of the arm from which the change is looked for."""

_X, _Y = (np.roll(np.eye(3), turns, axis=1) for turns in (2, 1))
"""Rotations whose z is the x axis, and the y axis."""


def freedom(robot: Robot) -> int:
    """Return in how many directions the arm can move the tool: six, or fewer."""
    chain, rng, most = Chain.of(robot), np.random.default_rng(0), 0
    for _ in range(SAMPLED_CONFIGURATIONS):
        J = _jacobian(chain, rng.uniform(chain.lower, chain.upper))
        most = max(most, int((np.linalg.svd(J, compute_uv=False) > LEAST_SINGULAR_VALUE).sum()))
        if most == 6:
            break
    return most


def _jacobian(chain: Chain, q: Float[Array, " n"]) -> Float[Array, "6 n"]:
    """Compute the Jacobian of the tool, in the base's axes, without pinocchio: a plan for an arm
    that has all its freedom needs it for nothing else.
    """
    T, frames = np.eye(4), []
    for origin, slides, position in zip(chain.origins, chain.slides, q, strict=True):
        T = T @ origin
        frames.append(T)
        T_joint = np.eye(4)
        if slides > 0.0:
            T_joint[2, 3] = position
        else:
            cos, sin = math.cos(position), math.sin(position)
            T_joint[:2, :2] = ((cos, -sin), (sin, cos))
        T = T @ T_joint

    tool, J = (T @ chain.T_flange_tool)[:3, 3], np.zeros((6, len(q)))
    for k, frame in enumerate(frames):
        axis = frame[:3, 2]
        if chain.slides[k] > 0.0:
            J[:3, k] = axis
        else:
            J[:3, k], J[3:, k] = np.cross(axis, tool - frame[:3, 3]), axis
    return J


class BaseFit:
    """Moves base poses to where an arm of five joints reaches a tool pose.

    Such an arm reaches a set of poses of five dimensions: from a base pose that is drawn, almost
    surely none of a given tool pose. The base supplies what is lacking: the chain that begins with
    it, two slides and a turn on the floor, has eight joints, and its inverse kinematics is solved
    from the pose that was drawn.
    """

    def __init__(self, robot: Robot) -> None:
        from tamp.geometric.robot.numerical import spread  # compiled for those who need it

        chain = Chain.of(robot)
        virtual = np.tile(np.eye(4), (3, 1, 1))
        for index, R in enumerate((_X, _X.T @ _Y, _Y.T)):
            virtual[index, :3, :3] = R
        bound = np.array([SHIFT, SHIFT, TURN])
        self._arrays = (
            np.ascontiguousarray(np.concatenate([virtual, chain.origins])),
            np.concatenate([[1.0, 1.0, 0.0], chain.slides]),
            np.ascontiguousarray(chain.T_flange_tool),
            np.concatenate([-bound, chain.lower]),
            np.concatenate([bound, chain.upper]),
        )
        self._home = np.concatenate([np.zeros(3), chain.home])
        low = np.maximum(chain.lower, chain.home - np.pi)
        starts = low + spread(ARM_STARTS, len(low)) * (
            np.minimum(chain.upper, chain.home + np.pi) - low
        )
        starts[0] = chain.home
        self._seeds = np.concatenate([np.zeros((ARM_STARTS, 3)), starts], axis=1)

    def fit(
        self, T_world_tool: Float[Array, "4 4"], base: Float[Array, " 3"]
    ) -> Float[Array, " 3"]:
        """Return a base pose x, y, yaw near another one, metres and radians, from which the arm
        reaches the tool pose; the other one itself where none is found.
        """
        # compiled when it is imported, which arms with joints enough need not
        from tamp.geometric.robot.numerical_kernels import damped_least_squares

        T_world_base = Pose.from_xyz_yaw(float(base[0]), float(base[1]), 0.0, float(base[2])).matrix
        target = np.ascontiguousarray(np.linalg.inv(T_world_base) @ T_world_tool)
        found, count = damped_least_squares(
            *self._arrays, self._home, target, self._seeds, ARM_STARTS, 1
        )
        if not count:
            return np.asarray(base, dtype=float)
        x, y, turn = found[0, :3]
        cos, sin = math.cos(base[2]), math.sin(base[2])
        yaw = (base[2] + turn + math.pi) % (2 * math.pi) - math.pi
        return np.array([base[0] + cos * x - sin * y, base[1] + sin * x + cos * y, yaw])
