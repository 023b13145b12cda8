"""The task of one run as the algorithms see it: useful streams, initial facts, costs, objects."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from tamp.symbolic.algorithms.bound_stream import BoundStream, Objects
from tamp.symbolic.algorithms.costs import Costs
from tamp.symbolic.algorithms.optimistic.anything import anything
from tamp.symbolic.algorithms.optimistic.assumable_tests import assumable, given_for
from tamp.symbolic.algorithms.optimistic.optimistic_facts import OptimisticFacts
from tamp.symbolic.algorithms.optimistic.optimistic_instantiation import (
    relevant,
    type_facts,
    used_predicates,
)
from tamp.symbolic.algorithms.result import StreamTask
from tamp.symbolic.pddl.structs import Atom, Fact, Formula, Task
from tamp.symbolic.search.instantiation.instantiator import Instantiator
from tamp.symbolic.search.instantiation.predicate_kinds import Assumed
from tamp.symbolic.search.operators import InstantiatedTask


@dataclass(frozen=True, eq=False)
class PlanningTask:
    """A stream task prepared for a run; nothing of it changes but the objects, which grow.

    Attributes:
        problem: The task and its streams as they were given.
        task: The symbolic task, its costs computed.
        objects: The run's objects, those that streams give among them.
        costs: Of actions.
        streams: Those that are instantiated.
        lazily_tested: Predicates of tests that are taken to hold wherever they are asked for, each
            with its stream and the atom that it certifies (see `assumable`).
        assumed: The same with the facts that must be given for that (see `given_for`).
        initial_facts: The initial facts, and types as facts.
        shown_facts: Initial facts that no action changes and that streams are shown.
        instantiator: Of the symbolic task.
    """

    problem: StreamTask
    task: Task
    objects: Objects
    costs: Costs
    streams: tuple[BoundStream, ...]
    lazily_tested: Mapping[str, tuple[BoundStream, Atom]]
    assumed: Assumed
    initial_facts: tuple[Fact, ...]
    shown_facts: frozenset[Fact]
    instantiator: Instantiator

    def instantiate(
        self,
        certified: Iterable[Fact],
        optimistic: OptimisticFacts,
        false_facts: frozenset[Fact],
        goal: Formula | None = None,
    ) -> InstantiatedTask:
        """Instantiate the symbolic task over certified and optimistic facts.

        Args:
            certified: Static facts beside the initial ones.
            optimistic: What streams may make true, and the types of the placeholders.
            false_facts: Facts of lazy tests that are known not to hold.
            goal: Another goal than the task's.
        """
        facts = [*certified, *optimistic.producers]
        types = {**self.objects.types, **optimistic.types}
        instantiator = self.instantiator
        if goal is not None:
            other = replace(self.task, goal=goal)
            instantiator = Instantiator(other, self.assumed)
        return instantiator.instantiate(facts, types, false_facts)


def prepare(problem: StreamTask, *, pruned: bool = True) -> PlanningTask:
    """Prepare a task for a run.

    Args:
        problem: The task and its streams.
        pruned: Leave out the streams whose facts nothing asks for.
    """
    task = problem.task
    objects = Objects(
        {**task.domain.constants, **task.objects},
        {**{name: name for name in task.domain.constants}, **problem.values},
        by_value=problem.by_value,
    )
    costs = Costs(problem.functions, objects, task.costs)

    wanted = anything(task)
    useful = relevant(
        problem.streams,
        used_predicates(task),
        lambda types: any(task.domain.fits(types, want) for want in wanted),
    )
    lazily_tested = assumable(useful, task)
    assumed = given_for(lazily_tested, problem.streams, task)
    tests = {stream.name for stream, _ in lazily_tested.values()}
    streams = useful if pruned else problem.streams

    shown = {name for stream in problem.streams for name in stream.declaration.fluents}
    shown -= task.domain.fluent_predicates
    priced = replace(task, costs=costs)
    return PlanningTask(
        problem=problem,
        task=priced,
        objects=objects,
        costs=costs,
        streams=tuple(stream for stream in streams if stream.name not in tests),
        lazily_tested=lazily_tested,
        assumed=assumed,
        initial_facts=(*sorted(task.initial), *type_facts(task)),
        shown_facts=frozenset(fact for fact in task.initial if fact[0] in shown),
        instantiator=Instantiator(priced, assumed),
    )
