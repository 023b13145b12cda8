"""One run of planning: its knowledge, its optimistic task, and the steps search and bind."""

from __future__ import annotations

import math
from collections.abc import Callable, Set
from dataclasses import dataclass, field
from typing import Any

from tamp.stream import Rejection
from tamp.symbolic.algorithms.binding.binder import Binder
from tamp.symbolic.algorithms.binding.plan_replay import Fault, PlanReplay
from tamp.symbolic.algorithms.binding.skeleton import Skeleton
from tamp.symbolic.algorithms.binding.skeleton_construction import build_skeleton
from tamp.symbolic.algorithms.binding.skeleton_steps import to_steps
from tamp.symbolic.algorithms.bound_stream import Streams
from tamp.symbolic.algorithms.experience.failing_states import choose_instances
from tamp.symbolic.algorithms.knowledge import Knowledge, certified_fact_of, may_give_more
from tamp.symbolic.algorithms.optimistic.optimistic_facts import (
    PLACEHOLDER_MARK,
    OptimisticInstance,
)
from tamp.symbolic.algorithms.optimistic.optimistic_task import OptimisticTask
from tamp.symbolic.algorithms.planning_task import PlanningTask
from tamp.symbolic.algorithms.priced_search import (
    FIRST_PLAN_WEIGHT,
    PricedPlan,
    exclude_each_other,
    priced_search,
)
from tamp.symbolic.algorithms.result import Progress, SearchStatistics
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.operators import InstantiatedTask
from tamp.symbolic.search.replay import REFUTED_TEXT
from tamp.system.deadline import Deadline

REPLAY_REFUSAL = Rejection("what was found besides forbids the plan")
"""Why values failed that only the replay refused."""


@dataclass(eq=False, slots=True)
class Run:
    """One run of planning: values that the steps of an algorithm read and replace.

    Attributes:
        task: What is planned; it does not change.
        knowledge: What was found out.
        optimistic: The task over placeholders that follows from it.
        instantiate: Makes that task: `optimistic_task`, or `sampled_task`.
        streams: The stream instances and what they gave.
        binder: Gives values to skeletons.
        replay: Judges bound plans.
        make_rng: A random generator from a string (see Streams).
        deadline: When to give up.
        progress: Told between rounds.
        effort: How much was done.
        skeletons: Those that were bound or tried, by what tells them apart.
        traced: The skeleton's key by the plan's operators, with the task for which that holds.
        latest: The skeleton that was tried last.
        brief: Whether searches end without a plan where they become long.
        doubtful: Whether a search has ended without a plan: each asks first whether goals exclude
            each other.
        audited: The task that was last asked whether its goals exclude each other.
    """

    task: PlanningTask
    knowledge: Knowledge
    optimistic: OptimisticTask
    instantiate: Callable[[PlanningTask, Knowledge], OptimisticTask]
    streams: Streams
    binder: Binder
    replay: PlanReplay
    make_rng: Callable[[str], Any]
    deadline: Deadline
    progress: Progress
    effort: SearchStatistics
    skeletons: dict[object, Skeleton] = field(default_factory=dict[object, Skeleton])
    traced: dict[object, tuple[InstantiatedTask | None, object]] = field(
        default_factory=dict[object, tuple[InstantiatedTask | None, object]]
    )
    latest: Skeleton | None = None
    brief: bool = False
    doubtful: bool = False
    audited: InstantiatedTask | None = None


def start_run(
    task: PlanningTask,
    knowledge: Knowledge,
    instantiate: Callable[[PlanningTask, Knowledge], OptimisticTask],
    make_rng: Callable[[str], Any],
    deadline: Deadline,
    progress: Progress,
) -> Run:
    """Begin a run: nothing is drawn yet, the optimistic task is there."""
    effort = SearchStatistics()
    with effort.searching():
        optimistic = instantiate(task, knowledge)

    declared = {stream.name: stream for stream in task.problem.streams}
    streams = Streams(declared, task.objects, make_rng, deadline)
    binder = Binder(streams, knowledge.experience, deadline)
    return Run(
        task=task,
        knowledge=knowledge,
        optimistic=optimistic,
        instantiate=instantiate,
        streams=streams,
        binder=binder,
        replay=PlanReplay(task.problem.task, streams),
        make_rng=make_rng,
        deadline=deadline,
        progress=progress,
        effort=effort,
    )


def renew(run: Run) -> None:
    """Instantiate the optimistic task anew, from what is known by now."""
    with run.effort.searching():
        run.optimistic = run.instantiate(run.task, run.knowledge)


def search_plan(
    run: Run, *, weight: float = FIRST_PLAN_WEIGHT, below: float = math.inf
) -> PricedPlan | None:
    """Search for a plan of the optimistic task, priced by experience.

    Args:
        run: The run.
        weight: Of the estimate: with less the plans are cheaper and the search is longer.
        below: What the actions of the plan must cost less than; when it is given, there is one try
            only.
    """
    run.effort.searches += 1
    with run.effort.searching():
        if run.doubtful and _goals_exclude_each_other(run):
            return None
        return priced_search(
            run.optimistic,
            run.knowledge.experience,
            run.task.problem.posteriors,
            run.deadline,
            lambda: _goals_exclude_each_other(run),
            run.effort,
            weight=weight,
            below=below,
            brief=run.brief,
            seed=int(run.make_rng("restarts of the search").random() * 2**53),
        )


def _goals_exclude_each_other(run: Run) -> bool:
    """Check that goals are proven to exclude each other; each optimistic task is asked once."""
    if run.audited is run.optimistic.instantiated:
        return False
    run.audited = run.optimistic.instantiated
    return exclude_each_other(run.optimistic.instantiated, run.deadline)


def skeleton_of(run: Run, found: PricedPlan) -> Skeleton:
    """Return the plan's skeleton; the same one if it was found before and rests on the same."""
    operators = tuple((operator.name, operator.arguments) for operator in found.plan.operators)
    traced_in, key = run.traced.get(operators, (None, None))
    if traced_in is run.optimistic.instantiated and not run.knowledge.experience.failing_states:
        earlier = run.skeletons.get(key)
        if earlier is not None:
            return earlier

    steps, trace = to_steps(found.task, found.plan, found.prices)
    chosen: dict[tuple[int, Fact], OptimisticInstance] = {}
    if run.optimistic.facts.alternatives:
        for number, at in enumerate((*trace.steps, trace.end)):
            some = choose_instances(
                run.optimistic.facts, run.knowledge.experience, at.static, at.state
            )
            chosen |= {(number, fact): instance for fact, instance in some.items()}

    calls = tuple((place, instance.call) for place, instance in chosen.items())
    told = tuple((step.name, step.arguments, step.static, step.usages) for step in steps)
    key = (told, trace.end.static, calls)
    run.traced[operators] = (None if trace.open else run.optimistic.instantiated), key

    skeleton = run.skeletons.get(key)
    if skeleton is None or not may_give_more(run.knowledge, skeleton):
        skeleton = run.skeletons[key] = build_skeleton(
            steps,
            trace.end,
            run.optimistic.facts.producer,
            lambda name: _certified_fact_of(run, name),
            run.task.shown_facts,
            chosen,
        )
        run.effort.skeletons = len(run.skeletons)
    return skeleton


def _certified_fact_of(run: Run, name: str) -> Fact | None:
    """Return a fact that the call which gives a value certifies of it; None of objects."""
    if name.startswith(PLACEHOLDER_MARK):
        return run.optimistic.facts.certified_fact_of(name)
    return certified_fact_of(run.knowledge, name)


def bind_skeleton(
    run: Run,
    skeleton: Skeleton,
    tries: int,
    budget: int,
    fresh: Set[int] = frozenset(),
    more: Callable[[], int | None] | None = None,
) -> dict[int, str] | None:
    """Find values with which the plan holds when it is replayed, see `Binder.bind`.

    If it does not hold with any, the skeleton forgets them, and what gave them is noted to have
    failed once more.
    """
    faults: list[Fault] = []

    def holds(values: dict[int, str]) -> bool:
        fault = run.replay.fault(skeleton, values)
        if fault is not None:
            faults.append(fault)
        return fault is None

    values = run.binder.bind(skeleton, tries, budget, fresh, holds=holds, more=more)
    mistake = next((fault for fault in faults if not fault.expected), None)
    if mistake is not None:
        run.effort.refuted += 1
        run.streams.warn(f"{REFUTED_TEXT}: {mistake.reason}")

    if values is None and faults:
        skeleton.memory.clear()
        for node in skeleton.nodes:
            if node.outputs:
                run.knowledge.experience.record(node.fact, REPLAY_REFUSAL)
    return values
