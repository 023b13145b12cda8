"""Replay a plan step by step: facts by PDDL, geometry by an engine, the two compared."""

from __future__ import annotations

import itertools
import math

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.states import columns, start_row
from tamp.geometric.scene.pose import Array, base_difference, pose_difference
from tamp.plan.read import Hold, PlanFile, StoredSegment, TimedAction
from tamp.simulation.world import World
from tamp.symbolic.pddl.formatter import to_text
from tamp.symbolic.pddl.structs import Formula
from tamp.verification.certified_facts import POSE_DIFFERENCE_M, POSE_DIFFERENCE_RAD, Certified
from tamp.verification.collision_sweep import CollisionFindings, ExpectedContacts, Sweeper
from tamp.verification.execution_state import ExecutionState, Held, carried, follow
from tamp.verification.limits import limit_violations, moving_part
from tamp.verification.loads import Loads
from tamp.verification.relations import ObservedRelations
from tamp.verification.semantics import Semantics, State
from tamp.verification.state_agreement import Agreement
from tamp.verification.support_relations import SupportRelations
from tamp.verification.touching_pairs import forget_parted, note_touching
from tamp.verification.violation_log import ViolationLog

SEGMENT_JUMP = 1e-4
"""Metres or radians by which the robot may differ where two segments meet."""
TIME_TOLERANCE_S = 1e-4
"""Seconds by which times that should meet may differ."""
BOUNDING_VIOLATIONS = frozenset({"time", "limit", "velocity"})
"""Violations of an action after which its motions may be of any length."""
MAX_STATES_AT_FIRST = 200_000
"""States of a plan that are looked at, at most, to begin with,"""
LOOKS_A_ROW = 200
"""and for each row of its motions: tamp-solve's plans need 5 to 30 a row."""
LOOKS_BEYOND = 5_000
"""States that are looked at in motions beyond the robot's limits: such a plan fails anyway."""


class Replay:
    """Carries out a plan once, from the bodies' poses; keeps a `log`, `findings` and a `course`."""

    def __init__(
        self,
        plan: PlanFile,
        world: World,
        robot: Robot,
        sweeper: Sweeper,
        semantics: Semantics,
        certified: Certified,
        relations: ObservedRelations,
        log: ViolationLog,
    ) -> None:
        self._plan, self._world, self._robot, self._sweeper = plan, world, robot, sweeper
        self._semantics, self._certified, self._relations = semantics, certified, relations
        self._bodies = {name.lower(): name for name in world.scene.bodies}
        self.log = log
        self.findings = CollisionFindings()
        rows = sum(len(segment.times) for action in plan.actions for segment in action.segments)
        self._looks, self._looks_beyond = MAX_STATES_AT_FIRST + LOOKS_A_ROW * rows, LOOKS_BEYOND
        self._agreement = Agreement(plan, world, robot, semantics.domain, self.log)
        self._supports = SupportRelations(plan, world, semantics, certified.checkable, self.log)
        self._loads = Loads(plan, world, semantics, self._supports, self.log)
        self._state = State.of(())
        self.course = ExecutionState(start_row(robot, world.scene.robot), {}, 0.0)
        self._columns = columns(robot)
        self._arms = {arm.arm: number for number, arm in enumerate(robot.arms)}

    @property
    def notes(self) -> list[str]:
        """Return oddities that are not the plan's fault."""
        return self._supports.notes

    def run(self, goal: Formula) -> None:
        """Replay the plan from the start to the goal."""
        state = State.of((*self._plan.initial, *self._plan.certified))
        state = self._relations.observed(state, self.course.in_hand)
        note_touching(self._world, self._sweeper, self.log)
        self._supports.check_relations(state, self.course.in_hand)

        for index, action in enumerate(self._plan.actions):
            self.log.action, self.log.time = (index, action.name), self.course.time
            state = self._state = self._apply(state, action)
            self._move(action)
            forget_parted(self._world, self._sweeper)
            self._agreement.follows(action)
            self._agreement.compare(state, self.course)
            self._loads.compare(state, self.course)
            self._supports.check_relations(state, self.course.in_hand)
            state = self._relations.observed(state, self.course.in_hand)

        self.log.action = self.log.time = None
        if abs(self._plan.duration - self.course.time) > TIME_TOLERANCE_S:
            times = f"{self.course.time:.3f} s, not {self._plan.duration:.3f} s"
            self.log.add("time", f"the plan lasts {times}")
        cost = sum(action.cost for action in self._plan.actions)
        if abs(self._plan.cost - cost) > 1e-6:
            self.log.add("state", f"the actions cost {cost:g}, not {self._plan.cost:g}")

        self._supports.check_unused(self.course.in_hand)
        self._supports.check_goal(goal, state, self.course.in_hand)

    def _apply(self, state: State, action: TimedAction) -> State:
        lifted = self._semantics.actions.get(action.name)
        if lifted is None or len(lifted.parameters) != len(action.arguments):
            wrong = "is unknown to the domain"
            if lifted is not None:
                wrong = f"takes {len(lifted.parameters)} arguments"
            self.log.add("precondition", f"the action {action.name} {wrong}")
            return state

        for parameter, argument in zip(lifted.parameters, action.arguments, strict=True):
            if not self._semantics.fits(argument, parameter.types):
                types = " or ".join(parameter.types)
                self.log.add("precondition", f"'{argument}' is not a {types}")

        for part in self._semantics.unmet(lifted, action.arguments, state):
            bodies = (argument for argument in action.arguments if argument in self._bodies)
            self.log.add("precondition", f"{to_text(part)} does not hold", *bodies)
        if isinstance(lifted.cost, int | float) and abs(lifted.cost - action.cost) > 1e-6:
            self.log.add("state", f"the action costs {lifted.cost:g}, not {action.cost:g}")
        return self._semantics.apply(lifted, action.arguments, state)

    def _move(self, action: TimedAction) -> None:
        course = self.course
        if action.start < course.time - TIME_TOLERANCE_S:
            self.log.add("time", f"it starts at {action.start:.3f} s, before {course.time:.3f} s")
        course.time = self.log.time = action.start

        kept = self._check_limits(action)
        usual = self._expected_contacts(action)
        most = self._looks if kept else self._looks_beyond
        findings = CollisionFindings(nearest=self.findings.nearest, most=most)
        for segment in action.segments:
            self._carry_out(segment, usual, findings)
        for contact in findings.worst.values():
            pair, depth = (contact.first, contact.second), -contact.distance
            message = f"{contact.first} and {contact.second} penetrate by {1000 * depth:.1f} mm"
            self.log.add("collision", message, *pair, time=contact.time, depth=depth)

        self.findings.nearest = findings.nearest
        self.findings.states += findings.states
        if kept:
            self._looks -= findings.states
        else:
            self._looks_beyond -= findings.states
        if kept and findings.full:
            self.log.add(
                "unchecked",
                f"its motions are longer than the judge looks at: {MAX_STATES_AT_FIRST} states and "
                f"{LOOKS_A_ROW} a row",
            )

        lasts = course.time - action.start
        if abs(lasts - action.duration) > TIME_TOLERANCE_S:
            self.log.add("time", f"it lasts {lasts:.3f} s, not {action.duration:.3f} s")

    def _check_limits(self, action: TimedAction) -> bool:
        """Check that an action keeps the limits that bound its motions."""
        offset, kept = action.start, True
        for _, group in itertools.groupby(action.segments, key=moving_part):
            segments = list(group)
            for excess in limit_violations(segments, self._robot, self._world.scene.room):
                at = offset + excess.time
                self.log.add(excess.kind, excess.message, time=at, depth=excess.amount)
                kept = kept and excess.kind not in BOUNDING_VIOLATIONS
            offset += sum(float(segment.times[-1]) for segment in segments)
        return kept

    def _carry_out(
        self, segment: StoredSegment, usual: ExpectedContacts, findings: CollisionFindings
    ) -> None:
        course = self.course
        if abs(segment.times[0]) > TIME_TOLERANCE_S:
            self.log.add("time", f"the {segment.part}'s times do not start at 0")
        arm = self._arm(segment)
        rows = self._rows(segment, arm)
        if segment.detach is not None:
            self._detach(segment.detach, rows, arm)

        touched = {segment.attach.body if segment.attach else None, segment.detach}
        touching = frozenset(name for word, name in self._bodies.items() if word in touched)
        around = ExpectedContacts(touching, usual.grasped, usual.supporting)
        self._sweeper.sweep(rows, segment.times + course.time, course.held, findings, around)
        course.row, course.time = rows[-1], course.time + float(segment.times[-1])
        self.log.time = course.time
        for held in course.held:
            self._loads.check_level(held, rows, self._sweeper)
            T_world_tool = self._sweeper.tool(course.row, held.arm)
            for one in held.all:
                self._world.place(one.body, T_world_tool @ one.T_tool_body)
        if segment.attach is not None:
            self._attach(segment.attach, arm)

    def _arm(self, segment: StoredSegment) -> int:
        """Return the number of a segment's arm."""
        return 0 if segment.arm is None else self._arms[segment.arm]

    def _rows(self, segment: StoredSegment, arm: int) -> Array:
        """Return the robot's states, shape (n, width), checked to go on from the last one."""
        course, hand = self.course, self.course.hands.get(arm)
        held = None if hand is None else hand.body
        where = self._columns[arm]
        joints, fingers = slice(where.start, where.stop - 1), where.stop - 1
        rows = np.repeat(course.row[None], len(segment.times), axis=0)
        rows[:, fingers] = segment.opening

        jump = 0.0
        if segment.part == "base":
            rows[:, :3] = segment.positions
            jump = base_difference(rows[0, :3], course.row[:3])
        elif segment.part == "arm":
            rows[:, joints] = segment.positions
            jump = float(np.abs(rows[0, joints] - course.row[joints]).max())
            if held and course.shares(arm) and np.ptp(rows[:, joints], axis=0).max() > SEGMENT_JUMP:
                self.log.add("grasp", f"an arm moves while two hands hold {held}", held)
        if jump > SEGMENT_JUMP:
            self.log.add(
                "continuity", f"the {segment.part} jumps by {jump:.3g} (m, rad)", depth=jump
            )
        jump = abs(float(rows[0, fingers] - course.row[fingers]))
        if jump > SEGMENT_JUMP:
            self.log.add("continuity", f"the fingers jump by {1000 * jump:.1f} mm", depth=jump)

        says = segment.holding if segment.part != "gripper" else held and held.lower()
        if says != (held and held.lower()):
            message = (
                f"the plan says that the hand holds {says or 'nothing'}, not {held or 'nothing'}"
            )
            self.log.add("continuity", message)
        keeps = segment.part == "gripper" and segment.detach is None
        if keeps and held and np.ptp(rows[:, fingers]) > SEGMENT_JUMP:
            self.log.add("grasp", f"the fingers move while they hold {held}", held)
        return rows

    def _attach(self, hold: Hold, arm: int) -> None:
        course, body = self.course, self._bodies.get(hold.body)
        if body is None or not self._world.scene.bodies[body].movable:
            self.log.add("grasp", f"{hold.body} cannot be moved", hold.body)
            return
        if arm in course.hands:
            self.log.add("grasp", f"the hand holds {course.hands[arm].body} already", hold.body)

        T_world_body, T_world_tool = self._world.pose(body), self._sweeper.tool(course.row, arm)
        T_tool_body = np.linalg.inv(T_world_tool) @ T_world_body
        moved, turned = pose_difference(T_tool_body, hold.T_tool_body)
        if moved > POSE_DIFFERENCE_M or turned > POSE_DIFFERENCE_RAD:
            off = f"{1000 * moved:.1f} mm, {math.degrees(turned):.1f} deg"
            self.log.add("grasp", f"{body} is {off} from where the hand closes", body, depth=moved)

        fingers = self._columns[arm].stop - 1
        why = self._certified.why_not_held(body, T_tool_body, float(course.row[fingers]), arm)
        self._world.place(body, T_world_body)
        if why:
            self.log.add("grasp", f"the hand does not hold {body}: {why}", body)
        load = self._loads.on(hold, body, T_world_tool, self._state, arm)
        course.hands[arm] = Held(body, T_tool_body, load, arm)
        self._supports.check(course.in_hand, {one.body for one in carried(course.held)})

    def _detach(self, name: str, rows: Array, arm: int) -> None:
        course, held = self.course, self.course.hands.get(arm)
        if held is None or held.body.lower() != name:
            self.log.add("grasp", f"the hand does not hold {name}", name)
            return
        fingers, widest = self._columns[arm].stop - 1, self._robot.arms[arm].opening
        if rows[-1, fingers] < min(rows[0, fingers] + POSE_DIFFERENCE_M, widest) - SEGMENT_JUMP:
            self.log.add("grasp", f"the fingers do not open to let go of {name}", name)
        del course.hands[arm]
        self._supports.check(course.in_hand, {one.body for one in carried(course.held)})

    def _expected_contacts(self, action: TimedAction) -> ExpectedContacts:
        """Find what an action is near by nature: bodies it grasps, what they stand on then."""
        grasped: set[str] = set()
        supporting_bodies: set[str] = set()
        row, hands = self.course.row.copy(), dict(self.course.hands)

        for segment in action.segments:
            arm = self._arm(segment)
            follow(row, segment, self._columns[arm])
            if segment.attach is not None and segment.attach.body in self._bodies:
                body = self._bodies[segment.attach.body]
                grasped.add(body)
                supporting_bodies |= self._supports.stand(body, frozenset()).on
                for pair in self._sweeper.together:
                    supporting_bodies |= set(pair) if body in pair else set()
                hands[arm] = Held(body, segment.attach.T_tool_body, arm=arm)
            if segment.detach is not None and (held := hands.pop(arm, None)) is not None:
                before = self._world.pose(held.body)
                self._world.place(held.body, self._sweeper.tool(row, arm) @ held.T_tool_body)
                grasped.add(held.body)
                supporting_bodies |= self._supports.stand(held.body, frozenset()).on
                self._world.place(held.body, before)
        return ExpectedContacts(frozenset(), frozenset(grasped), frozenset(supporting_bodies))
