"""A plan's trajectories with joint names, times and velocities."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array
from tamp.plan.read import PlanFile, StoredSegment

BASE_JOINTS = ("base_x", "base_y", "base_yaw")
"""What the base's coordinates in the world are called: metres, metres, radians. Whole turns of the
yaw are kept.
"""


@dataclass(frozen=True, eq=False)
class Stretch:
    """One part of the robot moving, from rest to rest, while the others stand still.

    Attributes:
        part: "base", "arm" or "gripper"; of several arms "left_arm", "left_gripper" and so on.
        joints: Names of the joints that move.
        times: Seconds from the plan's start, shape (n,), increasing.
        positions: Metres and radians, shape (n, joints), linear in between.
        velocities: Their rates, shape (n, joints), zero at both ends.
        holding: The body in the hand meanwhile.
        attach, detach: The body that the fingers close on, or let go of.
    """

    part: str
    joints: tuple[str, ...]
    times: Array
    positions: Array
    velocities: Array
    holding: str | None
    attach: str | None
    detach: str | None


@dataclass(frozen=True, eq=False)
class ExportedAction:
    """An action and its stretches, in order; `start` and `duration` in seconds."""

    name: str
    arguments: tuple[str, ...]
    start: float
    duration: float
    stretches: tuple[Stretch, ...]


def joints_of(robot: Robot) -> dict[str, tuple[str, ...]]:
    """Return the names of the joints of each part, in order."""
    names: dict[str, tuple[str, ...]] = {"base": BASE_JOINTS}
    for arm in robot.arms:
        names[part_of(robot, "arm", arm.arm)] = tuple(joint.name for joint in arm.joints)
    for arm in robot.arms:
        names[part_of(robot, "gripper", arm.arm)] = tuple(finger.name for finger in arm.fingers)
    return names


def part_of(robot: Robot, part: str, arm: str | None) -> str:
    """Name a part of a robot, of several arms that of the one meant."""
    if part == "base" or not robot.beside:
        return part
    return f"{arm or robot.arm}_{part}"


def timed_actions(plan: PlanFile, robot: Robot) -> tuple[ExportedAction, ...]:
    """Time the plan's motions from the plan's start."""
    joints = joints_of(robot)
    actions: list[ExportedAction] = []
    for action in plan.actions:
        clock = action.start
        stretches: list[Stretch] = []
        for segment in action.segments:
            part = part_of(robot, segment.part, segment.arm)
            stretches.append(_stretch(segment, part, joints[part], clock))
            clock += float(segment.times[-1])
        actions.append(
            ExportedAction(
                action.name, action.arguments, action.start, action.duration, tuple(stretches)
            )
        )
    return tuple(actions)


def _stretch(
    segment: StoredSegment, part: str, joints: tuple[str, ...], clock: float
) -> Stretch:  # fmt: skip
    positions = segment.positions
    if segment.part == "gripper":  # each finger stands at half the opening
        positions = np.repeat(segment.opening[:, None] / 2, len(joints), axis=1)
    return Stretch(
        part=part,
        joints=joints,
        times=clock + segment.times,
        positions=positions,
        velocities=rates(segment.times, positions),
        holding=segment.holding,
        attach=None if segment.attach is None else segment.attach.body,
        detach=segment.detach,
    )


def rates(times: Array, positions: Array) -> Array:
    """Differentiate samples of a motion from rest to rest: velocities (n, d), the mean of the
    slopes before and after each one.

    Weighted so that constant acceleration is met exactly; a slope is never exceeded, so limits that
    the slopes keep are kept.

    Args:
        times: Shape (n,), seconds, increasing.
        positions: Shape (n, d).
    """
    velocities = np.zeros_like(positions)
    if len(times) > 2:
        spans = np.diff(times)[:, None]
        slopes = np.diff(positions, axis=0) / spans
        velocities[1:-1] = (slopes[:-1] * spans[1:] + slopes[1:] * spans[:-1]) / (
            spans[:-1] + spans[1:]
        )
    return velocities
