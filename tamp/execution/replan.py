"""Planning from what is seen: whether the rest of a plan still holds, and a new one when it does
not.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from tamp.errors import InputError
from tamp.execution.deviation import Deviation
from tamp.execution.expected import COMPARED_RELATIONS, Expected
from tamp.execution.observation import ObservedScene
from tamp.geometric.samplers.choice import USER_OBJECT, Grounding, Registry
from tamp.geometric.scene.pose import Array, Pose, pose_difference
from tamp.geometric.values import Grasp
from tamp.plan.open import PlanBundle
from tamp.plan.read import PlanFile, TimedAction, read_plan
from tamp.plan.sources import source_file
from tamp.plan.write import plan_text
from tamp.planner.problem import Problem, load_problem
from tamp.planner.solve import solve
from tamp.symbolic.pddl.atoms import signed_atoms
from tamp.symbolic.pddl.structs import Formula

SAME_POSE_TOLERANCE = (0.003, 0.04)
"""Metres and radians by which a body that is still to be grasped may stand elsewhere for the old
grasp to serve.
"""


@dataclass(frozen=True)
class Replanned:
    """The result of replanning: the rest of the plan is kept, else a new plan, else why there is
    none.
    """

    keeps: bool = False
    plan: PlanFile | None = None
    explanation: tuple[str, ...] = ()


class Replanner:
    """Plans anew with the options of the plan that it replaces.

    Args:
        stored: The plan.
        registry: Further samplers, as `load_problem` takes them.
        max_time: Seconds for each plan.
        seed: Of the first new plan; the next ones count on.
        samplers: By relation, over the plan's.
        groundings: Objects, as `load_problem` takes them.
    """

    def __init__(
        self,
        stored: PlanBundle,
        registry: Registry | None = None,
        max_time: float = 30.0,
        seed: int = 0,
        samplers: Mapping[str, str] = MappingProxyType({}),
        groundings: Mapping[str, Grounding] = MappingProxyType({}),
    ) -> None:
        self._stored, self._registry = stored, registry or {}
        self._max_time, self._seed = max_time, seed
        own = {name: text for name, text in stored.plan.samplers.items() if not is_given(text)}
        self._samplers, self._groundings = {**own, **samplers}, groundings

    def grasp(self, body: str, T_tool_body: Array, opening: float) -> Grasp:
        """Return the grasp of what is in the hand, as the planner has it."""
        return Grasp(body, Pose.from_matrix(T_tool_body), opening)

    def replan(
        self,
        truth: ObservedScene,
        grasp: Grasp | None,
        plan: PlanFile,
        remaining: Sequence[TimedAction],
        found: Sequence[Deviation],
        expected: Expected,
        goal: Formula,
    ) -> Replanned:
        """Keep the rest of the plan or plan anew.

        Args:
            truth: What is seen.
            grasp: What is in the hand.
            plan: The plan so far.
            remaining: Its actions that are still to come.
            found: What is not as expected.
            expected: What is expected now.
            goal: The problem's: of bodies that are gone, those that it names are needed.
        """
        loaded = self._stored.loaded
        asked = {term for atom, _ in signed_atoms(goal) for term in atom.terms}
        gone = sorted(
            name
            for name in loaded.scene.bodies.keys() - truth.scene.bodies.keys()
            if name.lower() in asked
        )

        if gone:
            return Replanned(
                explanation=tuple(f"{name} is gone, and the goal needs it" for name in gone)
            )

        try:
            problem = self._problem(truth, grasp)
        except InputError as error:  # the robot touches something where it stands
            return Replanned(explanation=(error.message,))

        if self._holds(problem, truth, plan, remaining, found, expected):
            return Replanned(keeps=True)

        seed, self._seed = self._seed, self._seed + 1
        solution = solve(
            problem, max_time=self._max_time, seed=seed, algorithm=self._stored.plan.algorithm
        )

        if not solution.solved:
            return Replanned(explanation=(solution.outcome.value, *solution.explanation))
        return Replanned(plan=read_plan(json.loads(plan_text(solution))))

    def _problem(self, truth: ObservedScene, grasp: Grasp | None) -> Problem:
        plan = self._stored.plan
        streams = plan.source("streams")
        return load_problem(
            self._stored.loaded.path,
            source_file(plan, "domain", None),
            streams=None if streams is None else streams.path,
            samplers=self._samplers,
            groundings=self._groundings,
            registry=self._registry,
            scene=truth.scene,
            holding=grasp,
        )

    def _holds(
        self,
        problem: Problem,
        truth: ObservedScene,
        plan: PlanFile,
        remaining: Sequence[TimedAction],
        found: Sequence[Deviation],
        expected: Expected,
    ) -> bool:
        """Check whether what is still to be done can be done among the bodies as they stand, and
        leads to the goal.
        """
        moved = ("misplaced", "displaced", "toppled", "new", "gone")
        if any(one.kind not in moved for one in found):
            return False

        there = {name.lower() for name in truth.scene.bodies}
        if any(fact[1] in there for fact in expected.facts - truth.facts):
            return False

        later = {
            segment.attach.body.lower()
            for action in remaining
            for segment in action.segments
            if segment.attach
        }
        placed = _placed_so(problem.stream_task.task.goal, there)
        if {one.body.lower() for one in found} & placed - later:
            return False

        context = problem.context
        poses = {name: body.pose for name, body in truth.scene.bodies.items() if body.movable}
        held = context.holding
        if held is not None:
            poses.pop(held.body, None)

        base, arm = np.array(truth.scene.robot.base), context.home
        names = {name.lower(): name for name in truth.scene.bodies}
        should = expected.poses

        for segment in (segment for action in remaining for segment in action.segments):
            if segment.attach is not None:
                name = names.get(segment.attach.body)
                if name is None or name not in poses:
                    return False
                if name in should and not _same(poses[name].matrix, should[name]):
                    return False
                held = Grasp(
                    name, Pose.from_matrix(segment.attach.T_tool_body), segment.attach.opening
                )
                poses.pop(name)

            elif segment.detach is not None and held is not None:
                tool = Pose.from_matrix(context.kinematics.tool(context.conf(base, arm)))
                poses[held.body] = tool @ held.T_tool_body
                should.pop(held.body, None)
                held = None

            elif segment.part != "gripper":
                attachment = None if held is None else context.attachment(held)
                arrangement = context.collisions.arrangement(poses, attachment)
                rows = [
                    context.conf(row, arm) if segment.part == "base" else context.conf(base, row)
                    for row in segment.positions
                ]
                if arrangement.path_hits(np.array(rows), step=0.01) is not None:
                    return False
                base, arm = rows[-1][:3], rows[-1][3:]

        return True


def _placed_so(goal: Formula, bodies: Collection[str]) -> set[str]:
    """Return the bodies, in PDDL's names, of which the goal asks what another pose may not give;
    all of them for a variable.
    """
    terms = {
        term
        for atom, _ in signed_atoms(goal)
        if atom.predicate not in COMPARED_RELATIONS
        for term in atom.terms
    }
    return {*bodies} if any(term.startswith("?") for term in terms) else terms


def _same(first: Array, second: Array) -> bool:
    moved, turned = pose_difference(first, second)
    return moved <= SAME_POSE_TOLERANCE[0] and turned <= SAME_POSE_TOLERANCE[1]


def is_given(sampler: str) -> bool:
    """Check whether a plan's sampler was an object, which no file keeps."""
    return sampler.partition(":")[0] == USER_OBJECT
