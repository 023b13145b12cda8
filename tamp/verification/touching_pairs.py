"""Pairs of bodies that touch at the start: they may be moved apart, and not meet again."""

from __future__ import annotations

import itertools

from tamp.simulation.world import World
from tamp.verification.collision_sweep import MAX_PENETRATION_M, Sweeper
from tamp.verification.violation_log import ViolationLog

TOUCHING_GAP_M = 5e-4
"""Metres of air up to which bodies count as touching each other at the start."""


def note_touching(world: World, sweeper: Sweeper, log: ViolationLog) -> None:
    """Note the bodies that touch at the start; log those that penetrate."""
    scene = world.scene
    for first, second in itertools.combinations(scene.bodies, 2):
        if scene.bodies[first].movable or scene.bodies[second].movable:
            depth = -world.body_distance(first, second, TOUCHING_GAP_M)
            if -TOUCHING_GAP_M <= depth <= MAX_PENETRATION_M:
                sweeper.together[min(first, second), max(first, second)] = max(0.0, depth)
            if depth > MAX_PENETRATION_M:
                by = f"{1000 * depth:.1f} mm"
                message = f"{first} and {second} penetrate by {by} at the start"
                log.add("collision", message, first, second, time=0.0, depth=depth)


def forget_parted(world: World, sweeper: Sweeper) -> None:
    """Forget pairs that touched at the start and were moved apart: they may not meet again."""
    for pair in list(sweeper.together):
        if world.body_distance(*pair, TOUCHING_GAP_M) > TOUCHING_GAP_M:
            del sweeper.together[pair]
