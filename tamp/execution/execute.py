"""Execution of a stored plan in physics: monitored, and replanned where things come differently."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from tamp.execution.deviation import TOLD_DISPLACEMENT_M, TOLD_TURN_RAD, Deviation, Seen, deviations
from tamp.execution.disturbance import Disturbance, ScheduledDisturbance, schedule
from tamp.execution.execution_options import ExecutionOptions
from tamp.execution.expected import Expected
from tamp.execution.goal import judged
from tamp.execution.hands import in_hand, in_hands, in_other_hands
from tamp.execution.monitoring import ContactMonitor
from tamp.execution.motor_commands import LEAST_GRIP_DURATION_S, TrajectoryPlayer
from tamp.execution.observation import ObservedScene, Observer
from tamp.execution.pauses import without_pauses
from tamp.execution.relations import own_relations
from tamp.execution.replan import Replanner
from tamp.execution.report import ActionOutcome, BodyDisplacement, Execution
from tamp.geometric.scene.pose import Array, pose_difference
from tamp.plan.open import PlanBundle
from tamp.plan.read import PlanFile, TimedAction
from tamp.plan.sources import plan_hashes, source_file, unquoted
from tamp.simulation.actuation import MotorSimulation
from tamp.simulation.engines import default_engine, open_actuated
from tamp.symbolic.pddl.files import read_pddl
from tamp.symbolic.pddl.parser import parse_domain, parse_goal
from tamp.verification.limits import check_ranges

WAIT_AFTER_ACTION_S = 0.5
"""Seconds after an action, before it is looked at what came of it."""

STILL_SPEEDS = (0.005, 0.05)
"""Metres and radians a second: what moves faster is waited for,"""

MAX_SETTLING_S = 4.0
"""at most this long, seconds."""

MAX_REPLANS = 8
"""Plans made anew in one run."""


def execute(stored: PlanBundle, execution_options: ExecutionOptions | None = None) -> Execution:
    """Carry out a plan.

    Args:
        stored: From `tamp.plan.open.open_plan`.
        execution_options: How; with friction and without replanning when not given.

    Raises:
        InputError: An unknown grasp or engine, or one that is not installed; a domain that is
            missing or malformed; a plan that moves for hours, or out of the robot's ranges; a goal
            that needs a relation not to hold that has no classifier.
    """
    began = time.monotonic()
    chosen = execution_options or ExecutionOptions()
    scene = stored.loaded.scene
    lasting = chosen.replanner is not None and bool(stored.robot.beside)
    chosen = replace(chosen, replanner=None) if lasting else chosen

    check_ranges(stored.plan, stored.robot, scene.room)
    plan, cut = without_pauses(stored.plan)
    stored = replace(stored, plan=plan)
    notes = (f"{cut:,.0f} s of pauses in the plan were left out",) if cut else ()
    notes += ("a plan of several arms is carried out as it is, whatever comes",) if lasting else ()
    engine = chosen.engine or default_engine()
    with (
        open_actuated(scene, stored.robot, name=engine) as world,
        Observer(scene, engine) as observer,
    ):
        run = _Run(stored, chosen, world, observer)
        run.all()
        seconds = time.monotonic() - began
        return replace(run.result(), notes=notes, engine=engine, seconds=seconds)


class _Run:
    def __init__(
        self,
        stored: PlanBundle,
        chosen: ExecutionOptions,
        world: MotorSimulation,
        observer: Observer,
    ) -> None:
        self._stored, self._chosen, self._world, self._observer = stored, chosen, world, observer
        file = source_file(stored.plan, "domain", None)
        with unquoted(stored.plan.file, plan_hashes(stored.plan)):
            self._domain = parse_domain(read_pddl(file), file)

        self._player = TrajectoryPlayer(world, chosen.grasp)
        self._begin(stored.plan)

        loaded = stored.loaded
        self._goal = parse_goal(
            loaded.goal.text, self._domain, self._expected.semantics.objects, loaded.path,
            line_offset=loaded.goal.line - 1, column_offset=loaded.goal.column - 1,
        )  # fmt: skip
        self._own = own_relations(stored, self._domain, self._goal, chosen.own)

        self._rng = np.random.default_rng(chosen.seed)
        disturbance = chosen.disturbance
        self._scheduled = schedule(disturbance, stored.plan, self._rng) if disturbance else None

        self._done: list[ActionOutcome] = []
        self._replans = self._kept = 0
        self._explanation: tuple[str, ...] = ()
        self._event: str | None = None
        self._planned_for = frozenset(world.scene.bodies)

    def all(self) -> None:
        """Execute every action of the plan, and of those that take its place."""
        self._world.wait(WAIT_AFTER_ACTION_S)
        while self._queue and not self._explanation:
            action = self._queue.pop(0)
            done = self._carry_out(action)
            if done.deviations and self._chosen.replanner is not None:
                done = replace(done, after=self._replan(self._chosen.replanner, done))
            self._done.append(done)

    def result(self) -> Execution:
        """Return the execution's outcome."""
        self._world.wait(WAIT_AFTER_ACTION_S)
        truth = self._look()
        hands, classifiers = in_hands(self._world), self._chosen.classifiers
        goal = judged(self._goal, self._expected, truth, hands, classifiers, self._own)
        reached = all(part.holds for part in goal)

        return Execution(
            name=self._stored.loaded.scene.name,
            grasp=self._chosen.grasp,
            seed=self._chosen.seed,
            actions=tuple(self._done),
            goal=goal,
            reached=reached,
            on_trust=self._own.trusted,
            replans=self._replans,
            kept=self._kept,
            disturbance=self._event,
            explanation=() if reached else self._explanation,
            simulated=self._world.time,
        )

    # One action

    def _carry_out(self, action: TimedAction) -> ActionOutcome:
        world, began = self._world, self._world.time
        active, load, carried = (
            self._active(action),
            self._expected.load,
            in_hands(self._world).values(),
        )
        before = {name: world.pose(name) for name in world.scene.movable}
        world.wake(active)
        watch = ContactMonitor(world, active)
        due = self._scheduled
        if due is not None and due.action != len(self._done):
            due = None

        for number, segment in enumerate(action.segments):
            body = self._scene_name(segment.attach.body) if segment.attach else None
            happens = due is not None and due.segment == number
            event, at = (partial(self._disturb, due), due.share) if happens and due else (None, 0.0)
            guarded = segment.holding if self._chosen.replanner else None
            guard = self._scene_name(guarded) if guarded else None
            if not self._player.play(segment, body, watch, event, at, guard):
                break

        self._player.finish()
        self._world.wait(WAIT_AFTER_ACTION_S)
        self._come_to_rest()
        self._expected.apply(action)

        truth = self._look()
        return ActionOutcome(
            name=action.name,
            objects=tuple(name for name in action.arguments if name not in self._plan.values),
            start=began,
            seconds=world.time - began,
            base=watch.base,
            arm=watch.arm,
            touches=watch.unwanted(),
            displaced=tuple(self._displaced(before, {active, *load, *carried})),
            deviations=tuple(self._deviations(truth, active)),
            event=self._event if due else None,
        )

    def _disturb(self, due: ScheduledDisturbance) -> None:
        self._event = due.happen(
            Disturbance(self._world, self._player, self._expected, self._rng, self._chosen.engine)
        )

    def _active(self, action: TimedAction) -> str | None:
        segments = action.segments
        named = [one.attach.body if one.attach else one.detach for one in segments]
        named += [one.holding for one in segments]
        return next((self._scene_name(name) for name in named if name is not None), None)

    def _scene_name(self, word: str) -> str | None:
        return next((name for name in self._world.scene.bodies if name.lower() == word), None)

    def _displaced(
        self, before: Mapping[str, Array], handled: set[str | None]
    ) -> list[BodyDisplacement]:
        found: list[BodyDisplacement] = []
        for name, T in before.items():
            if name not in handled and name in self._world.solids:
                moved, turned = pose_difference(T, self._world.pose(name))
                if moved > TOLD_DISPLACEMENT_M or turned > TOLD_TURN_RAD:
                    found.append(BodyDisplacement(name, moved, turned))
        return found

    # What is seen

    def _held(self) -> str | None:
        """Return the body in the hand that is in use."""
        return in_hand(self._world, self._world.used)

    def _look(self) -> ObservedScene:
        world = self._world
        self._observer.renew(world.scene)
        poses = {name: world.pose(name) for name in world.scene.movable}
        return self._observer.observe(poses, world.actual()[:3], self._held())

    def _deviations(self, truth: ObservedScene, active: str | None) -> list[Deviation]:
        world, expected = self._world, self._expected
        poses = {name: world.pose(name) for name in world.scene.movable}
        seen = Seen(poses, self._held(), world.tool(), truth.facts)
        new = frozenset(world.scene.bodies) - self._planned_for
        poses_expected = {
            name: T for name, T in expected.poses.items() if name in self._planned_for
        }
        words = {name.lower() for name in poses_expected}
        facts = frozenset(fact for fact in expected.facts if fact[1] in words)
        facts |= self._own.missed(truth, self._held(), expected)
        held = expected.held_by(world.arms[world.used].arm)
        found = list(deviations(poses_expected, held, facts, seen, active, new))
        return [*found, *in_other_hands(world, expected, poses)]

    def _come_to_rest(self) -> None:
        """Wait for bodies that fall or roll, not for ever."""
        waited = 0.0
        while waited < MAX_SETTLING_S and any(
            speed > limit
            for name in self._world.scene.movable
            if name != self._held()
            for speed, limit in zip(self._world.speed(name), STILL_SPEEDS, strict=True)
        ):
            self._world.wait(0.25)
            waited += 0.25

    # After a deviation

    def _begin(self, plan: PlanFile) -> None:
        self._plan, self._queue = plan, list(plan.actions)
        self._expected = Expected(plan, self._domain, self._world.scene)

    def _replan(self, replanner: Replanner, done: ActionOutcome) -> str:
        world, held, grasp = self._world, self._held(), None
        if held is None:  # a hand that closed on nothing
            self._player.let_go()
            world.wait(LEAST_GRIP_DURATION_S)
        else:
            T_tool_body = np.linalg.inv(world.tool()) @ world.pose(held)
            grasp = replanner.grasp(held, T_tool_body, world.width())

        if self._replans >= MAX_REPLANS:
            why = f"planned anew {MAX_REPLANS} times, and still it comes differently"
            self._explanation = (why,)
            return why

        truth, found = self._look(), done.deviations
        expected, goal = self._expected, self._goal
        mended = replanner.replan(truth, grasp, self._plan, self._queue, found, expected, goal)
        if mended.keeps:
            self._kept += 1
            self._planned_for = frozenset(world.scene.bodies)
            self._expected.accept({name: world.pose(name) for name in world.scene.movable})
            return "the rest of the plan still holds"

        if mended.plan is None and all(one.kind == "slipped" for one in done.deviations):
            return f"no plan from here, so it goes on: {'; '.join(mended.explanation)}"
        if mended.plan is None:
            self._explanation = mended.explanation
            return f"no plan from here: {'; '.join(mended.explanation)}"

        self._replans += 1
        self._planned_for = frozenset(world.scene.bodies)
        self._begin(mended.plan)
        return f"planned anew: {len(mended.plan.actions)} actions"
