"""Check that the facts after an action agree with the geometry."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.states import columns
from tamp.geometric.scene.pose import Array, base_difference, pose_difference
from tamp.plan.read import Hold, PlanFile, TimedAction
from tamp.simulation.world import World
from tamp.symbolic.pddl.structs import Domain
from tamp.verification.certified_facts import POSE_DIFFERENCE_M, POSE_DIFFERENCE_RAD
from tamp.verification.execution_state import ExecutionState
from tamp.verification.initial_state import has_standard_meaning
from tamp.verification.limits import moving_part
from tamp.verification.semantics import State
from tamp.verification.violation_log import ViolationLog


class Agreement:
    """Compares states of facts with a course, as far as the domain has the fluents that we know."""

    def __init__(
        self, plan: PlanFile, world: World, robot: Robot, domain: Domain, log: ViolationLog
    ) -> None:
        self._plan, self._world, self._log, self._domain = plan, world, log, domain
        self._bodies = {name.lower(): name for name in world.scene.bodies}
        self._columns = columns(robot)
        self._arms = {arm.arm: number for number, arm in enumerate(robot.arms)}
        self._meant = {
            name
            for name in ("at-pose", "holding", "hand-empty", "at-base")
            if has_standard_meaning(domain, name)
        }

    def compare(self, state: State, course: ExecutionState) -> None:
        """Log what differs."""
        if "at-pose" in self._meant:
            self._poses(state, course)

        if "holding" in self._meant:
            holds = state.all("holding")
            if len(holds) != len(course.hands):
                hands = "the hand holds" if len(self._arms) == 1 else "the hands hold"
                self._log.add("state", f"by the facts {hands} {len(holds)} bodies")
            for *arm, body, grasp in holds:
                self._grasp(body, grasp, course, self._arms.get(arm[0]) if arm else 0)

        if "hand-empty" in self._meant:
            by_arm = len(self._domain.predicates["hand-empty"].parameters) == 1
            for name, number in self._arms.items() if by_arm else ((None, 0),):
                self._empty(state, course, name, number)

        if "at-base" in self._meant:
            places = state.all("at-base")
            if len(places) != 1:
                self._log.add("state", f"by the facts the base is in {len(places)} places")
            for (base,) in places:
                value = self._value(base, "base-conf")
                if (
                    not isinstance(value, np.ndarray)
                    or base_difference(value, course.row[:3]) > POSE_DIFFERENCE_M
                ):
                    self._log.add("state", f"the base is not at {base}")

    def _empty(self, state: State, course: ExecutionState, name: str | None, number: int) -> None:
        empty = number not in course.hands
        fact = ("hand-empty",) if name is None else ("hand-empty", name)
        if (fact in state) != empty:
            which = "the hand" if name is None else f"the hand of {name}"
            self._log.add(
                "state", f"{which} is {'empty' if empty else 'not empty'}, the facts differ"
            )

    def follows(self, action: TimedAction) -> None:
        """Check that the action's segments begin and end where those of its motion arguments do."""
        values = [self._plan.values.get(argument) for argument in action.arguments]
        motions = [value.data for value in values if value is not None and value.type == "motion"]
        if not motions or None in motions:
            return

        stretches = [stretch for motion in motions for stretch in motion]
        if [(part, arm) for part, _, arm in stretches] != [*map(moving_part, action.segments)]:
            self._log.add("state", "its segments are not those of its motion")
            return

        for at, ((part, rows, _), segment) in enumerate(
            zip(stretches, action.segments, strict=True)
        ):
            moved = segment.opening[:, None] if part == "gripper" else segment.positions
            for end in (0, -1):
                if part == "base":
                    off = base_difference(rows[end], moved[end])
                else:
                    off = float(np.abs(rows[end] - moved[end]).max())
                if off > POSE_DIFFERENCE_M:
                    self._log.add(
                        "state",
                        f"its segment {at + 1} is {off:.3g} (m, rad) off its motion",
                        depth=off,
                    )

    def _poses(self, state: State, course: ExecutionState) -> None:
        facts = state.all("at-pose")
        for body, pose in facts:
            if body in self._bodies:
                self._pose(body, pose, course)
        placed = Counter(body for body, _ in facts)
        if has_standard_meaning(self._domain, "riding"):
            placed.update(fact[0] for fact in state.all("riding"))
        for name in self._world.scene.movable:
            count, free = placed[name.lower()], name not in course.in_hand
            if count != int(free):
                where = (
                    "nowhere" if count == 0 else f"in {count} places" if free else "not in the hand"
                )
                self._log.add("state", f"by the facts {name} is {where}", name)

    def _pose(self, body: str, pose: str, course: ExecutionState) -> None:
        name, value = self._bodies[body], self._value(pose, "pose")
        if name in course.in_hand:
            self._log.add("state", f"{body} is in the hand, not at {pose}", body)
        elif not isinstance(value, np.ndarray):
            self._log.add("state", f"{pose} is not a pose", body)
        else:
            moved, turned = pose_difference(self._world.pose(name), value)
            if moved > POSE_DIFFERENCE_M or turned > POSE_DIFFERENCE_RAD:
                off = f"{1000 * moved:.1f} mm, {math.degrees(turned):.1f} deg"
                self._log.add("state", f"{body} is {off} from {pose}", body, depth=moved)

    def _grasp(self, body: str, grasp: str, course: ExecutionState, arm: int | None) -> None:
        hold = self._value(grasp, "grasp")
        held = None if arm is None else course.hands.get(arm)
        if arm is None or held is None or held.body.lower() != body or not isinstance(hold, Hold):
            self._log.add("state", f"{body} is not in the hand by {grasp}", body)
            return
        moved, turned = pose_difference(held.T_tool_body, hold.T_tool_body)
        wider = abs(float(course.row[self._columns[arm].stop - 1]) - hold.opening)
        if moved > POSE_DIFFERENCE_M or turned > POSE_DIFFERENCE_RAD or wider > POSE_DIFFERENCE_M:
            off = f"{1000 * moved:.1f} mm, {math.degrees(turned):.1f} deg, "
            off += f"fingers {1000 * wider:.1f} mm"
            self._log.add(
                "state", f"{body} is held otherwise than {grasp} says: {off}", body, depth=moved
            )

    def _value(self, name: str, type_: str) -> Array | Hold | None:
        value = self._plan.values.get(name)
        return value.data if value is not None and value.type == type_ else None
