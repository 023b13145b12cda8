"""Time-optimal path parameterization of a rail: toppra's reachability analysis. The only file that
imports toppra, 0.75 s.

Pham and Pham, "A new approach to time-optimal path parameterization based on reachability
analysis", T-RO 2018.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tamp.geometric.motion.corner_blending import BlendedPath
from tamp.geometric.motion.without_pyplot import without_pyplot
from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float

with without_pyplot():
    from toppra.algorithm import TOPPRA
    from toppra.constraint import LinearConstraint


def speeds(
    rail: BlendedPath, velocity: Float[Array, " d"], acceleration: Float[Array, " d"]
) -> Float[Array, " m"] | None:
    """Compute the fastest rate of the station at each node, from rest to rest.

    Args:
        rail: The geometry.
        velocity: Limits, shape (d,).
        acceleration: Limits, shape (d,).

    Returns:
        Shape (m,), or None when the analysis fails numerically.
    """
    algorithm = TOPPRA(
        [_Limits(rail, velocity, acceleration)],
        _Interval(rail),
        rail.stations,
        solver_wrapper="seidel",
    )
    rates = algorithm.compute_parameterization(0.0, 0.0)[1]
    if rates is None or not np.all(np.isfinite(rates)) or np.any(rates[1:-1] <= 0.0):
        return None
    return rates


class _Limits(LinearConstraint):
    """Constraints a u + b x <= limit at both ends of every interval, with x the squared rate of the
    station and u its acceleration.

    toppra's own joint limits know one second derivative per node; a rail has one on either side.
    """

    def __init__(self, rail: BlendedPath, velocity: Array, acceleration: Array) -> None:
        super().__init__()
        self.identical = True
        before, after = rail.curvature_before, rail.curvature_after
        gaps = np.diff(rail.stations)[:, None]
        start = rail.tangents, after
        # At the interval's end x is x + 2 gap u.
        end = rail.tangents[1:] + 2.0 * gaps * before[1:], before[1:]
        self.rows = [
            np.hstack([s, np.vstack([e, s[-1:]])]) for s, e in zip(start, end, strict=True)
        ]
        self.limits = np.tile(acceleration, 4)
        with np.errstate(divide="ignore"):
            fastest = np.min(velocity / rail.max_derivative, axis=1)
        self.bounds = np.stack([np.zeros(len(fastest)), fastest**2], axis=1)

    def compute_constraint_params(
        self, path: Any, gridpoints: Array, *_: Any, **__: Any
    ) -> tuple[Any, ...]:
        """Return the coefficients a, b, c, F, g and the bounds of u and x, as toppra wants them."""
        a, b = self.rows
        identity = np.eye(a.shape[1])
        return (
            a,
            b,
            np.zeros_like(a),
            np.vstack([identity, -identity]),
            self.limits,
            None,
            self.bounds,
        )


class _Interval:
    """All that toppra asks of a path when the constraints bring their own derivatives."""

    def __init__(self, rail: BlendedPath) -> None:
        self.path_interval = np.array([rail.stations[0], rail.stations[-1]])
        self.dof = rail.positions.shape[1]
