"""The optimistic task: the symbolic task over placeholders, as far as knowledge does not forbid."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from tamp.symbolic.algorithms.knowledge import Knowledge
from tamp.symbolic.algorithms.optimistic.optimistic_facts import OptimisticFacts
from tamp.symbolic.algorithms.optimistic.optimistic_instantiation import (
    MAX_DEPTH,
    MAX_INSTANCES,
    instantiate_streams,
)
from tamp.symbolic.algorithms.planning_task import PlanningTask
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.operators import InstantiatedTask

MAX_DEPTH_FACTOR = 8
"""How many times the first depth and number of instances are instantiated at most, when there is no
plan with fewer."""


@dataclass(frozen=True, eq=False)
class OptimisticTask:
    """Optimistic facts, and the task instantiated over them."""

    facts: OptimisticFacts
    instantiated: InstantiatedTask

    @property
    def goal_is_reachable(self) -> bool:
        """Return whether each goal fact can become true, if nothing is ever undone."""
        reached = self.instantiated.reachable | self.instantiated.initial
        return self.instantiated.goal.positive <= reached


def optimistic_task(task: PlanningTask, knowledge: Knowledge) -> OptimisticTask:
    """Instantiate the optimistic task without the calls that are known to have ended.

    Where instances have to be left out, those that are not deeper than a first plan asks for are
    all that is kept: the knowledge's depth limit is set, and raised until the goal is reachable, or
    until it is their number that keeps them shallow.
    """
    made = _over_certified(task, knowledge)
    while _is_limited(knowledge) and not made.goal_is_reachable:
        if made.facts.crowded:
            knowledge.depth_limit = MAX_DEPTH * knowledge.depth_factor
            break
        knowledge.depth_limit = (knowledge.depth_limit or 0) + 1
        made = _over_certified(task, knowledge)
    return made


def sampled_task(task: PlanningTask, knowledge: Knowledge) -> OptimisticTask:
    """Instantiate the task over sampled facts; only fluent streams' outputs are placeholders."""
    facts = instantiate_streams(
        [stream for stream in task.streams if stream.is_fluent],
        [*task.initial_facts, *knowledge.sampled_facts],
        max_depth=1,
        placeholders=knowledge.placeholders,
    )
    return _instantiated(task, knowledge, knowledge.sampled_facts, facts)


def raise_depth_limit(knowledge: Knowledge, made: OptimisticTask) -> bool:
    """Allow for more instances where some were left out; say if anything can be added."""
    if made.facts.complete:
        return False
    if _is_limited(knowledge):
        knowledge.depth_limit = (knowledge.depth_limit or 0) + 1
        return True
    if knowledge.depth_factor >= MAX_DEPTH_FACTOR:
        knowledge.incomplete = True
        return False
    knowledge.depth_factor *= 2
    return True


def _over_certified(task: PlanningTask, knowledge: Knowledge) -> OptimisticTask:
    """Instantiate over certified facts, as deep as the limit allows."""
    facts = _within_the_limit(task, knowledge)
    return _instantiated(task, knowledge, knowledge.certified_facts, facts)


def _is_limited(knowledge: Knowledge) -> bool:
    """Check that instances are kept shallower than they might be."""
    limit = knowledge.depth_limit
    return limit is not None and limit < MAX_DEPTH * knowledge.depth_factor


def _within_the_limit(task: PlanningTask, knowledge: Knowledge) -> OptimisticFacts:
    """Instantiate as much as may be; the lowest level alone, once those were too many."""
    if knowledge.depth_limit is None:
        facts = _optimistic_facts(task, knowledge)
        if facts.complete:
            return facts
        knowledge.depth_limit = 1
    return _optimistic_facts(task, knowledge)


def _optimistic_facts(task: PlanningTask, knowledge: Knowledge) -> OptimisticFacts:
    """Instantiate the streams that may give something new for objects that are not excluded."""
    excluded = knowledge.excluded_objects
    initial: tuple[Fact, ...] | list[Fact] = task.initial_facts
    if excluded:
        initial = [fact for fact in initial if excluded.isdisjoint(fact)]

    return instantiate_streams(
        task.streams,
        [*initial, *knowledge.certified_facts],
        ended=knowledge.ended_calls,
        max_depth=MAX_DEPTH * knowledge.depth_factor,
        max_generator_depth=knowledge.depth_limit,
        max_instances=MAX_INSTANCES * knowledge.depth_factor,
        placeholders=knowledge.placeholders,
    )


def _instantiated(
    task: PlanningTask, knowledge: Knowledge, certified: Iterable[Fact], facts: OptimisticFacts
) -> OptimisticTask:
    """Instantiate the symbolic task over certified facts and what is optimistic."""
    facts.lazily_tested = task.lazily_tested
    instantiated = task.instantiate(certified, facts, frozenset(knowledge.false_facts))
    return OptimisticTask(facts, instantiated)
