"""Holding: whether fingers, or a suction cup, have a body as a grasp says."""

from __future__ import annotations

import math

import numpy as np

from tamp.geometric.robot.robot import Robot, Suction
from tamp.geometric.scene.pose import Array
from tamp.simulation.world import World

FINGER_PENETRATION_M = 0.002
"""Metres by which fingers, or a cup, may be in what they hold."""
FINGER_GAP_M = 0.003
"""Metres by which a finger may be off what it holds."""
PAD_HALF_SIDE_M = 0.008
"""Metres from the tool frame's origin to the pads' edges along its x and z."""

CUP_GAP_M = 0.002
"""Metres by which a cup's middle may be off what it seals on."""
UNEVEN_M = 0.001
"""Metres by which what is under a cup may be off a plane: its lip gives so much."""
CUP_POINTS = 16
"""Points of the rim, and as many at half of its radius, that are looked at."""
TILT_TOLERANCE_RAD = math.radians(0.5)
"""Radians by which what a cup seals on may lean more than the cup allows."""
GRAVITY_M_S2 = 9.81
"""Metres a second squared."""


def why_not_held(
    world: World,
    robot: Robot,
    body: str,
    T_world_tool: Array,
    T_tool_body: Array,
    opening: float,
) -> str | None:
    """Say why the hand, which stands where nothing else is, does not hold a body that is brought
    to it; None when it does.

    Args:
        world: Where; the robot is set, the body is put back where it was.
        robot: Its hand.
        body: A name.
        T_world_tool: (4, 4), where the tool is.
        T_tool_body: (4, 4), the grasp.
        opening: Of the fingers, metres.
    """
    if not 0.0 <= opening <= robot.opening + 1e-6:
        return f"the fingers cannot open to {1000 * opening:.1f} mm"
    T_before = world.pose(body)
    world.place(body, T_world_tool @ T_tool_body)
    try:
        if robot.suction is not None:
            return _why_not_sucked(world, robot, robot.suction, body, T_world_tool)
        return _why_not_tight(world, robot, body) or _why_not_between(
            world, body, T_world_tool, opening
        )
    finally:
        world.place(body, T_before)


def _why_not_tight(world: World, robot: Robot, body: str) -> str | None:
    """Say why the hand as it stands does not touch a body as it should; None when it does."""
    fingers = (world.links[link.name] for link in robot.finger_links)
    for name, link, loosest in (
        ("palm", world.links[robot.hand], math.inf),
        *(("finger", finger, FINGER_GAP_M) for finger in fingers),
    ):
        distance = min(world.distance(link, solid, 0.05) for solid in world.solids[body])
        if distance < -FINGER_PENETRATION_M:
            return f"the {name} is {-1000 * distance:.1f} mm in it"
        if distance > loosest:
            far = f"{1000 * distance:.1f} mm" if math.isfinite(distance) else "far"
            return f"a {name} is {far} off it"
    return None


def _why_not_between(world: World, body: str, T_world_tool: Array, opening: float) -> str | None:
    """Say why a body is not between the pads; it is when a line from pad to pad meets it."""
    reach = max(opening / 2 - 2e-4, 1e-4)
    at = [
        (x, z)
        for x in np.linspace(-PAD_HALF_SIDE_M, PAD_HALF_SIDE_M, 5)
        for z in np.linspace(-PAD_HALF_SIDE_M, PAD_HALF_SIDE_M, 5)
    ]
    ends = []
    for side in (-reach, reach):
        points = np.array([(x, side, z) for x, z in at])
        ends.append(points @ T_world_tool[:3, :3].T + T_world_tool[:3, 3])
    met = {name for name, _ in world.rays(ends[0], ends[1])}
    return None if body in met else "it is not between the fingers' pads"


def _why_not_sucked(
    world: World, robot: Robot, cup: Suction, body: str, T_world_tool: Array
) -> str | None:
    """Say why a cup does not hold a body: it is in it, not sealed by it all around, aslant on it,
    or too weak; None when it does.
    """
    link = world.links[robot.hand]
    deep = -min(world.distance(link, solid, 0.05) for solid in world.solids[body])
    if deep > FINGER_PENETRATION_M:
        return f"the cup is {1000 * deep:.1f} mm in it"

    points = _cup_points(cup.radius)
    starts = points + np.array([0.0, 0.0, 1e-4])
    deepest = CUP_GAP_M + UNEVEN_M + cup.radius * math.tan(cup.tilt + TILT_TOLERANCE_RAD)
    ends = points + np.array([0.0, 0.0, deepest])
    turn, at = T_world_tool[:3, :3].T, T_world_tool[:3, 3]
    hits = world.rays(starts @ turn + at, ends @ turn + at)
    open_ = sum(name != body for name, _ in hits)
    if open_:
        return f"its face does not close the cup: {open_} of {len(hits)} points of it are open"

    way = float(ends[0, 2] - starts[0, 2])
    gaps = starts[:, 2] + way * np.array([share for _, share in hits])
    plane = np.column_stack([points[:, :2], np.ones(len(gaps))])
    slopes, *_ = np.linalg.lstsq(plane, gaps)
    if slopes[2] > CUP_GAP_M:
        return f"the cup is {1000 * slopes[2]:.1f} mm off it"
    lean = math.atan(math.hypot(slopes[0], slopes[1]))
    if lean > cup.tilt + TILT_TOLERANCE_RAD:
        return f"its face leans by {math.degrees(lean):.1f} deg against the cup"
    uneven = float(np.abs(gaps - plane @ slopes).max())
    if uneven > UNEVEN_M:
        return f"its face is uneven by {1000 * uneven:.1f} mm under the cup"

    weight = world.scene.bodies[body].mass * GRAVITY_M_S2
    if weight > robot.force:
        return f"it weighs {weight:.3g} N, the cup holds {robot.force:g} N"
    return None


def _cup_points(radius: float) -> Array:
    """List points (n, 3) of a cup in the tool's frame, metres: the middle, a ring within, the
    rim.
    """
    angles = np.arange(CUP_POINTS) * 2 * math.pi / CUP_POINTS
    ring = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(CUP_POINTS)])
    return np.concatenate([np.zeros((1, 3)), ring * radius / 2, ring * radius])
