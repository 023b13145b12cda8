"""One run of planning, the algorithms' steps: search, lift, bind, and remember what failed."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Set
from dataclasses import replace
from functools import partial
from typing import Any

from tamp.stream import Rejection
from tamp.symbolic.algorithms.binding.binder import Binder, substitute
from tamp.symbolic.algorithms.binding.plan_replay import Fault, Standing
from tamp.symbolic.algorithms.binding.skeleton import Skeleton
from tamp.symbolic.algorithms.binding.skeleton_construction import build_skeleton
from tamp.symbolic.algorithms.binding.skeleton_steps import to_steps
from tamp.symbolic.algorithms.bound_stream import Streams
from tamp.symbolic.algorithms.experience.elsewhere import choices
from tamp.symbolic.algorithms.experience.failure_counts import Tally, tallies
from tamp.symbolic.algorithms.explanation.explanation import (
    explain_attempts,
    explain_failures,
    explain_infeasible,
)
from tamp.symbolic.algorithms.explanation.unachievable_facts import Missing
from tamp.symbolic.algorithms.optimistic.optimistic_instantiation import MARK, Guess
from tamp.symbolic.algorithms.priced_search import PricedSearch
from tamp.symbolic.algorithms.result import Outcome, PlanAction, Progress, Result, StreamTask
from tamp.symbolic.pddl.structs import Fact, Formula
from tamp.symbolic.search.instantiation.instantiator import Instantiator
from tamp.symbolic.search.operators import InstantiatedTask
from tamp.symbolic.search.replay import REFUTED
from tamp.symbolic.search.search import Plan
from tamp.system.deadline import Deadline

FEW = 8
"""A stream that ended with no more values than this is replaced by them: a search can then prove
that none will do."""


class Run(PricedSearch):
    """One run of planning: what it knows, and the steps that algorithms are made of.

    `pruned` leaves out the streams whose facts nothing asks for.
    """

    def __init__(
        self,
        problem: StreamTask,
        make_rng: Callable[[str], Any],
        deadline: Deadline,
        progress: Progress,
        *,
        pruned: bool = True,
    ) -> None:
        self.make_rng = make_rng
        self.progress = progress
        super().__init__(problem, deadline, pruned)
        self.streams = Streams(
            {s.name: s for s in problem.streams}, self.objects, make_rng, deadline
        )
        self.standing = Standing(problem.task, self.streams)
        self.binder = Binder(self.streams, self.experience, deadline)
        self.skeletons: dict[object, Skeleton] = {}
        self.traced: dict[object, tuple[InstantiatedTask | None, object]] = {}
        self.latest: Skeleton | None = None

    def skeleton(self, plan: Plan) -> Skeleton:
        """Return the plan's skeleton; the same one if it was found before and rests on the same."""
        operators = tuple((operator.name, operator.arguments) for operator in plan.operators)
        traced, key = self.traced.get(operators, (None, None))
        known = (
            self.skeletons.get(key)
            if traced is self.instantiated and not self.experience.exact
            else None
        )

        if known is None:
            steps, trace = to_steps(self.searched, plan, self.prices)
            chosen: dict[tuple[int, Fact], Guess] = {}
            if self.optimism.several:
                for number, at in enumerate((*trace.steps, trace.end)):
                    some = choices(self.optimism, self.experience, at.static, at.state)
                    chosen |= {(number, fact): guess for fact, guess in some.items()}

            calls = tuple((place, guess.call) for place, guess in chosen.items())
            told = tuple((step.name, step.arguments, step.static, step.usages) for step in steps)
            key = (told, trace.end.static, calls)
            known = self.skeletons.get(key)
            if known is None or not self.is_open(known):
                maker, promise = self.optimism.maker, self.promise
                known = self.skeletons[key] = build_skeleton(
                    steps, trace.end, maker, promise, self.given, chosen
                )
                self.effort.skeletons = len(self.skeletons)
            self.traced[operators] = (None if trace.open else self.instantiated), key

        return known

    def is_open(self, skeleton: Skeleton) -> bool:
        """Check that all calls of a skeleton may give something new; else others may serve it."""
        calls = (((node.stream.name, node.guess[0]), bool(node.outputs)) for node in skeleton.nodes)
        return not any(
            call in self.dead or (gives and call in self.settled) for call, gives in calls
        )

    def promise(self, name: str) -> Fact | None:
        """Return a fact that the call which gives a value certifies of it; None of objects."""
        if name.startswith(MARK):
            return self.optimism.promise(name)
        return next((fact for fact in self.real if name in fact[1:]), None)

    def bury(self, skeleton: Skeleton) -> bool:
        """Note the calls with real inputs that ended without a value; say if any are new."""
        before = len(self.dead) + len(self.settled)

        for node in skeleton.nodes:
            if node.stream.is_fluent or any(isinstance(term, int) for term in node.inputs):
                continue
            inputs = tuple(str(term) for term in node.inputs)
            for instance in self.streams.instances(node.stream.name, inputs):
                if not instance.exhausted:
                    continue
                self.given_up |= instance.last is not None and instance.last.given_up
                if not instance.results:
                    self.dead.setdefault(
                        (node.stream.name, inputs), instance.last or Rejection("has no value")
                    )
                    self.refused.add(node.fact)
                elif not node.stream.is_advisory and len(instance.results) <= FEW:
                    self.settled.add((node.stream.name, inputs))
                    for outputs in instance.results:
                        self.real.update(dict.fromkeys(self.streams.certified(instance, outputs)))

        if self.settled:
            self._refuse_tests()
        return len(self.dead) + len(self.settled) > before

    def _refuse_tests(self) -> None:
        """Note all tests of settled values that are false, so that no search proposes them."""
        settled = {
            name for fact in self.real for name in fact[1:]
        } | self.problem.task.objects.keys()
        for instance in self.streams.false_tests():
            if settled.issuperset(instance.inputs):
                key = (instance.stream.name, instance.inputs)
                self.dead.setdefault(key, instance.last or Rejection("does not hold"))
                self.refused.update(self.streams.certified(instance, ()))

    def absorb(self) -> bool:
        """Take over the facts that streams found besides; say if there were new ones."""
        before = len(self.real)
        self.real.update(self.streams.wild)
        return len(self.real) > before

    def bind(
        self, skeleton: Skeleton, tries: int, budget: int, fresh: Set[int] = frozenset()
    ) -> dict[int, str] | None:
        """Find values with which the plan holds when it is replayed, see `Binder.bind`.

        If it does not hold with any, the skeleton forgets them, and what gave them is noted to have
        failed once more.
        """
        refused: list[Fault] = []

        def holds(values: dict[int, str]) -> bool:
            fault = self.standing.fault(skeleton, values)
            if fault is not None:
                refused.append(fault)
            return fault is None

        values = self.binder.bind(skeleton, tries, budget, fresh, holds=holds)
        mistake = next((fault for fault in refused if not fault.expected), None)
        if mistake is not None:
            self.effort.refuted += 1
            self.streams.warn(f"{REFUTED}: {mistake.reason}")
        if values is None and refused:
            skeleton.memory.clear()
            for node in skeleton.nodes:
                if node.outputs:
                    self.experience.note(node.fact, "what was found besides forbids the plan")
        return values

    def solved(self, skeleton: Skeleton, values: dict[int, str]) -> Result:
        """Return the bound plan."""
        lifted = {action.name: action for action in self.task.domain.actions}
        bound = [(name, substitute((name, terms), values)[1:]) for name, terms in skeleton.actions]
        actions = tuple(
            PlanAction(name, words, self.costs.of(lifted[name], words)) for name, words in bound
        )
        initial = self.problem.task.initial
        certified = dict.fromkeys(substitute(fact, values) for fact in skeleton.certified)
        result = self.result(Outcome.SOLVED, ())
        result.actions = actions
        result.certified = tuple(sorted(fact for fact in certified if fact not in initial))
        result.attempts = partial(
            explain_attempts, self.problem, list(self.skeletons.values()), self.experience, skeleton
        )
        return result

    def hopeless(self) -> Result:
        """End the run where no plan is left: infeasible, unless a stream was given up too early."""
        outcome = Outcome.EXHAUSTED if self.given_up else Outcome.INFEASIBLE

        facts = {
            *self.known,
            *self.real,
            *self.optimism.makers,
            *self.instantiated.reachable,
            *self.instantiated.initial,
        }
        types = {**self.objects.types, **self.optimism.types}
        missing = Missing(
            self.task, self.problem.streams, facts - self.refused, types, self.assumed
        )

        started = time.perf_counter()
        reasons = explain_infeasible(
            self.problem, self.instantiated, self.dead, missing, self.deadline, self._towards
        )
        if self.experience.exact:  # what failed in the states that plans lead through is the cause
            reasons = (
                *explain_failures(self.problem, self.streams, self.tallies(), True),
                *reasons,
            )
        self.effort.explaining_seconds += time.perf_counter() - started
        return self.result(outcome, reasons)

    def _towards(self, goal: Formula) -> InstantiatedTask:
        """Instantiate the optimistic task with another goal."""
        facts = [*self.real, *self.sampled(), *self.optimism.makers]
        types = {**self.objects.types, **self.optimism.types}
        instantiator = Instantiator(replace(self.task, goal=goal), frozenset(self.assumed))
        return instantiator.instantiate(facts, types, frozenset(self.refused))

    def sampled(self) -> Iterable[Fact]:
        """Return the real facts that are known besides those that were settled."""
        return ()

    def tallies(self) -> tuple[Tally, ...]:
        """Count what was tried, by action and stream."""
        return tallies(list(self.skeletons.values()), self.experience, self.problem.values)

    def stopped(self, outcome: Outcome) -> Result:
        """End the run when the time is up or the user wants an end: no alarm disturbs that."""
        self.deadline.ended = True
        return self.result(outcome)

    def result(self, outcome: Outcome, explanation: tuple[str, ...] | None = None) -> Result:
        """Return the result of the run; by default the explanation is what failed most."""
        started = time.perf_counter()
        rows = () if outcome is Outcome.SOLVED else self.tallies()

        if explanation is None:
            explanation = explain_failures(
                self.problem, self.streams, rows, self.latest is not None
            )
        self.effort.explaining_seconds += time.perf_counter() - started

        self.effort.draws = self.binder.units
        return Result(
            outcome=outcome,
            objects=self.objects,
            statistics=self.streams.statistics,
            effort=self.effort,
            explanation=explanation,
            tallies=rows,
            warnings=tuple(self.streams.warnings),
            memory=self.streams.memory,
            attempts=partial(
                explain_attempts, self.problem, list(self.skeletons.values()), self.experience, None
            ),
        )
