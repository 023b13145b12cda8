"""A plan's segments as commands to the motors."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeGuard

import numpy as np

from tamp.errors import InputError
from tamp.execution.grasp_modes import GRASPS
from tamp.execution.monitoring import STEPS_BETWEEN_LOOKS, ContactMonitor
from tamp.plan.read import StoredSegment
from tamp.simulation.actuation import COMMANDS_PER_SECOND, MotorSimulation

LEAST_GRIP_DURATION_S = 0.9
"""The least that closing or opening takes, seconds: the fingers meet the body and come to rest."""

REST_DURATION_S = 0.15
"""Seconds of standing still after each segment, in which what swings comes to rest."""

Event = Callable[[], None]


class TrajectoryPlayer:
    """Carries out segments one after the other.

    Args:
        world: Where.
        grasp: One of GRASPS.

    Raises:
        InputError: Another grasp.
    """

    def __init__(self, world: MotorSimulation, grasp: str) -> None:
        if grasp not in GRASPS:
            raise InputError(f"unknown grasp '{grasp}'", found=grasp, choices=GRASPS)
        self._world, self._grasp = world, grasp
        self._passing: str | None = None

    def play(
        self,
        segment: StoredSegment,
        body: str | None,
        watch: ContactMonitor,
        event: Event | None = None,
        at: float = 0.0,
        guard: str | None = None,
    ) -> bool:
        """Carry out a segment; whether it came to its end.

        Args:
            segment: What to do.
            body: The scene's name of the body that the fingers close on.
            watch: Looks on.
            event: Called once at that share `at` of the segment's time.
            guard: The base stops when this body is not between the fingers any more.
        """
        self._world.use(segment.arm)
        if segment.part == "gripper":
            self._finger(segment, body, watch)
            return True
        return self._follow(segment, watch, event, at, guard if segment.part == "base" else None)

    def finish(self) -> None:
        """Finish an action: a body that was let go is felt again."""
        if self._passing is not None:
            if self._passing in self._world.solids and self._world.bound != self._passing:
                self._world.disable_collision(self._passing, False)
            self._passing = None

    def let_go(self) -> None:
        """Open the fingers at once, whatever they hold."""
        world = self._world
        body = world.bound
        world.detach()
        if body is not None:
            world.disable_collision(body, False)
        world.squeezing, world.opening = False, world.widest

    def _follow(
        self,
        segment: StoredSegment,
        watch: ContactMonitor,
        event: Event | None,
        at: float,
        guard: str | None,
    ) -> bool:
        world = self._world
        first = 0 if segment.part == "base" else world.joints.start
        columns = range(first, first + segment.positions.shape[1])

        lasts = float(segment.times[-1])
        count = max(1, math.ceil(lasts * COMMANDS_PER_SECOND))
        moments = np.linspace(1 / count, 1.0, count) * lasts
        rows = np.stack(
            [np.interp(moments, segment.times, segment.positions[:, k - first]) for k in columns],
            axis=1,
        )

        happens = min(int(at * count), count - 1)
        before = world.conf.copy()

        for step, row in enumerate(rows):
            if event is not None and step == happens:
                event()
            world.conf[first : columns[-1] + 1] = row
            world.step_motors(((world.conf - before) * COMMANDS_PER_SECOND).tolist())
            before[:] = world.conf
            if step % STEPS_BETWEEN_LOOKS == 0:
                watch.look()
                if guard is not None and not self._between(guard):
                    world.conf[:3] = world.actual()[:3]
                    break

        self._wait(REST_DURATION_S, watch)
        return step == count - 1

    def _finger(self, segment: StoredSegment, body: str | None, watch: ContactMonitor) -> None:
        world = self._world
        lasts = max(float(segment.times[-1]), LEAST_GRIP_DURATION_S)
        if segment.detach is not None and world.bound is not None:
            self._passing = world.bound
            world.detach()
        world.opening = float(segment.opening[-1])
        # A cup's vacuum is a constraint in either way: friction alone holds nothing from above.
        binds = self._grasp == "constraint" or not world.finger_links
        world.squeezing = segment.attach is not None and not binds
        self._wait(lasts, watch)
        if segment.attach is not None and binds and self._between(body):
            world.attach(body)

    def _between(self, body: str | None) -> TypeGuard[str]:
        """Check whether the body is where the fingers close, or at the cup: what is not there is
        not held by a constraint either.
        """
        return (
            body is not None
            and body in self._world.solids
            and self._world.near_fingers(body, self._world.reach_of(body))
        )

    def _wait(self, seconds: float, watch: ContactMonitor) -> None:
        for step in range(round(seconds * COMMANDS_PER_SECOND)):
            self._world.step_motors()
            if step % STEPS_BETWEEN_LOOKS == 0:
                watch.look()
