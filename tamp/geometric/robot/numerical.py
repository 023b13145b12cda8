"""Numerical inverse kinematics of an arm of any number and kind of joints."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.robot.chain import Chain
from tamp.geometric.robot.numerical_kernels import damped_least_squares
from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float

MAX_STARTS = 128
"""Starts after which a pose counts as out of reach, one that lies beyond the arm's length at once:
of poses within reach one in a thousand needs more than 30."""

STARTS_FOR_MORE = 48
"""Starts that are gone through for further solutions once there is one."""

MAX_SOLUTIONS = 24
"""Solutions that are looked for, at most."""

REACH_SLACK_M = 1e-3
"""Metres that are added to the arm's length, for rounding."""


class Numerical:
    """Solutions by damped least squares from many starts.

    After Levenberg and Marquardt, with damping that falls with the error (Sugihara, "Solvability-
    unconcerned inverse kinematics by the Levenberg-Marquardt method", T-RO 2011), and joints at a
    limit frozen. The first start is the middle of the joints' ranges, the others are spread over
    them by Halton's sequence: the same pose gives the same solutions.
    """

    def __init__(self, chain: Chain) -> None:
        self._chain = chain
        self._spread = spread(MAX_STARTS, len(chain.lower))
        # A joint that turns freely begins within half a turn of home.
        wide = chain.upper - chain.lower > 2 * np.pi
        self._low = np.where(wide, np.maximum(chain.home - np.pi, chain.lower), chain.lower)
        self._high = np.where(wide, np.minimum(chain.home + np.pi, chain.upper), chain.upper)
        self._centre, self._length = _length(chain)

    def solve(
        self,
        T_base_tool: Float[Array, "4 4"],
        enough: int | None = None,
        rng: np.random.Generator | None = None,
    ) -> Float[Array, "n joints"]:
        """Solve as `ArmIK.solve` says; at most MAX_SOLUTIONS, each from another start."""
        chain = self._chain
        if float(np.linalg.norm(T_base_tool[:3, 3] - self._centre)) > self._length:
            return np.empty((0, len(chain.lower)))
        places = self._spread
        if rng is not None:
            places = (places + rng.random(len(chain.lower))) % 1.0
        seeds = self._low + places * (self._high - self._low)
        target = np.ascontiguousarray(T_base_tool, dtype=float)
        most = MAX_SOLUTIONS if enough is None else enough
        looked = STARTS_FOR_MORE if enough is None else MAX_STARTS
        found, count = damped_least_squares(*chain.arrays, chain.home, target, seeds, looked, most)
        return found[:count]


def _length(chain: Chain) -> tuple[Array, float]:
    """Return a point in the base's frame and the tool's greatest distance from it, metres, bounded
    from above by the lengths of the links.
    """
    reach = float(np.linalg.norm(chain.T_flange_tool[:3, 3])) + REACH_SLACK_M
    for index in range(len(chain.origins)):
        if index > 0:
            reach += float(np.linalg.norm(chain.origins[index, :3, 3]))
        if chain.slides[index]:
            reach += float(max(abs(chain.lower[index]), abs(chain.upper[index])))
    return chain.origins[0, :3, 3].copy(), reach


HALTON_BASES = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37)
"""The bases of Halton's sequence, one a joint."""


def spread(count: int, dimensions: int) -> Float[Array, "count dimensions"]:
    """Return points in the unit cube: its middle, then those of Halton's sequence."""
    points = np.array([_halton(index, dimensions) for index in range(1, count)])
    return np.concatenate([np.full((1, dimensions), 0.5), points])


def _halton(index: int, count: int) -> list[float]:
    """Return the point of that index of Halton's sequence in [0, 1)^count."""
    point: list[float] = []
    for joint in range(count):
        base, value, scale, remaining = HALTON_BASES[joint % len(HALTON_BASES)], 0.0, 1.0, index
        while remaining:
            scale /= base
            value += scale * (remaining % base)
            remaining //= base
        point.append(value)
    return point
