"""A plan with everything that belongs to it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from tamp.geometric.samplers.mixture import SamplerRecord
from tamp.planner.problem import Problem
from tamp.planner.recorder import Record
from tamp.planner.timed_trajectories import Trajectory
from tamp.symbolic.algorithms.cause import Cause
from tamp.symbolic.algorithms.experience.failure_counts import FailureCount
from tamp.symbolic.algorithms.experience.stream_statistics import StreamStatistics
from tamp.symbolic.algorithms.result import Outcome, SearchStatistics
from tamp.symbolic.pddl.structs import Fact


@dataclass(frozen=True)
class Action:
    """An action of a plan.

    Attributes:
        name: As in the domain.
        arguments: Names of all its arguments; their values are in `Solution.values`.
        objects: Those among them that the scene knows: bodies, surfaces, containers.
        trajectory: What the robot does.
        start: Seconds from the plan's start.
    """

    name: str
    arguments: tuple[str, ...]
    objects: tuple[str, ...]
    trajectory: Trajectory
    start: float
    cost: float = 1.0


@dataclass(frozen=True)
class Improvement:
    """A plan that was better than those before it.

    Attributes:
        seconds: When it was found, from the start of planning.
        cost: The sum of its actions' costs.
        actions: Their number.
        duration: Seconds of motion.
    """

    seconds: float
    cost: float
    actions: int
    duration: float


@dataclass(frozen=True)
class Solution:
    """The solution that `solve` returns, with a plan or without one.

    Attributes:
        outcome: How planning ended.
        plan: The actions in order, empty unless solved.
        values: The value of every name in the plan: poses, grasps, base configurations, reaches,
            motions.
        certified: The facts that streams certified and the plan rests on.
        causes: Why there is no plan; `explanation` has their texts.
        tallies: What was tried for which action, where there is no plan.
        seconds: Wall-clock time: "total", "search", "timing", and by stream.
        record: What was tried, when `solve` was asked to record it.
        improvements: The plans on the way to this one and itself, where the first was not enough.
        bound: What no plan of the optimistic task costs less than, where it was asked for.
        samplers: What became of the proposals of each relation's generators, those that were asked.
    """

    problem: Problem
    outcome: Outcome
    seed: int
    algorithm: str
    plan: tuple[Action, ...] = ()
    values: Mapping[str, object] = field(default_factory=dict[str, object])
    certified: tuple[Fact, ...] = ()
    statistics: Mapping[str, StreamStatistics] = field(default_factory=dict[str, StreamStatistics])
    effort: SearchStatistics = field(default_factory=SearchStatistics)
    causes: tuple[Cause, ...] = ()
    tallies: tuple[FailureCount, ...] = ()
    warnings: tuple[str, ...] = ()
    seconds: Mapping[str, float] = field(default_factory=dict[str, float])
    record: Record | None = None
    samplers: Mapping[str, tuple[SamplerRecord, ...]] = field(
        default_factory=dict[str, "tuple[SamplerRecord, ...]"]
    )
    improvements: tuple[Improvement, ...] = ()
    bound: float | None = None

    @property
    def solved(self) -> bool:
        """Tell whether there is a plan."""
        return self.outcome is Outcome.SOLVED

    @property
    def explanation(self) -> tuple[str, ...]:
        """Return why there is no plan, a line a cause."""
        return tuple(cause.text for cause in self.causes)

    @property
    def cost(self) -> float:
        """Return the sum of the actions' costs."""
        return sum(action.cost for action in self.plan)

    @property
    def gap(self) -> float | None:
        """Return the part of the cost that the bound leaves open: 0 when no plan is cheaper."""
        if self.bound is None or not self.plan:
            return None
        return max(0.0, 1.0 - self.bound / self.cost) if self.cost > 0.0 else 0.0

    @property
    def duration(self) -> float:
        """Return seconds of motion."""
        return sum(action.trajectory.duration for action in self.plan)
