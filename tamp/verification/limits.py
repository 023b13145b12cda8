"""Check the robot's limits of range, velocity and acceleration in a part's motion."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tamp.errors import InputError
from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.states import arm_of
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Room
from tamp.plan.read import PlanFile, StoredSegment
from tamp.verification.makers_limits import limits_of

RANGE_TOLERANCE = 1e-4
"""Radians or metres by which a position may exceed its range."""
VELOCITY_LIMIT_SHARE = 1.02
"""Share of a velocity limit that is still kept."""
ACCELERATION_LIMIT_SHARE = 1.2
"""Share of an acceleration limit that is still kept: measured between samples it is coarse."""
SIDEWAYS_SHARE = 0.02
"""Share of a differential drive's way that may be sideways: samples are chords."""
TURNING_SHARE = 1.02
"""Share of the tightest turn of a car that is still kept: chords are shorter than arcs."""
POSITION_ROUNDING = 2e-6
"""Metres or radians by which a written position may be rounded."""
ACCELERATION_WINDOW_S = 0.02
"""Seconds between samples over which an acceleration is measured as well, if they are denser."""
TOO_HARSH = "too harsh"


@dataclass(frozen=True)
class LimitViolation:
    """A limit exceeded: the violation's kind, seconds from the segments' start, what, how much."""

    kind: str
    time: float
    message: str
    amount: float


def limit_violations(
    segments: Sequence[StoredSegment], robot: Robot, room: Room
) -> Iterator[LimitViolation]:
    """Yield each limit's worst excess in segments of a part that starts and ends at rest."""
    part, robot = segments[0].part, arm_of(robot, segments[0].arm)
    times, rows = _joined(segments)

    steps = np.diff(times)
    if (steps <= 0).any():
        at = int(np.argmax(steps <= 0))
        yield LimitViolation("time", float(times[at]), f"times of the {part} do not increase", 0.0)
        return

    names, lower, upper, velocity, acceleration = _limits(part, robot, room)
    beyond = np.maximum(lower - rows, rows - upper)
    yield from _worst("limit", beyond - RANGE_TOLERANCE, beyond, times, names, rows, "out of range")
    if len(rows) < 2:
        return
    if part == "base":
        yield from _driven(robot, times, rows)

    speed = np.abs(np.diff(rows, axis=0)) / steps[:, None]
    allowed = VELOCITY_LIMIT_SHARE * velocity + POSITION_ROUNDING / steps[:, None]
    yield from _worst(
        "velocity", speed - allowed, speed - velocity, times, names, speed, "too fast"
    )

    yield from _harsh(times, rows, acceleration, names)


def _harsh(
    times: Array, rows: Array, acceleration: Array, names: list[str]
) -> Iterator[LimitViolation]:
    """Yield each worst acceleration, once between neighbouring samples and once between samples
    that are ACCELERATION_WINDOW_S apart: of finer ones the allowance for rounding would let
    anything pass.
    """
    for kept in (np.arange(len(times)), _spread(times)):
        at, steps = times[kept], np.diff(times[kept])[:, None]

        # Mean velocities of neighbouring intervals differ by a mean acceleration times the time
        # between their middles.
        still = np.zeros((1, rows.shape[1]))
        speeds = np.concatenate([still, np.diff(rows[kept], axis=0) / steps, still])
        apart = np.concatenate([steps[:1] / 2, (steps[:-1] + steps[1:]) / 2, steps[-1:] / 2])
        shortest = np.concatenate([steps[:1], np.minimum(steps[:-1], steps[1:]), steps[-1:]])

        harsh = np.abs(np.diff(speeds, axis=0)) / apart
        allowed = ACCELERATION_LIMIT_SHARE * acceleration + 2 * POSITION_ROUNDING / shortest / apart
        excess = list(
            _worst(
                "acceleration", harsh - allowed, harsh - acceleration, at, names, harsh, TOO_HARSH
            )
        )
        yield from excess
        if excess:
            return


def _spread(times: Array) -> NDArray[np.intp]:
    """Select samples at least ACCELERATION_WINDOW_S apart, the first and the last among them."""
    kept = [0]
    for row in range(1, len(times) - 1):
        if (
            times[row] - times[kept[-1]] >= ACCELERATION_WINDOW_S
            and times[-1] - times[row] >= ACCELERATION_WINDOW_S
        ):
            kept.append(row)
    return np.array([*kept, len(times) - 1], dtype=np.intp)


def _driven(robot: Robot, times: Array, rows: Array) -> Iterator[LimitViolation]:
    """Yield the worst motion of the base that its drive cannot make."""
    step = np.diff(rows, axis=0)
    if robot.drive == "fixed":
        moved = np.abs(rows - rows[0]).max(axis=1)
        if moved.max() > RANGE_TOLERANCE:
            by = float(moved.max())
            at = float(times[int(moved.argmax())])
            yield LimitViolation("limit", at, f"the base moves by {by:.2g}, and it is fixed", by)
    elif robot.drive in ("differential", "car"):
        heading = (rows[:-1, 2] + rows[1:, 2]) / 2
        sideways = np.abs(step[:, 1] * np.cos(heading) - step[:, 0] * np.sin(heading))
        excess = sideways - RANGE_TOLERANCE - SIDEWAYS_SHARE * np.linalg.norm(step[:, :2], axis=1)
        if excess.max() > 0:
            at = int(excess.argmax())
            by = float(sideways[at])
            message = f"the base slides sideways by {1000 * by:.2g} mm, and its wheels do not"
            yield LimitViolation("limit", float(times[at]), message, by)

    if robot.turning_radius is not None:
        turned = np.abs(step[:, 2])
        straight = np.linalg.norm(step[:, :2], axis=1)
        most = TURNING_SHARE * straight / robot.turning_radius + RANGE_TOLERANCE
        if (turned > most).any():
            at = int(np.argmax(turned - most))
            by = float(turned[at])
            message = (
                f"the base turns by {by:.2g} rad while it drives {1000 * straight[at]:.2g} mm, and "
                f"it is a car that turns within {robot.turning_radius:g} m"
            )
            yield LimitViolation("limit", float(times[at]), message, by)


def check_ranges(plan: PlanFile, robot: Robot, room: Room) -> None:
    """Refuse a plan whose motions leave the robot's ranges, before anybody carries it out.

    Raises:
        InputError: The first of them: the action, its time, the joint and by how much.
    """
    for index, action in enumerate(plan.actions):
        offset = action.start
        for _, group in itertools.groupby(action.segments, key=moving_part):
            segments = list(group)
            for excess in limit_violations(segments, robot, room):
                if excess.kind == "limit":
                    where = f"{index + 1} {action.name}, {offset + excess.time:.2f} s"
                    what = f"{where}: {excess.message}: the robot cannot go there"
                    raise InputError(
                        what, file=plan.file, remedy="tamp-verify says all that is wrong with it"
                    )
            offset += sum(float(segment.times[-1]) for segment in segments)


def moving_part(segment: StoredSegment) -> tuple[str, str | None]:
    """Return which part of the robot a segment moves, and of which arm."""
    return segment.part, segment.arm


def _joined(segments: Sequence[StoredSegment]) -> tuple[Array, Array]:
    """Join times and rows of segments one after the other; the gripper's row is its opening."""
    times, rows = [], []
    offset = 0.0
    for segment in segments:
        values = segment.opening[:, None] if segment.part == "gripper" else segment.positions
        skip = 1 if times else 0
        times.append(segment.times[skip:] + offset)
        rows.append(values[skip:])
        offset += float(segment.times[-1])
    return np.concatenate(times), np.concatenate(rows)


def _limits(part: str, robot: Robot, room: Room) -> tuple[list[str], Array, Array, Array, Array]:
    limits = limits_of(robot)
    velocity, acceleration = np.array(limits.velocity), np.array(limits.acceleration)
    if part == "base":
        lower, upper = (
            np.array([room.x[0], room.y[0], -np.inf]),
            np.array([room.x[1], room.y[1], np.inf]),
        )
        return ["base x", "base y", "base yaw"], lower, upper, velocity[:3], acceleration[:3]
    if part == "arm":
        names = [joint.name for joint in robot.joints]
        return names, np.array(limits.lower), np.array(limits.upper), velocity[3:], acceleration[3:]
    return (
        ["opening"],
        np.zeros(1),
        np.array([limits.opening]),
        np.array([2 * limits.finger]),
        np.array([np.inf]),
    )


def _worst(
    kind: str,
    excess: Array,
    amount: Array,
    times: Array,
    names: list[str],
    values: Array,
    what: str,
) -> Iterator[LimitViolation]:
    for column, name in enumerate(names):
        if len(excess) and excess[:, column].max() > 0:
            row = int(excess[:, column].argmax())
            value, by = float(values[row, column]), float(amount[row, column])
            yield LimitViolation(
                kind, float(times[row]), f"{name} is {what}: {value:.4g}, {by:.2g} over", by
            )
