"""The timeline of a plan: where the robot and the bodies are at each moment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tamp.geometric.robot.kinematics import ArmsKinematics
from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.states import columns, start_row
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Scene
from tamp.plan.read import PlanFile, StoredSegment, TimedAction
from tamp.symbolic.pddl.structs import Fact


@dataclass(frozen=True)
class ShownAction:
    """An action: its name, the scene's objects among its arguments, when it starts and ends
    (seconds).

    `where` says from where a body is taken, or where it is put, as far as the plan's facts tell.
    """

    name: str
    objects: tuple[str, ...]
    start: float
    end: float
    where: str = ""

    @property
    def text(self) -> str:
        """Describe the action in a few words."""
        return " ".join(word for word in (self.name, *self.objects, self.where) if word)


@dataclass(frozen=True, eq=False)
class PoseInterval:
    """The pose of a body from `since` on: T_world_body, or, while it is held by the arm of a
    number, T_tool_body; shape (4, 4).
    """

    since: float
    held: bool
    T: Array
    arm: int = 0


@dataclass(frozen=True, eq=False)
class Timeline:
    """A plan as motion, or a scene that stands still.

    Attributes:
        scene: The bodies.
        robot: Of the scene.
        actions: In order; none without a plan.
        times: Seconds, shape (n,), not decreasing.
        rows: The robot [x, y, yaw, then q1..qn, opening of each arm] at these times, shape
            (n, width), linear in between.
        stays: Where each movable body is, one after the other.
        inspected: Whether it is about the robot alone, which is shown with all that it is made of.
    """

    scene: Scene
    robot: Robot
    actions: tuple[ShownAction, ...]
    times: Array
    rows: Array
    stays: Mapping[str, tuple[PoseInterval, ...]]
    inspected: bool = False

    @property
    def duration(self) -> float:
        """Return the duration, seconds."""
        return float(self.times[-1])

    def row(self, time: float) -> Array:
        """Interpolate the robot at a time, shape (width,); before the start and after the end it
        stands.
        """
        return np.array([np.interp(time, self.times, column) for column in self.rows.T])

    def poses(self, time: float, kinematics: ArmsKinematics) -> dict[str, Array]:
        """Return T_world_body (4, 4) of all bodies at a time."""
        poses = {name: np.array(body.pose.matrix) for name, body in self.scene.bodies.items()}
        for name, stays in self.stays.items():
            stay = [stay for stay in stays if stay.since <= time or stay is stays[0]][-1]
            held = stay.held
            poses[name] = kinematics.tool(self.row(time), stay.arm) @ stay.T if held else stay.T
        return poses


def timeline_of(scene: Scene, robot: Robot, plan: PlanFile | None = None) -> Timeline:
    """Follow a plan from the scene's start; without one nothing moves."""
    maker = _Maker(scene, robot, start_row(robot, scene.robot))
    places = {name.lower(): name for name in (*scene.bodies, *scene.surfaces, *scene.cavities)}
    facts = () if plan is None else (*plan.initial, *plan.certified)
    actions: list[ShownAction] = []
    for action in () if plan is None else plan.actions:
        objects = tuple(places[name] for name in action.arguments if name in places)
        end = action.start + action.duration
        actions.append(
            ShownAction(
                action.name, objects, action.start, end, _where(action, facts, places, scene)
            )
        )
        clock = action.start
        for segment in action.segments:
            maker.follow(segment, clock)
            clock += float(segment.times[-1])
    times = np.maximum.accumulate(np.array(maker.times))
    stays = {name: tuple(stays) for name, stays in maker.stays.items()}
    return Timeline(scene, robot, tuple(actions), times, np.array(maker.rows), stays)


def _where(
    action: TimedAction, facts: Sequence[Fact], places: Mapping[str, str], scene: Scene
) -> str:
    """Find what a fact such as (supported mug p1 table) says of a body and a pose among the
    action's arguments.
    """
    said = [fact for fact in facts if len(fact) == 4 and {*fact[1:3]} <= {*action.arguments}]
    firm = [
        fact for fact in said if fact[0] in ("supported", "contained")
    ]  # others may speak of another place
    names = {fact[3] for fact in firm or said}
    place = next(
        (places[name] for name in sorted(names) if name in places and name not in action.arguments),
        None,
    )
    if place is None:
        return ""
    if any(segment.attach is not None for segment in action.segments):
        return f"from {place}"
    return f"in {place}" if place in scene.cavities else f"on {place}"


class _Maker:
    def __init__(self, scene: Scene, robot: Robot, row: Array) -> None:
        self.times: list[float] = [0.0]
        self.rows: list[Array] = [row]
        self.stays = {
            name: [PoseInterval(0.0, False, np.array(scene.bodies[name].pose.matrix))]
            for name in scene.movable
        }
        self._names = {name.lower(): name for name in scene.movable}
        self._kinematics = ArmsKinematics(robot)
        self._columns = columns(robot)
        self._arms = {arm.arm: number for number, arm in enumerate(robot.arms)}
        self._load: tuple[str, ...] = ()

    def follow(self, segment: StoredSegment, clock: float) -> None:
        """Move one part along a segment."""
        arm = 0 if segment.arm is None else self._arms[segment.arm]
        own = self._columns[arm]
        if segment.detach in self._names and self._holder(segment.detach) == arm:
            body = self._names[segment.detach]
            tool = self._kinematics.tool(self.rows[-1], arm)
            for name in (body, *self._load):
                self.stays[name].append(PoseInterval(clock, False, tool @ self.stays[name][-1].T))
            self._load = ()

        fingers = own.stop - 1
        parts = {
            "base": slice(0, 3),
            "arm": slice(own.start, fingers),
            "gripper": slice(fingers, own.stop),
        }
        positions = segment.opening[:, None] if segment.part == "gripper" else segment.positions
        for time, opening, values in zip(segment.times, segment.opening, positions, strict=True):
            row = self.rows[-1].copy()
            row[parts[segment.part]] = values
            row[fingers] = opening
            self.times.append(clock + float(time))
            self.rows.append(row)

        if segment.attach is not None and segment.attach.body in self._names:
            hold, now = segment.attach, self.times[-1]
            self.stays[self._names[hold.body]].append(
                PoseInterval(now, True, hold.T_tool_body, arm)
            )
            load = {self._names[name]: T for name, T in hold.load if name in self._names}
            for name, T_body_rider in load.items():
                T_tool_rider = hold.T_tool_body @ T_body_rider
                self.stays[name].append(PoseInterval(now, True, T_tool_rider, arm))
            self._load = tuple(load)

    def _holder(self, body: str) -> int:
        """Return the number of the arm that took a body last, by its PDDL name."""
        return self.stays[self._names[body]][-1].arm


def tool_path(timeline: Timeline, kinematics: ArmsKinematics, arm: int = 0) -> Array:
    """Return the positions of an arm's tool at the timeline's times, shape (n, 3), metres in the
    world.
    """
    return np.array([kinematics.tool(row, arm)[:3, 3] for row in timeline.rows])


def holding(timeline: Timeline, arm: int = 0) -> list[bool]:
    """Check whether something is in an arm's hand between each of the timeline's times and the
    next.
    """
    spans = [
        (stay.since, after.since if after else timeline.duration)
        for stays in timeline.stays.values()
        for stay, after in pairwise([*stays, None])
        if stay is not None and stay.held and stay.arm == arm
    ]
    return [
        any(start <= a and b <= end for start, end in spans) for a, b in pairwise(timeline.times)
    ]
