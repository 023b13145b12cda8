"""The timeline of a robot alone: each joint goes through its range, one after the other."""

from __future__ import annotations

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.states import columns, rest_row
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import RobotStart, Room, Scene
from tamp.view.timeline import ShownAction, Timeline

ROOM_HALF_SIDE_M = 1.5
"""Half the side of the room in which it stands, metres."""

JOINT_SECONDS = 4.0
"""That a joint takes through its range and back."""


def robot_timeline(robot: Robot, model: str) -> Timeline:
    """Make the timeline: at home, each joint of an arm down to its lower limit, up to its upper one
    and back; then its fingers close and open, if there are any.
    """
    start = RobotStart(model, (0.0, 0.0, 0.0), None)
    scene = Scene(
        robot.name,
        {},
        start,
        Room((-ROOM_HALF_SIDE_M, ROOM_HALF_SIDE_M), (-ROOM_HALF_SIDE_M, ROOM_HALF_SIDE_M)),
    )
    home = rest_row(robot)
    actions: list[ShownAction] = []
    times: list[float] = [0.0]
    rows: list[Array] = [home]

    def go(name: str, column: int, values: tuple[float, ...], where: str) -> None:
        began = times[-1]
        for number, value in enumerate(values, start=1):
            row = home.copy()
            row[column] = value
            times.append(began + JOINT_SECONDS * number / len(values))
            rows.append(row)
        actions.append(ShownAction(name, (), began, times[-1], where))

    for arm, where in zip(robot.arms, columns(robot), strict=True):
        limits = zip(arm.joints, arm.lower, arm.upper, arm.home, strict=True)
        for column, (joint, low, high, middle) in enumerate(limits, start=where.start):
            unit = "m" if joint.kind == "prismatic" else "rad"
            go(joint.name, column, (low, middle, high, middle), f"{low:.2f} to {high:.2f} {unit}")
        if arm.fingers:
            fingers, widest = f"{arm.arm}'s fingers" if robot.beside else "fingers", arm.opening
            go(fingers, where.stop - 1, (0.0, widest), f"0 to {1000 * widest:.0f} mm")
    return Timeline(scene, robot, tuple(actions), np.array(times), np.array(rows), {}, True)


def described(robot: Robot) -> str:
    """Describe a robot in a line."""
    parts = sum(len(link.parts) for link in robot.links)
    joints = " + ".join(str(len(arm.joints)) for arm in robot.arms)
    return (
        f"{robot.name} · {joints} joints · {robot.drive} base · {parts} convex parts · "
        f"{_gripper(robot)}"
    )


def _gripper(robot: Robot) -> str:
    if robot.suction is None:
        return f"the fingers open {1000 * robot.opening:.0f} mm"
    return f"a suction cup {2000 * robot.suction.radius:.0f} mm across, {robot.force:g} N"
