"""Disturbances of the scene while a plan is carried out: what happens, when, and to which body, all
by a seed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from numpy.random import Generator

from tamp.errors import InputError
from tamp.execution.expected import Expected
from tamp.execution.free_space import FreeSpace
from tamp.execution.motor_commands import TrajectoryPlayer
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Part
from tamp.plan.read import PlanFile, StoredSegment
from tamp.simulation.actuation import MotorSimulation

OBSTACLE_NAME = "obstacle"
"""What a blocking body is called."""

OBSTACLE_SIZE = (0.08, 0.08, 0.12)
"""Its edges, metres."""

SHIFT_DISTANCES_M = (0.05, 0.15)
"""Metres by which a body is moved on what it stands on."""

SLIP, TILT = (0.012, 0.025), (math.radians(2.0), math.radians(10.0))
"""Metres down, and radians about the closing axis, by which a body slips in the hand."""

MAX_PLACE_TRIES = 100
"""Places tried for a body before another one is taken."""


@dataclass(frozen=True)
class Disturbance:
    """The state that a disturbance changes: the world, the player of segments, what is expected,
    randomness, and the engine's name.
    """

    world: MotorSimulation
    player: TrajectoryPlayer
    expected: Expected
    rng: Generator
    engine: str | None = None


@dataclass(frozen=True)
class ScheduledDisturbance:
    """A disturbance at a share of the time of a segment of an action; `happen` does it and says
    what was done.
    """

    action: int
    segment: int
    share: float
    happen: Callable[[Disturbance], str]


def schedule(kind: str, plan: PlanFile, rng: Generator) -> ScheduledDisturbance | None:
    """Choose when a disturbance takes place in a plan; None when the plan has no moment for it.

    Raises:
        InputError: An unknown disturbance.
    """
    if kind not in DISTURBANCES:
        raise InputError(f"unknown disturbance '{kind}'", found=kind, choices=DISTURBANCES)
    moments, happen = DISTURBANCES[kind]
    possible = list(moments(plan))
    if not possible:
        return None
    action, segment = possible[int(rng.integers(len(possible)))]
    return ScheduledDisturbance(action, segment, float(rng.uniform(0.05, 0.95)), happen)


# When

Moment = tuple[int, int]
"""An action's and a segment's number."""


def _moving(plan: PlanFile) -> Iterator[tuple[Moment, StoredSegment]]:
    for number, action in enumerate(plan.actions):
        for index, segment in enumerate(action.segments):
            if segment.part != "gripper":
                yield (number, index), segment


def _any(plan: PlanFile) -> Iterator[Moment]:
    return (moment for moment, _ in _moving(plan))


def _carrying(plan: PlanFile) -> Iterator[Moment]:
    """Yield the moments while the base drives with a body in hand."""
    return (
        moment for moment, segment in _moving(plan) if segment.part == "base" and segment.holding
    )


def _before_a_place(plan: PlanFile) -> Iterator[Moment]:
    """Yield the moments while there is still something to be put down, in actions before."""
    last = max(
        (number for number, action in enumerate(plan.actions) if _puts(action.segments)), default=0
    )
    return (moment for moment, _ in _moving(plan) if moment[0] < last)


def _puts(segments: tuple[StoredSegment, ...]) -> bool:
    return any(segment.detach is not None for segment in segments)


# What


def _move(now: Disturbance) -> str:
    """Slide a body to another place on what it stands on."""
    world, rng = now.world, now.rng
    with FreeSpace(world, now.engine) as room:
        for name in rng.permutation(room.untouched):
            T = world.pose(name)
            for _ in range(MAX_PLACE_TRIES):
                moved = T.copy()
                way, turn = rng.uniform(*SHIFT_DISTANCES_M), rng.uniform(-math.pi, math.pi)
                moved[:2, 3] += way * np.array([math.cos(turn), math.sin(turn)])
                moved[:3, :3] = (
                    Pose.from_xyz_yaw(0, 0, 0, rng.uniform(-1.0, 1.0)).rotation @ T[:3, :3]
                )
                if room.fits(name, moved):
                    world.set_pose(name, moved)
                    return f"{name} is moved by {100 * way:.0f} cm"
    return "nothing could be moved"


def _drop(now: Disturbance) -> str:
    """Open the fingers, so that the body drops."""
    held = now.world.bound or _carried(now)
    now.player.let_go()
    return f"{held} is dropped"


def _slip(now: Disturbance) -> str:
    """Let the body in the hand slip: it slides down between the pads and turns a little about the
    closing axis.
    """
    world, rng = now.world, now.rng
    held = world.bound or _carried(now)
    if held is None:
        return "nothing was in the hand"

    tool, T, bound = world.tool(), world.pose(held), world.bound is not None
    turn = float(rng.uniform(*TILT)) * (1.0 if rng.random() < 0.5 else -1.0)
    turned = Pose((0.0, 0.0, 0.0), (0.0, math.sin(turn / 2), 0.0, math.cos(turn / 2))).matrix
    down = float(rng.uniform(*SLIP))
    world.detach()

    for share in (1.0, 0.75, 0.5, 0.25, 0.0):
        slipped = tool @ turned @ np.linalg.inv(tool) @ T
        slipped[2, 3] -= share * down
        world.set_pose(held, slipped)
        if world.near_fingers(held):  # else it would be a drop
            break

    if bound:
        world.attach(held)
    far = f"{1000 * share * down:.0f} mm and {math.degrees(abs(turn)):.0f}°"
    return f"{held} slips by {far} in the hand"


def _remove(now: Disturbance) -> str:
    """Remove a body that is not in the hand."""
    world = now.world
    with FreeSpace(world, now.engine) as room:
        choices = room.untouched
    if not choices:
        return "nothing could be taken away"
    name = choices[int(now.rng.integers(len(choices)))]
    world.reset_scene(replace(world.scene, bodies=MappingProxyType(
        {other: body for other, body in world.scene.bodies.items() if other != name}
    )))  # fmt: skip
    return f"{name} is taken away"


def _block(now: Disturbance) -> str:
    """Block a place: put a box that cannot be moved where the plan wants to put something down."""
    world, expected = now.world, now.expected
    wanted = [
        (name, value.data)
        for name, value in expected.plan.values.items()
        if value.type == "pose" and not any(name in fact for fact in expected.plan.initial)
    ]

    height = OBSTACLE_SIZE[2]

    with FreeSpace(world, now.engine) as room:
        for index in now.rng.permutation(len(wanted)):
            pose = wanted[int(index)][0]
            body = next(
                (
                    fact[1]
                    for fact in expected.plan.certified
                    if fact[0] == "pose" and fact[2] == pose
                ),
                None,
            )

            low = room.lowest(body, wanted[int(index)][1]) if body else None
            if low is None:
                continue

            for _ in range(MAX_PLACE_TRIES):
                x, y = wanted[int(index)][1][:2, 3] + now.rng.uniform(-0.04, 0.04, 2)
                T = Pose.from_xyz_yaw(
                    float(x), float(y), low + height / 2, now.rng.uniform(-1.5, 1.5)
                )
                box = Body(
                    OBSTACLE_NAME,
                    (Part(Box(OBSTACLE_SIZE)),),
                    T,
                    movable=False,
                    colour=(0.2, 0.2, 0.2, 1.0),
                )

                if room.free(box):
                    bodies = MappingProxyType({**world.scene.bodies, OBSTACLE_NAME: box})
                    world.reset_scene(replace(world.scene, bodies=bodies))
                    return f"a box is put where {body} should go"

    return "there was no room for a box"


def _carried(now: Disturbance) -> str | None:
    held = now.expected.held
    return held[0] if held is not None and now.world.near_fingers(held[0]) else None


DISTURBANCES: dict[
    str, tuple[Callable[[PlanFile], Iterator[Moment]], Callable[[Disturbance], str]]
] = {
    "object-moved": (_any, _move),
    "object-dropped": (_carrying, _drop),
    "grasp-slips": (_carrying, _slip),
    "object-removed": (_any, _remove),
    "surface-blocked": (_before_a_place, _block),
}
"""Disturbances by name: the moments of a plan in which they may happen, and what is done."""
