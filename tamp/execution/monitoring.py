"""Execution monitoring: how far the robot lags behind its trajectory, and what touches what."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tamp.simulation.actuation import MotorSimulation
from tamp.simulation.world import FLOOR_NAME

STEPS_BETWEEN_LOOKS = 4
"""Steps between two looks."""

LEAST_CONTACT_FORCE_N = 1.0
"""Newtons: weaker touches are not reported."""


@dataclass(frozen=True)
class ContactEvent:
    """Two things that should not touch: names of a link or body and a body, and the most that was
    felt, newtons.
    """

    first: str
    second: str
    force: float


@dataclass
class ContactMonitor:
    """Looks at the world now and then during one action.

    Attributes:
        active: The body that the action grasps, carries or puts down.
        base: The base's largest distance from where it should be, metres.
        arm: The arm's largest joint error, radians.
        touches: The most that was felt of each pair, newtons.
    """

    world: MotorSimulation
    active: str | None
    base: float = 0.0
    arm: float = 0.0
    touches: dict[tuple[str, str], float] = field(default_factory=dict[tuple[str, str], float])
    _before: frozenset[tuple[str, str]] = frozenset()

    def __post_init__(self) -> None:
        self._before = frozenset(self.world.touches())

    def look(self) -> None:
        """Take note of this moment."""
        error = np.abs(self.world.actual() - self.world.conf)
        self.base = max(self.base, float(np.hypot(error[0], error[1])))
        self.arm = max(self.arm, float(error[3:].max()))
        for pair, force in self.world.touches().items():
            self.touches[pair] = max(self.touches.get(pair, 0.0), force)

    def unwanted(self) -> tuple[ContactEvent, ...]:
        """Return the unwanted contacts at the action's end.

        A body may touch what it touches before or after the action: that is what it rests on. A
        hand may touch what it handles, and what it holds already.
        """
        borne = self._before | frozenset(self.world.touches())
        robot = self.world.robot_links
        found: list[ContactEvent] = []
        for (first, second), force in sorted(self.touches.items()):
            if first in robot:
                held = second == self.active or (first, second) in self._before
                fine = held and first in self.world.grippers
            else:
                fine = (first, second) in borne or first == FLOOR_NAME == second
            if not fine and force >= LEAST_CONTACT_FORCE_N:
                found.append(ContactEvent(first, second, force))
        return tuple(found)
