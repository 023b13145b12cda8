"""Results of planning over streams: the outcome, the plan, and what was tried."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator, Iterable, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from enum import Enum

from tamp.symbolic.algorithms.binding.skeleton import Skeleton
from tamp.symbolic.algorithms.bound_stream import BoundStream, Objects
from tamp.symbolic.algorithms.cause import Cause, named_objects
from tamp.symbolic.algorithms.costs import BoundFunction
from tamp.symbolic.algorithms.experience.failure_counts import FailureCount
from tamp.symbolic.algorithms.experience.stream_statistics import StreamStatistics
from tamp.symbolic.algorithms.experience.success_posterior import Posterior
from tamp.symbolic.pddl.structs import Fact, Task


class Outcome(Enum):
    """An outcome of planning; the value is the sentence that a user reads."""

    SOLVED = "Solved"
    INFEASIBLE = "No plan: infeasible"
    EXHAUSTED = "No plan: everything there was to try failed"
    TIMEOUT = "No plan in the time given"
    INTERRUPTED = "Interrupted before a plan was found"


@dataclass(frozen=True)
class StreamTask:
    """A symbolic task and the streams that extend it.

    Attributes:
        task: Objects, initial facts (static ones too) and goal.
        streams: Bound to their functions.
        values: The objects' values, where they are more than their names.
        functions: Costs that Python computes.
        by_value: Whether equal values are one object.
        posteriors: What earlier runs say of streams, by name; those that fail often are avoided
            from the start.
    """

    task: Task
    streams: tuple[BoundStream, ...]
    values: Mapping[str, object]
    functions: tuple[BoundFunction, ...] = ()
    by_value: bool = False
    posteriors: Mapping[str, Posterior] = field(default_factory=dict[str, Posterior])

    def named(self, words: Iterable[str]) -> tuple[str, ...]:
        """Return those of the words that name objects a user knows: not poses, grasps, paths."""
        names = (*self.task.objects, *self.task.domain.constants)
        return named_objects(words, {x for x in names if isinstance(self.values.get(x, x), str)})


@dataclass(frozen=True)
class PlanAction:
    """An action of a plan: its name and the names of its arguments."""

    name: str
    arguments: tuple[str, ...]
    cost: float = 1.0


@dataclass
class SearchStatistics:
    """The effort of a run: how much was done.

    Attributes:
        searches: Symbolic searches.
        expanded: Search nodes expanded.
        skeletons: Different action plans that were tried to be bound.
        draws: Stream calls.
        search_seconds: Wall-clock time in search and instantiation.
        explaining_seconds: Wall-clock time in saying why there is no plan.
        apart_seconds: Wall-clock time of the run's other part: a second opinion, or what was tried
            before it.
        refuted: Bound plans that did not hold when they were replayed, though the planner thought
            so.
    """

    searches: int = 0
    expanded: int = 0
    skeletons: int = 0
    draws: int = 0
    search_seconds: float = 0.0
    explaining_seconds: float = 0.0
    apart_seconds: float = 0.0
    refuted: int = 0

    @contextmanager
    def searching(self) -> Generator[None]:
        """Count the time inside as search and instantiation."""
        started = time.perf_counter()
        try:
            yield
        finally:
            self.search_seconds += time.perf_counter() - started

    @contextmanager
    def explaining(self) -> Generator[None]:
        """Count the time inside as spent on saying why there is no plan."""
        started = time.perf_counter()
        try:
            yield
        finally:
            self.explaining_seconds += time.perf_counter() - started


@dataclass(frozen=True)
class SkeletonAttempt:
    """A skeleton that was tried.

    Attributes:
        actions: Its actions with the objects of the problem among their arguments.
        rounds: How often it was tried without success.
        bound: Whether it became the plan.
        failures: What failed most, a line a cause.
    """

    actions: tuple[str, ...]
    rounds: int
    bound: bool
    failures: tuple[str, ...]


def _none() -> tuple[SkeletonAttempt, ...]:
    return ()


@dataclass
class Result:
    """The symbolic side of a solution.

    Attributes:
        actions: The plan, empty unless solved.
        certified: Static facts that streams certified and the plan rests on.
        objects: Names, types and values of everything in it.
        causes: Why there is no plan.
        tallies: What was tried for which action, where there is no plan.
        memory: What the streams have learned in the run, as they keep it.
        attempts: Says which skeletons were tried, to those who ask.
        skeleton: Of the plan, unless another run, asked for a second opinion, found it.
    """

    outcome: Outcome
    objects: Objects
    actions: tuple[PlanAction, ...] = ()
    certified: tuple[Fact, ...] = ()
    statistics: dict[str, StreamStatistics] = field(default_factory=dict[str, StreamStatistics])
    effort: SearchStatistics = field(default_factory=SearchStatistics)
    causes: tuple[Cause, ...] = ()
    tallies: tuple[FailureCount, ...] = ()
    warnings: tuple[str, ...] = ()
    memory: Mapping[str, object] = field(default_factory=dict[str, object])
    attempts: Callable[[], tuple[SkeletonAttempt, ...]] = _none
    skeleton: Skeleton | None = None

    @property
    def explanation(self) -> tuple[str, ...]:
        """Return why there is no plan, a line a cause."""
        return tuple(cause.text for cause in self.causes)


Progress = Callable[[SearchStatistics], None]
"""Called between rounds with what was done so far."""
