"""The optimistic task of a run: what is imagined, how deep, and without calls known as dead."""

from __future__ import annotations

import time
from dataclasses import replace

from tamp.stream import Rejection
from tamp.symbolic.algorithms.bound_stream import Objects
from tamp.symbolic.algorithms.costs import Costs
from tamp.symbolic.algorithms.optimistic.anything import anything
from tamp.symbolic.algorithms.optimistic.assumable_tests import assumable
from tamp.symbolic.algorithms.optimistic.optimistic_instantiation import (
    ENOUGH,
    LEVELS,
    Named,
    Optimism,
    imagine,
    relevant,
    type_facts,
    used_predicates,
)
from tamp.symbolic.algorithms.result import Effort, StreamTask
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.instantiation.instantiator import Instantiator
from tamp.symbolic.search.operators import InstantiatedTask

DEEPEST = 8
"""How many times the first depth and number of guesses are imagined at most, when there is no plan
with fewer."""


class Imagination:
    """The task with placeholders for what streams may give, imagined anew as calls die.

    Args:
        problem: The task and its streams.
        pruned: Leave out the streams whose facts nothing asks for.
    """

    def __init__(self, problem: StreamTask, pruned: bool) -> None:
        task = problem.task
        self.problem = problem
        self.objects = Objects(
            {**task.domain.constants, **task.objects},
            {**{name: name for name in task.domain.constants}, **problem.values},
            by_value=problem.by_value,
        )
        self.costs = Costs(problem.functions, self.objects, task.costs)
        self.task = replace(task, costs=self.costs)

        self.effort = Effort()
        self.dead: dict[tuple[str, tuple[str, ...]], Rejection] = {}
        self.given_up = False
        self.depth = 1
        self.shallow: int | None = None

        self.aside = self.bystanders()
        wanted = anything(task)
        useful = relevant(
            problem.streams,
            used_predicates(task),
            lambda types: any(task.domain.fits(types, want) for want in wanted),
        )
        self.assumed = assumable(useful, task)
        tests = {stream.name for stream, _ in self.assumed.values()}
        self.useful = [s for s in (useful if pruned else problem.streams) if s.name not in tests]

        self.refused: set[Fact] = set()
        self.names: dict[tuple[str, tuple[str, ...]], Named] = {}
        self.settled: set[tuple[str, tuple[str, ...]]] = set()
        self.real: dict[Fact, None] = {}

        self.known = [*sorted(task.initial), *type_facts(task)]
        changing = task.domain.fluent_predicates
        shown = {
            name for stream in problem.streams for name in stream.declaration.fluents
        } - changing
        self.given = frozenset(fact for fact in task.initial if fact[0] in shown)

        self.instantiator = Instantiator(self.task, frozenset(self.assumed))
        self.optimism, self.instantiated = self.imagined()

    def bystanders(self) -> frozenset[str]:
        """Return the objects of which nothing is imagined at first: none, unless overridden."""
        return frozenset()

    def recall(self, objects: frozenset[str] | None = None) -> bool:
        """Imagine these as well that were set aside, or all of them; say if there were any."""
        recalled = self.aside if objects is None else objects & self.aside
        if recalled:
            self.aside -= recalled
            self.optimism, self.instantiated = self.imagined()
        return bool(recalled)

    def imagined(self) -> tuple[Optimism, InstantiatedTask]:
        """Instantiate the optimistic task without the calls that are known to be dead.

        Where guesses have to be left out, those that are not deeper than a first plan asks for are
        all that is kept.
        """
        started = time.perf_counter()
        try:
            optimism = self._guesses()
            instantiated = self._instantiated(optimism)
            while (
                self._shallower()
                and not instantiated.goal.positive <= instantiated.reachable | instantiated.initial
            ):
                self.shallow = (self.shallow or 0) + 1
                optimism = self._guesses()
                instantiated = self._instantiated(optimism)
            return optimism, instantiated
        finally:
            self.effort.search_seconds += time.perf_counter() - started

    def _guesses(self) -> Optimism:
        """Guess as much as may be; the lowest level alone, once those were too many."""
        optimism = Optimism(complete=False)
        if self.shallow is None:
            optimism = self._imagined(None)
            self.shallow = None if optimism.complete else 1
        return self._imagined(self.shallow) if self.shallow is not None else optimism

    def _imagined(self, deepest: int | None) -> Optimism:
        known = (
            [fact for fact in self.known if self.aside.isdisjoint(fact)]
            if self.aside
            else self.known
        )
        optimism = imagine(
            self.useful,
            [*known, *self.real],
            dead=frozenset((*self.dead, *self.settled)),
            levels=LEVELS * self.depth,
            deepest=deepest,
            enough=ENOUGH * self.depth,
            names=self.names,
        )
        optimism.assumed = self.assumed
        return optimism

    def _instantiated(self, optimism: Optimism) -> InstantiatedTask:
        facts = [*self.real, *optimism.makers]
        types = {**self.objects.types, **optimism.types}
        return self.instantiator.instantiate(facts, types, frozenset(self.refused))

    def _shallower(self) -> bool:
        """Check that guesses are kept shallower than they might be."""
        return self.shallow is not None and self.shallow < LEVELS * self.depth

    def deepen(self) -> bool:
        """Imagine more where guesses were left out; say if anything could be added."""
        if not self.optimism.complete and self._shallower():
            self.shallow = (self.shallow or 0) + 1
        elif self.optimism.complete or self.depth >= DEEPEST:
            self.given_up |= not self.optimism.complete
            return False
        else:
            self.depth *= 2
        self.optimism, self.instantiated = self.imagined()
        return True
