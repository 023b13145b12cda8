"""The adaptive algorithm: search optimistic facts, bind stream calls, learn from what fails.

After PDDLStream's adaptive algorithm (Garrett, Lozano-Perez, Kaelbling, ICAPS 2020), in one
process, its effort divided by counted work instead of the clock, so that the same seed gives the
same plan.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from tamp.symbolic.algorithms.binding.skeleton import Skeleton
from tamp.symbolic.algorithms.incremental import DRY, Incremental
from tamp.symbolic.algorithms.optimistic.anything import distinguishes
from tamp.symbolic.algorithms.optimistic.irrelevant_objects import blamed, bystanders
from tamp.symbolic.algorithms.planning_run import Run
from tamp.symbolic.algorithms.result import Outcome, Progress, Result, StreamTask
from tamp.system.deadline import Deadline, OutOfTime
from tamp.system.garbage import seldom_collecting

FIRST_TRIES = 4
"""Draws a visit of a stream call in a skeleton's first round, one more in each later one: a bad
grasp shall not be tried with all poses before the next one has its turn."""

ROUND_BUDGET = 200
"""Draws in a skeleton's first round at least."""

NODE_BUDGET = 5
"""Draws for each of its nodes: a long one shall be gone through more than once, since its search
was long as well."""

PATIENCE = 1000
"""Failures of one thing without a success after which the incremental algorithm is asked; doubled
each time."""

SECOND_OPINION = 2
"""Draws that it gets for each of those failures."""

TRAILS = 10
"""Rounds after which it is asked as well, doubled each time, where rounds draw little and operators
are many: streams that give one value and end have each plan of a tree tried in turn, while calling
all of them is cheap."""

LOOK = 100
"""Draws for a look at real values before a task counts as infeasible whose values may have to
differ."""

LITTLE = 20
"""Draws a round that are little; it gets ten times as many."""

MANY = 1000
"""Operators that are many."""

DEEPER = 20
"""Rounds after which guesses that were kept shallow go one level deeper, doubled each time."""


def solve_adaptive(
    problem: StreamTask,
    make_rng: Callable[[str], Any],
    deadline: Deadline,
    progress: Progress,
) -> Result:
    """Plan by the adaptive algorithm.

    Some plans do not show in the optimistic task, such as putting a body down only to grasp it
    anew: all poses and grasps look alike there. So when something fails and fails, the incremental
    algorithm is asked for a second opinion.

    Args:
        problem: The task and its streams.
        make_rng: A random generator from a string (see Streams).
        deadline: When to give up.
        progress: Told between rounds.
    """
    return Adaptive(problem, make_rng, deadline, progress).solve()


RECALL = 3
"""Rounds of a skeleton after which things are imagined of all that was set aside, even if nothing
blames it."""


class Adaptive(Run):
    """One run of the algorithm.

    Attributes:
        bound: The skeleton of the plan that was found and its values, unless the second opinion
            found it.
    """

    bound: tuple[Skeleton, dict[int, str]] | None = None

    @seldom_collecting()
    def solve(self) -> Result:
        """Alternate search and binding until a plan is bound, nothing is left, or time is up."""
        patience, dry, trails, deeper = PATIENCE, 0, TRAILS, DEEPER
        try:
            while True:
                before = self.binder.units
                result = self._round()
                if result is not None:
                    return result

                dry = dry + 1 if self.binder.units == before else 0
                if dry >= DRY or (self.shallow is not None and self.effort.searches >= deeper):
                    deepened, deeper = self.recall() or self.deepen(), 2 * deeper
                    if dry >= DRY and not deepened:
                        return self.result(Outcome.EXHAUSTED)
                    dry = 0 if deepened else dry

                draws = 0
                if self._stuck(patience):
                    draws, patience = SECOND_OPINION * patience, 2 * patience
                elif dry == 0 and self._wanders(trails):
                    draws, trails = 10 * LITTLE * trails, 2 * trails

                if draws:
                    result = self._second_opinion(draws)
                    if result.outcome in (Outcome.SOLVED, Outcome.INTERRUPTED):
                        return result
                self.progress(self.effort)
        except OutOfTime:
            return self.stopped(Outcome.TIMEOUT)
        except KeyboardInterrupt:
            return self.stopped(Outcome.INTERRUPTED)

    def _second_opinion(self, draws: int) -> Result:
        """Run the incremental algorithm for a while; each is told the time that the other took."""
        began = time.perf_counter()
        try:
            second = Incremental(self.problem, self.make_rng, self.deadline, self.progress)
            second.streams.remember(self.streams)
            result = second.solve(draws)
            result.effort.apart_seconds = max(
                0.0, self.deadline.elapsed() - (time.perf_counter() - began)
            )
            return result
        finally:
            self.effort.apart_seconds += time.perf_counter() - began

    def _round(self) -> Result | None:
        """Search, bind, learn."""
        found = self.search()
        if found.plan is None:
            if self.deadline.passed:
                raise OutOfTime
            self.doubtful = True
            return None if self.recall() or self.deepen() else (self._looked() or self.hopeless())

        skeleton = self.skeleton(found.plan)
        self.latest = skeleton
        tries = FIRST_TRIES + skeleton.rounds
        budget = max(ROUND_BUDGET, NODE_BUDGET * len(skeleton.nodes)) * (1 + skeleton.rounds)

        values = self.bind(skeleton, tries, budget)
        if values is not None:
            self.bound = skeleton, values
            return self.solved(skeleton, values)

        skeleton.rounds += 1
        self.effort.draws = self.binder.units
        learned = self.absorb()
        learned |= self.bury(skeleton)
        recalled = self.recall(
            blamed(self.aside, self.experience) if skeleton.rounds < RECALL else None
        )
        if learned and not recalled:
            self.optimism, self.instantiated = self.imagined()
        return None

    def _looked(self) -> Result | None:
        """Look for a plan with two values of one call, which placeholders, one value each, hide.

        Where the goal is out of reach even if nothing is ever undone, and no condition wants values
        to differ, there is none. Else real values are looked at, a few; if these are all that there
        are, and plans with them fail in the states that they lead through, nothing is proven.
        """
        goal = self.instantiated.goal.positive
        reached = goal <= self.instantiated.reachable | self.instantiated.initial
        if (
            self.problem.by_value
            or not self.problem.streams
            or not (reached or distinguishes(self.task))
        ):
            # whoever has values equal that come from different calls looks more closely
            return None

        second = Incremental(self.problem, self.make_rng, self.deadline, self.progress)
        second.brief = True
        second.streams.remember(self.streams)
        try:
            result = second.solve(LOOK)
        except OutOfTime:
            return None

        self.given_up = self.given_up or (
            result.outcome is Outcome.EXHAUSTED and second.binder.units < LOOK
        )
        return result if result.outcome in (Outcome.SOLVED, Outcome.INTERRUPTED) else None

    def bystanders(self) -> frozenset[str]:
        """Return the objects that the goal does not name: imagined once they are in the way."""
        return bystanders(self.problem.task)

    def _wanders(self, rounds: int) -> bool:
        """Check that so many rounds went from plan to plan in a large task and drew little."""
        few = self.binder.units < LITTLE * rounds
        return self.effort.searches >= rounds and few and len(self.instantiated.operators) >= MANY

    def _stuck(self, patience: int) -> bool:
        """Check that even the cheapest plan rests on what failed that often without a success."""
        nodes = () if self.latest is None else self.latest.nodes
        records = [self.experience.facts.get(node.fact) for node in nodes]
        return any(
            record and not record.successes and record.failures >= patience for record in records
        )
