"""The incremental algorithm, a reference: sample level by level, then search over what is known.

After PDDLStream's incremental algorithm (Garrett, Lozano-Perez, Kaelbling, ICAPS 2020). Streams
that certify something about the state that they are shown cannot be called before there is a plan;
they stay optimistic, and are bound last.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from tamp.symbolic.algorithms.bound_stream import Instance
from tamp.symbolic.algorithms.optimistic.anything import distinguishes
from tamp.symbolic.algorithms.optimistic.optimistic_instantiation import Optimism, imagine
from tamp.symbolic.algorithms.planning_run import Run
from tamp.symbolic.algorithms.result import Outcome, Progress, Result, StreamTask
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.instantiation.instantiator import Instantiator
from tamp.symbolic.search.mutex import excluded
from tamp.symbolic.search.operators import InstantiatedTask
from tamp.system.deadline import Deadline, OutOfTime
from tamp.system.garbage import seldom_collecting

PER_LEVEL = 2
"""Values drawn from each generator instance a level."""

ROUNDS = 4
"""Plans whose fluent streams are tried before the next level."""

DRY = 50
"""Rounds without anything left to draw after which prices have moved all that they can."""

TWIN = " again"
"""Ends the name of a stream's double; no PDDL name has a blank."""

TRIES, BUDGET = 4, 200
"""Draws a visit, and in all, when the fluent streams of a plan are bound."""


def solve_incremental(
    problem: StreamTask,
    make_rng: Callable[[str], Any],
    deadline: Deadline,
    progress: Progress,
) -> Result:
    """Plan; the arguments are those of `solve_adaptive`."""
    return Incremental(problem, make_rng, deadline, progress).solve()


class Incremental(Run):
    """Keeps the real facts found so far; `imagined` looks at those instead of placeholders."""

    def __init__(
        self,
        problem: StreamTask,
        make_rng: Callable[[str], Any],
        deadline: Deadline,
        progress: Progress,
        *,
        pruned: bool = True,
    ) -> None:
        self.found: dict[Fact, Instance | None] = {}
        super().__init__(problem, make_rng, deadline, progress, pruned=pruned)
        self.streams.ahead = True

    @seldom_collecting()
    def solve(self, most: int | None = None) -> Result:
        """Sample a level, search and bind what is left, until a plan is found or nothing is new.

        Args:
            most: Draws after which no further level is begun.

        Raises:
            OutOfTime: The deadline passed, and `most` was given.
        """
        try:
            if most is None and self._excluded_from_the_start():
                return self.hopeless()
            while True:
                fresh = self._sample()
                result = self._searched(ROUNDS if fresh else None)
                if result is not None:
                    return result
                if not fresh:
                    return self.hopeless()
                if most is not None and self.binder.units >= most:
                    return self.result(Outcome.EXHAUSTED)
                self.progress(self.effort)
        except OutOfTime:
            if most is not None:  # who asked for so many draws has more to say
                raise
            return self.stopped(Outcome.TIMEOUT)
        except KeyboardInterrupt:
            return self.stopped(Outcome.INTERRUPTED)

    def _excluded_from_the_start(self) -> bool:
        """Check that goals exclude each other whatever streams give: sampling never says so.

        A placeholder stands for all values of a call, which hides plans that take two of them: with
        a second one for each call the goals have to exclude each other as well, and no condition
        may want such values to differ.
        """
        if distinguishes(
            self.task, [types for stream in self.useful for types in stream.output_types]
        ):
            return False

        twins = [
            replace(stream, declaration=replace(stream.declaration, name=f"{stream.name}{TWIN}"))
            for stream in self.useful
            if not stream.is_test
        ]

        imagined: list[tuple[Optimism, InstantiatedTask]] = []
        for streams in (self.useful, [*self.useful, *twins]):
            optimism = imagine(streams, self.known)
            if not optimism.complete:
                return False
            optimism.assumed = self.assumed
            types = {**self.objects.types, **optimism.types}
            instantiated = Instantiator(self.task, frozenset(self.assumed)).instantiate(
                list(optimism.makers), types
            )
            if excluded(instantiated, self.deadline) is None:
                return False
            imagined.append((optimism, instantiated))

        self.optimism, self.instantiated = imagined[0]
        return True

    def promise(self, name: str) -> Fact | None:
        """Return a fact that certifies a name, as every run does; the values are those found."""
        found = next((fact for fact in self.found if name in fact[1:]), None)
        return found or super().promise(name)

    def _searched(self, rounds: int | None) -> Result | None:
        """Search, bind and learn until a plan is bound, nothing is new or rounds end."""
        dry = 0
        while rounds is None or rounds > 0:
            self.optimism, self.instantiated = self.imagined()
            found = self.search()
            if self.deadline.passed:
                raise OutOfTime
            if found.plan is None:
                return None

            skeleton = self.skeleton(found.plan)
            self.latest = skeleton
            before = self.binder.units
            values = self.bind(skeleton, TRIES, BUDGET)
            if values is not None:
                return self.solved(skeleton, values)

            if not self.bury(skeleton):
                dry = dry + 1 if self.binder.units == before else 0
                if dry >= DRY:
                    # there are plans, whose streams fail in the states that these lead through
                    self.given_up = True
                    return None
                rounds = None if rounds is None else rounds - 1
        return None

    def _sample(self) -> bool:
        """Call every stream instance that known facts allow; say if any may give more."""
        static = [stream for stream in self.useful if not stream.is_fluent]
        fresh = False
        known = [*self.known, *self.found]
        for guess in imagine(static, known, levels=1).guesses:
            if all(fact in self.found for fact in guess.certified):
                continue

            shown = [fact for fact in self.known if fact[0] in guess.stream.declaration.fluents]
            instance = self.streams.instance(guess.stream.name, guess.inputs, frozenset(shown))
            for _ in range(1 if guess.stream.is_test else PER_LEVEL):
                if self.deadline.passed:
                    raise OutOfTime
                if instance.exhausted:
                    break
                fresh = True
                self.binder.units += 1
                outputs = self.streams.draw(instance)
                if outputs is not None:
                    for fact in self.streams.certified(instance, outputs):
                        self.found.setdefault(fact, instance)
                for fact in self.streams.wild:
                    self.found.setdefault(fact, None)

            self.given_up |= (
                instance.exhausted and instance.last is not None and instance.last.given_up
            )
            if instance.exhausted and not instance.results and instance.last is not None:
                self.dead[guess.stream.name, guess.inputs] = instance.last
        return fresh

    def sampled(self) -> dict[Fact, Instance | None]:
        """Return what was sampled so far."""
        return self.found

    def imagined(self) -> tuple[Optimism, InstantiatedTask]:
        """Instantiate the task over real facts, only fluent streams' outputs are placeholders."""
        started = time.perf_counter()
        fluent = [stream for stream in self.useful if stream.is_fluent]
        optimism = imagine(fluent, [*self.known, *self.found], levels=1, names=self.names)
        optimism.assumed = self.assumed
        facts = [*self.found, *optimism.makers]
        types = {**self.objects.types, **optimism.types}
        instantiated = self.instantiator.instantiate(facts, types, frozenset(self.refused))
        self.effort.search_seconds += time.perf_counter() - started
        return optimism, instantiated
