"""Time parametrization of a bound plan's motions: trajectories, action by action."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tamp.geometric.context import Context
from tamp.geometric.motion.timing import time_path
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.values import Grasp, Grip, Load, Motion, Path, Stance
from tamp.symbolic.algorithms.result import PlanAction

GRIP_DURATION_S = 0.5
"""Seconds that the fingers take to open or close, at least."""

LOADED_SPEED_SHARE = 0.5
"""Share of the robot's velocities, and its square of the accelerations, at which it carries a body
with others on it."""


@dataclass(frozen=True, eq=False)
class Segment:
    """A piece of an action's trajectory.

    Attributes:
        part: "base", "arm" or "gripper".
        times: Seconds from the segment's start, shape (n,), increasing from 0.
        positions: (n, 3) x, y, yaw; (n, joints) of the arm; (n, 1) the fingers' opening. Linear in
            between.
        opening: Of the fingers, metres, while base or arm move.
        holding: The body in the hand meanwhile.
        attach: The grasp that a gripper segment ends with.
        detach: The body that it lets go.
        load: What stands on that body and goes with it.
        arm: Which arm, or whose fingers, where the plan says; else the first.
    """

    part: str
    times: Array
    positions: Array
    opening: float
    holding: str | None = None
    attach: Grasp | None = None
    detach: str | None = None
    load: Load = ()
    arm: str | None = None


@dataclass(frozen=True, eq=False)
class Trajectory:
    """The segments of one action, one after the other."""

    segments: tuple[Segment, ...]

    @property
    def duration(self) -> float:
        """Return seconds."""
        return float(sum(segment.times[-1] for segment in self.segments))


TimingCache = dict[tuple[object, ...], tuple[Path, Segment]]
"""Paths that were timed before: by the path, where its robot stands, what it holds, and where the
bodies are.
"""


def trajectories(
    context: Context,
    actions: Sequence[PlanAction],
    values: dict[str, object],
    cache: TimingCache | None = None,
) -> list[Trajectory]:
    """Time the motions among the actions' arguments, in the plan's order.

    Corners are rounded only where the rounding is free of collision among the bodies as they stand
    at that moment.

    Args:
        context: Of the problem.
        actions: The plan.
        values: By name.
        cache: What other plans share with this one; added to.
    """
    replay = PlanTimer(context, {} if cache is None else cache)
    return [
        Trajectory(
            tuple(
                segment
                for name in action.arguments
                if isinstance(motion := values.get(name), Motion)
                for segment in replay.segments(motion)
            )
        )
        for action in actions
    ]


class PlanTimer:
    """Follows where the robot and the bodies are."""

    def __init__(self, context: Context, cache: TimingCache) -> None:
        scene = context.scene
        self._cache = cache
        self._context = context
        self._poses: dict[str, Pose] = {name: scene.bodies[name].pose for name in scene.movable}
        self._held: dict[str | None, Grasp] = {}
        self._load: Load = ()
        if context.holding is not None:
            self._held[None] = context.holding
            self._poses.pop(context.holding.body)
        self._base: Array = np.array(scene.robot.base)
        self._arms: dict[str | None, Array] = {}

    def segments(self, motion: Motion) -> list[Segment]:
        """Time the paths and gripper commands of a motion."""
        return [
            self._grip(item) if isinstance(item, Grip) else self._path(item)
            for item in motion.segments
        ]

    def _around(self, arm: str | None) -> Context:
        """Return the context in which an arm moves, and the others hold still where they are."""
        if arm is None:
            return self._context
        others = {
            name: Stance(tuple(self._arms[name].tolist()), self._held.get(name))
            for name in self._arms
            if name not in (arm, None)
        }
        return self._context.of_arm(arm, others)

    def _at(self, arm: str | None) -> Array:
        """Return where an arm is, (n,): at home where it has not moved."""
        home = self._context.home if arm is None else self._context.of_arm(arm).home
        return self._arms.get(arm, home)

    def _grip(self, grip: Grip) -> Segment:
        context, held = self._around(grip.arm), self._held.get(grip.arm)
        if grip.attach is not None:
            self._held[grip.arm], self._load = grip.attach, grip.load
            for name in (grip.attach.body, *(rider for rider, _ in grip.load)):
                self._poses.pop(name, None)
        elif held is not None:
            conf = context.conf(self._base, self._at(grip.arm))
            pose = Pose.from_matrix(context.kinematics.tool_plainly(conf)) @ held.T_tool_body
            del self._held[grip.arm]
            if not any(held.body == other.body for other in self._held.values()):
                self._poses[held.body] = pose
            self._poses |= {rider: pose @ T_body_rider for rider, T_body_rider in self._load}
            self._load = ()

        positions = np.array(grip.opening)[:, None]
        way, speed = abs(grip.opening[1] - grip.opening[0]), 2 * context.robot.finger_speed
        times = np.array([0.0, max(GRIP_DURATION_S, way / speed if way else 0.0)])
        return Segment(
            "gripper", times, positions, grip.opening[1], None, grip.attach, grip.detach, grip.load,
            grip.arm,
        )  # fmt: skip

    def _path(self, path: Path) -> Segment:
        """Time the path, or return what it was timed to before in the same circumstances."""
        held = tuple(
            (arm, one.body, one.T_tool_body.position, self._load) for arm, one in self._held.items()
        )
        bodies = tuple((name, pose.position, pose.quaternion) for name, pose in self._poses.items())
        arms = tuple((arm, joints.tobytes()) for arm, joints in self._arms.items())
        key = (id(path), self._base.tobytes(), arms, held, bodies)
        if key not in self._cache:
            self._cache[key] = path, self._time(path)
        segment = self._cache[key][1]
        if path.part == "base":
            self._base = segment.positions[-1]
        else:
            self._arms[path.arm] = path.points[-1]
        return segment

    def _time(self, path: Path) -> Segment:
        context, held = self._around(path.arm), self._held.get(path.arm)
        robot, arm = context.robot, self._at(path.arm)
        if held is not None:
            context = context.loaded(held.body, self._load)
        attachment = None if held is None else context.attachment(held)
        arrangement = context.collisions.arrangement(self._poses, attachment)
        pace = LOADED_SPEED_SHARE if self._load else 1.0
        velocity = pace * np.array(robot.velocity)
        acceleration = pace**2 * np.array(robot.acceleration)

        def conf(point: Array) -> Array:
            return (
                context.conf(point, arm) if path.part == "base" else context.conf(self._base, point)
            )

        def edge_free(a: Array, b: Array) -> bool:
            return arrangement.edge_free(conf(a), conf(b))

        joints = slice(0, 3) if path.part == "base" else slice(3, None)
        points = path.points
        if path.part == "base":
            # Whole turns are not lost between drives: the yaw goes on where it was.
            points = points.copy()
            points[:, 2] += math.tau * round(float(self._base[2] - points[0, 2]) / math.tau)

        # A rounded corner would slide sideways.
        sharp = path.part == "base" and context.steering != "se2"
        limits = velocity[joints], acceleration[joints]
        timed = time_path(points, *limits, None if sharp else edge_free)
        return Segment(
            path.part, timed.times, timed.positions, path.opening, path.holding, arm=path.arm
        )
