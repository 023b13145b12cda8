"""A plan's trajectories as text. docs/watch-export-execute.md describes the formats."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from tamp.export.trajectory import ExportedAction, Stretch, joints_of
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array
from tamp.plan.read import PlanFile
from tamp.plan.sources import DECIMALS

NANOSECONDS = 10**9


def json_text(plan: PlanFile, robot: Robot, actions: Sequence[ExportedAction]) -> str:
    """Format the actions with their stretches as JSON, times from the plan's start."""
    document = {
        "format": "tamp-trajectory",
        "version": 1,
        "robot": plan.robot,
        "joints": joints_of(robot),
        "duration": plan.duration,
        "actions": [
            {
                "name": action.name,
                "arguments": action.arguments,
                "start": action.start,
                "duration": action.duration,
                "segments": [_stretch(stretch) for stretch in action.stretches],
            }
            for action in actions
        ],
    }
    return json.dumps(document) + "\n"


def csv_text(plan: PlanFile, robot: Robot, actions: Sequence[ExportedAction]) -> str:
    """Format the trajectory as CSV, one row a sample with all joints, those that stand still too;
    the columns of velocities begin with v_.
    """
    joints = [name for names in joints_of(robot).values() for name in names]
    column = {name: at for at, name in enumerate(joints)}
    initial = _start(plan, robot)
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(
        ("time", "number", "action", "part", "holding", *joints, *(f"v_{name}" for name in joints))
    )

    for number, action in enumerate(actions, start=1):
        for stretch in action.stretches:
            moving = [column[name] for name in stretch.joints]
            for time, positions, velocities in zip(
                stretch.times, stretch.positions, stretch.velocities, strict=True
            ):  # fmt: skip
                rates = np.zeros(len(joints))
                initial[moving], rates[moving] = positions, velocities
                numbers = (*_rounded(initial), *_rounded(rates))
                holding = stretch.holding or ""
                writer.writerow(
                    (
                        round(float(time), DECIMALS),
                        number,
                        action.name,
                        stretch.part,
                        holding,
                        *numbers,
                    )
                )

    return file.getvalue()


def ros_text(plan: PlanFile, robot: Robot, actions: Sequence[ExportedAction]) -> str:
    """Format trajectory_msgs/JointTrajectory messages as JSON, one a stretch in the order in which
    they are to be sent.

    `time_from_start` counts from the message's own start. Beside each message stands what it
    belongs to.
    """
    messages = [
        {
            "action": number,
            "name": action.name,
            "arguments": action.arguments,
            "controller": stretch.part,
            "start": round(float(stretch.times[0]), DECIMALS),
            "holding": stretch.holding,
            "attach": stretch.attach,
            "detach": stretch.detach,
            "message": _message(stretch),
        }
        for number, action in enumerate(actions, start=1)
        for stretch in action.stretches
    ]

    return (
        json.dumps(
            {"format": "tamp-ros", "version": 1, "robot": plan.robot, "trajectories": messages}
        )
        + "\n"
    )


FORMATS: dict[str, Callable[[PlanFile, Robot, Sequence[ExportedAction]], str]] = {
    "json": json_text,
    "csv": csv_text,
    "ros": ros_text,
}
"""What a plan's trajectories can be written as."""


def _start(plan: PlanFile, robot: Robot) -> Array:
    """Return all joints before the first action: each part stands where its first segment begins,
    if it ever moves.
    """
    places = [
        plan.values.get(fact[1])
        for predicate in ("at-base", "standing")  # a robot that does not drive only stands
        for fact in plan.initial
        if fact[0] == predicate and len(fact) == 2
    ]
    confs = [value.data for value in places if value is not None and value.type == "base-conf"]
    base = confs[0] if confs else np.zeros(3)

    arms = {arm.arm: np.array(arm.home) for arm in robot.arms}
    openings = {arm.arm: arm.opening for arm in robot.arms}
    segments = [segment for action in plan.actions for segment in action.segments]
    for segment in reversed(segments):
        name = segment.arm or robot.arm
        openings[name] = float(segment.opening[0])
        if segment.part == "base":
            base = segment.positions[0]
        elif segment.part == "arm":
            arms[name] = segment.positions[0]
    fingers = (np.full(len(arm.fingers), openings[arm.arm] / 2) for arm in robot.arms)
    return np.concatenate([base, *arms.values(), *fingers])


def _stretch(stretch: Stretch) -> dict[str, Any]:
    document: dict[str, Any] = {
        "part": stretch.part,
        "joints": stretch.joints,
        "times": _rounded(stretch.times),
        "positions": [_rounded(row) for row in stretch.positions],
        "velocities": [_rounded(row) for row in stretch.velocities],
        "holding": stretch.holding,
    }
    if stretch.attach is not None:
        document["attach"] = stretch.attach
    if stretch.detach is not None:
        document["detach"] = stretch.detach
    return document


def _message(stretch: Stretch) -> dict[str, Any]:
    points = []
    for time, positions, velocities in zip(
        stretch.times - stretch.times[0], stretch.positions, stretch.velocities, strict=True
    ):  # fmt: skip
        seconds, nanoseconds = divmod(round(float(time) * NANOSECONDS), NANOSECONDS)
        points.append(
            {
                "positions": _rounded(positions),
                "velocities": _rounded(velocities),
                "accelerations": [],
                "effort": [],
                "time_from_start": {"sec": seconds, "nanosec": nanoseconds},
            }
        )
    frame = "world" if stretch.part == "base" else ""
    header = {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": frame}
    return {"header": header, "joint_names": stretch.joints, "points": points}


def _rounded(row: Array) -> list[float]:
    return [round(float(number), DECIMALS) + 0.0 for number in row]
