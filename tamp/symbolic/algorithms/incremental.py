"""The incremental algorithm, a reference: sample level by level, then search over what is known.

After PDDLStream's incremental algorithm (Garrett, Lozano-Perez, Kaelbling, ICAPS 2020). Streams
that certify something about the state that they are shown cannot be called before there is a plan;
they stay optimistic, and are bound last.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from tamp.symbolic.algorithms.knowledge import Knowledge, record_exhausted_calls
from tamp.symbolic.algorithms.optimistic.anything import distinguishes
from tamp.symbolic.algorithms.optimistic.optimistic_facts import OptimisticInstance
from tamp.symbolic.algorithms.optimistic.optimistic_instantiation import instantiate_streams
from tamp.symbolic.algorithms.optimistic.optimistic_task import OptimisticTask, sampled_task
from tamp.symbolic.algorithms.outcomes import (
    end_result,
    infeasible_result,
    interrupted_result,
    solved_result,
)
from tamp.symbolic.algorithms.planning_run import (
    Run,
    bind_skeleton,
    renew,
    search_plan,
    skeleton_of,
    start_run,
)
from tamp.symbolic.algorithms.planning_task import prepare
from tamp.symbolic.algorithms.priced_search import exclude_each_other
from tamp.symbolic.algorithms.result import Outcome, Progress, Result, StreamTask
from tamp.symbolic.search.instantiation.instantiator import Instantiator
from tamp.system.deadline import Deadline, OutOfTime
from tamp.system.garbage import infrequent_collection

DRAWS_PER_LEVEL = 2
"""Values drawn from each generator instance a level."""

PLANS_PER_LEVEL = 4
"""Plans whose fluent streams are tried before the next level."""

MAX_DRY_ROUNDS = 50
"""Rounds without anything left to draw after which prices have moved all that they can."""

TWIN_SUFFIX = " again"
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
    return plan_incrementally(start_incremental(problem, make_rng, deadline, progress))


def start_incremental(
    problem: StreamTask,
    make_rng: Callable[[str], Any],
    deadline: Deadline,
    progress: Progress,
    *,
    pruned: bool = True,
) -> Run:
    """Begin a run whose task has real facts, and placeholders of fluent streams only.

    Args:
        problem: The task and its streams.
        make_rng: A random generator from a string (see Streams).
        deadline: When to give up.
        progress: Told between levels.
        pruned: Leave out the streams whose facts nothing asks for.
    """
    task = prepare(problem, pruned=pruned)
    run = start_run(task, Knowledge(), sampled_task, make_rng, deadline, progress)
    run.streams.ahead = True
    return run


@infrequent_collection()
def plan_incrementally(run: Run, most: int | None = None) -> Result:
    """Sample a level, search and bind what is left, until a plan is found or nothing is new.

    Args:
        run: A run as `start_incremental` begins it; it may be gone on with.
        most: Draws after which no further level is begun.

    Raises:
        OutOfTime: The deadline passed, and `most` was given.
    """
    try:
        if most is None and _excluded_from_the_start(run):
            return infeasible_result(run)
        while True:
            fresh = _sample_level(run)
            result = _search_and_bind(run, PLANS_PER_LEVEL if fresh else None)
            if result is not None:
                return result
            if not fresh:
                return infeasible_result(run)
            if most is not None and run.binder.draws >= most:
                return end_result(run, Outcome.EXHAUSTED)
            run.progress(run.effort)
    except (OutOfTime, KeyboardInterrupt) as error:
        if most is not None and isinstance(error, OutOfTime):
            raise  # who asked for so many draws has more to say
        return interrupted_result(run, error)


def _sample_level(run: Run) -> bool:
    """Call every stream instance that known facts allow; say if any may give more."""
    task, knowledge = run.task, run.knowledge
    static = [stream for stream in task.streams if not stream.is_fluent]
    facts = [*task.initial_facts, *knowledge.sampled_facts]
    fresh = False
    for call in instantiate_streams(static, facts, max_depth=1).instances:
        if not all(fact in knowledge.sampled_facts for fact in call.certified):
            fresh |= _draw_ahead(run, call)
    return fresh


def _draw_ahead(run: Run, call: OptimisticInstance) -> bool:
    """Draw from a call with real inputs and keep what it certifies; say if it was not exhausted."""
    knowledge = run.knowledge
    shown = [fact for fact in run.task.initial_facts if fact[0] in call.stream.declaration.fluents]
    instance = run.streams.instance(call.stream.name, call.inputs, frozenset(shown))
    fresh = False

    for _ in range(1 if call.stream.is_test else DRAWS_PER_LEVEL):
        if run.deadline.passed:
            raise OutOfTime
        if instance.exhausted:
            break
        fresh = True
        run.binder.draws += 1
        outputs = run.streams.draw(instance)
        if outputs is not None:
            for fact in run.streams.certified(instance, outputs):
                knowledge.sampled_facts.setdefault(fact, instance)
        for fact in run.streams.wild:
            knowledge.sampled_facts.setdefault(fact, None)

    if instance.exhausted and instance.last is not None:
        knowledge.incomplete |= instance.last.given_up
        if not instance.results:
            knowledge.exhausted_calls[call.call] = instance.last
    return fresh


def _search_and_bind(run: Run, rounds: int | None) -> Result | None:
    """Search, bind and learn until a plan is bound, nothing is new or rounds end."""
    dry = 0
    while rounds is None or rounds > 0:
        renew(run)
        found = search_plan(run)
        if run.deadline.passed:
            raise OutOfTime
        if found is None:
            return None

        skeleton = run.latest = skeleton_of(run, found)
        before = run.binder.draws
        values = bind_skeleton(run, skeleton, TRIES, BUDGET)
        if values is not None:
            return solved_result(run, skeleton, values)

        objects = run.task.problem.task.objects
        if not record_exhausted_calls(run.knowledge, skeleton, run.streams, objects):
            dry = dry + 1 if run.binder.draws == before else 0
            if dry >= MAX_DRY_ROUNDS:
                # there are plans, whose streams fail in the states that these lead through
                run.knowledge.incomplete = True
                return None
            rounds = None if rounds is None else rounds - 1
    return None


def _excluded_from_the_start(run: Run) -> bool:
    """Check that goals exclude each other whatever streams give: sampling never says so.

    A placeholder stands for all values of a call, which hides plans that take two of them: with a
    second one for each call the goals have to exclude each other as well, and no condition may want
    such values to differ. The run then has the task that proves it.
    """
    task = run.task
    if distinguishes(task.task, [types for one in task.streams for types in one.output_types]):
        return False

    twins = [
        replace(stream, declaration=replace(stream.declaration, name=f"{stream.name}{TWIN_SUFFIX}"))
        for stream in task.streams
        if not stream.is_test
    ]
    made: list[OptimisticTask] = []
    for streams in (task.streams, [*task.streams, *twins]):
        facts = instantiate_streams(streams, task.initial_facts)
        if not facts.complete:
            return False
        facts.lazily_tested = task.lazily_tested
        types = {**task.objects.types, **facts.types}
        instantiator = Instantiator(task.task, task.assumed)
        instantiated = instantiator.instantiate(list(facts.producers), types)
        if not exclude_each_other(instantiated, run.deadline):
            return False
        made.append(OptimisticTask(facts, instantiated))

    run.optimistic = made[0]
    return True
