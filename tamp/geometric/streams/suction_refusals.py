"""Reasons why a suction cup holds a body nowhere; a proof only for bodies of one simple shape."""

from __future__ import annotations

import math

from tamp.geometric.robot.robot import Robot, Suction
from tamp.geometric.scene.scene import Body, Box, Cylinder, Shape, Sphere
from tamp.geometric.streams.firmness import GRAVITY_M_S2
from tamp.geometric.streams.suction import SEAL_GIVE_M
from tamp.stream import Rejection, RejectionKind


def no_seal(body: Body, cup: Suction) -> Rejection:
    """Say why a body gave no suction grasp."""
    across = f"the cup is {2000 * cup.radius:.0f} mm across"
    if len(body.parts) == 1 and _closes_nowhere(body.parts[0].shape, cup.radius):
        what = f"no grasp: no face of {body.name} closes the cup ({across})"
        return Rejection(what, kind=RejectionKind.NO_GRASP)
    return Rejection(
        f"no suction grasp was found ({across}, a face of {body.name} has to close it and to be "
        "near its centre of mass)",
        given_up=True,
        kind=RejectionKind.NO_GRASP,
    )


def too_heavy_to_suck(body: Body, robot: Robot) -> Rejection | None:
    """Say why a cup does not carry a body at all."""
    holds = robot.force / GRAVITY_M_S2
    if body.mass <= holds:
        return None
    what = (
        f"{body.name} weighs {body.mass:g} kg: the cup, at {robot.force:g} N, holds {holds:.2g} kg"
    )
    return Rejection(what, given_up=True, kind=RejectionKind.TOO_HEAVY)


def _closes_nowhere(shape: Shape, radius: float) -> bool:
    """Check whether a rim fits on no side of a shape: a flat one is too narrow, a round one falls
    away under it.
    """
    if isinstance(shape, Box):
        return sorted(shape.size)[1] < 2 * radius
    if isinstance(shape, Sphere):
        return _falls(shape.radius, radius) > SEAL_GIVE_M
    if isinstance(shape, Cylinder):
        side = shape.height < 2 * radius or _falls(shape.radius, radius) > SEAL_GIVE_M
        return shape.radius < radius and side
    return False


def _falls(curved: float, radius: float) -> float:
    """Compute how far a round surface falls away under a rim, metres."""
    return curved - math.sqrt(max(curved * curved - radius * radius, 0.0))
