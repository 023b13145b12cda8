"""Observation of what is in the robot's hands."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from tamp.execution.deviation import Deviation, Seen, deviations
from tamp.execution.expected import Expected
from tamp.geometric.scene.pose import Array
from tamp.simulation.actuation import MotorSimulation


def in_hand(world: MotorSimulation, arm: int) -> str | None:
    """Return the body in the hand of the arm of a number: bound to it, or between the fingers and
    off the ground that it stood on.
    """
    hand = world.hands[arm]
    if hand.bound is not None or not hand.squeezing:
        return hand.bound
    fingers = {link.name for link in world.arms[arm].finger_links}
    touching: dict[str, set[str]] = {}
    for first, second in world.touches():
        if first in fingers:
            touching.setdefault(second, set()).add(first)
    between = (name for name in world.scene.movable if len(touching.get(name, ())) == 2)
    return next(between, None)


def in_hands(world: MotorSimulation) -> dict[str, str | None]:
    """Return the body in each hand, by the names of the arms."""
    return {arm.arm: in_hand(world, number) for number, arm in enumerate(world.arms)}


def in_other_hands(
    world: MotorSimulation, expected: Expected, poses: Mapping[str, Array]
) -> Iterator[Deviation]:
    """Yield what is not as expected in the hands of arms that are not in use; `poses`: T_world_body
    (4, 4) of the bodies that can move.
    """
    used = world.used
    for number, arm in enumerate(world.arms):
        held = expected.in_hands.get(arm.arm)
        if number != used and held is not None:
            world.used = number
            seen = Seen(poses, in_hand(world, number), world.tool(), frozenset())
            world.used = used  # before whoever asks goes on
            yield from deviations({}, held, frozenset(), seen, None)
