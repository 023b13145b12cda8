"""Results of a run: the bound plan, or why there is none."""

from __future__ import annotations

from functools import partial

from tamp.symbolic.algorithms.binding.binder import substitute
from tamp.symbolic.algorithms.binding.skeleton import Skeleton
from tamp.symbolic.algorithms.cause import Cause
from tamp.symbolic.algorithms.experience.failure_counts import FailureCount, failure_counts
from tamp.symbolic.algorithms.explanation.explanation import (
    explain_attempts,
    explain_failures,
    explain_infeasible,
)
from tamp.symbolic.algorithms.explanation.unachievable_facts import UnachievableFacts
from tamp.symbolic.algorithms.optimistic.equal_outputs import equal_outputs_may_meet
from tamp.symbolic.algorithms.planning_run import Run
from tamp.symbolic.algorithms.result import Outcome, PlanAction, Result
from tamp.symbolic.pddl.structs import Formula
from tamp.symbolic.search.operators import InstantiatedTask
from tamp.system.deadline import OutOfTime


def solved_result(run: Run, skeleton: Skeleton, values: dict[int, str]) -> Result:
    """Return the bound plan."""
    lifted = {action.name: action for action in run.task.task.domain.actions}
    bound = [(name, substitute((name, terms), values)[1:]) for name, terms in skeleton.actions]
    actions = tuple(
        PlanAction(name, words, run.task.costs.of(lifted[name], words)) for name, words in bound
    )
    initial = run.task.problem.task.initial
    certified = dict.fromkeys(substitute(fact, values) for fact in skeleton.certified)

    result = end_result(run, Outcome.SOLVED, (), solution=skeleton)
    result.actions = actions
    result.certified = tuple(sorted(fact for fact in certified if fact not in initial))
    return result


def infeasible_result(run: Run) -> Result:
    """End the run where no plan is left: infeasible, unless something was given up too early, or
    equal values of different calls may make what placeholders do not show.
    """
    knowledge, task, problem = run.knowledge, run.task, run.task.problem
    optimistic, instantiated = run.optimistic.facts, run.optimistic.instantiated
    hidden = problem.by_value and equal_outputs_may_meet(problem.task, problem.streams)
    outcome = Outcome.EXHAUSTED if knowledge.incomplete or hidden else Outcome.INFEASIBLE

    achievable = {
        *task.initial_facts,
        *knowledge.certified_facts,
        *optimistic.producers,
        *instantiated.reachable,
        *instantiated.initial,
    }
    unachievable = UnachievableFacts(
        task.task,
        task.problem.streams,
        achievable - knowledge.false_facts,
        {**task.objects.types, **optimistic.types},
        task.lazily_tested,
    )

    with run.effort.explaining():
        causes = explain_infeasible(
            task.problem,
            instantiated,
            knowledge.exhausted_calls,
            unachievable,
            run.deadline,
            partial(_with_goal, run),
        )
        # what failed in the states that plans lead through is the cause
        if knowledge.experience.failing_states:
            failures = explain_failures(task.problem, run.streams, _failure_counts(run), True)
            causes = (*failures, *causes)
    return end_result(run, outcome, causes)


def _with_goal(run: Run, goal: Formula) -> InstantiatedTask:
    """Instantiate the optimistic task with another goal."""
    knowledge = run.knowledge
    certified = [*knowledge.certified_facts, *knowledge.sampled_facts]
    false_facts = frozenset(knowledge.false_facts)
    return run.task.instantiate(certified, run.optimistic.facts, false_facts, goal)


def _failure_counts(run: Run) -> tuple[FailureCount, ...]:
    """Count what was tried, by action and stream."""
    skeletons = list(run.skeletons.values())
    return failure_counts(skeletons, run.knowledge.experience, run.task.problem.values)


def interrupted_result(run: Run, error: OutOfTime | KeyboardInterrupt) -> Result:
    """End the run when the time is up or the user wants an end: no alarm disturbs that."""
    run.deadline.ended = True
    timed_out = isinstance(error, OutOfTime)
    return end_result(run, Outcome.TIMEOUT if timed_out else Outcome.INTERRUPTED)


def end_result(
    run: Run,
    outcome: Outcome,
    causes: tuple[Cause, ...] | None = None,
    *,
    solution: Skeleton | None = None,
) -> Result:
    """Return the result of a run.

    Args:
        run: The run.
        outcome: How it ends.
        causes: Why there is no plan; by default what failed most.
        solution: The skeleton that became the plan.
    """
    with run.effort.explaining():
        counts = () if outcome is Outcome.SOLVED else _failure_counts(run)
        if causes is None:
            tried = run.latest is not None
            causes = explain_failures(run.task.problem, run.streams, counts, tried)

    run.effort.draws = run.binder.draws
    skeletons = list(run.skeletons.values())
    return Result(
        outcome=outcome,
        objects=run.task.objects,
        statistics=run.streams.statistics,
        effort=run.effort,
        causes=causes,
        tallies=counts,
        warnings=tuple(run.streams.warnings),
        memory=run.streams.memory,
        attempts=partial(
            explain_attempts, run.task.problem, skeletons, run.knowledge.experience, solution
        ),
        skeleton=solution,
    )
