"""Explanations of why there is no plan, in words that name objects."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from tamp.stream import Rejection
from tamp.symbolic.algorithms.binding.skeleton import CallNode, Skeleton
from tamp.symbolic.algorithms.bound_stream import Streams
from tamp.symbolic.algorithms.cause import Cause, CauseKind, distinct_causes
from tamp.symbolic.algorithms.experience.failure_counts import FailureCount, blocking_objects
from tamp.symbolic.algorithms.experience.stream_statistics import Experience, FailureRecord
from tamp.symbolic.algorithms.explanation.goal_conflicts import (
    InstantiateGoal,
    minimal_unsolvable_goals,
)
from tamp.symbolic.algorithms.explanation.kept import kept_from
from tamp.symbolic.algorithms.explanation.unachievable_facts import UnachievableFacts
from tamp.symbolic.algorithms.optimistic.optimistic_facts import PLACEHOLDER_MARK
from tamp.symbolic.algorithms.result import SkeletonAttempt, StreamTask
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.operators import InstantiatedTask, Meaning
from tamp.symbolic.search.search import unreachable
from tamp.system.deadline import Deadline

CONFLICT_SECONDS = 3.0
"""Seconds in which goals that exclude each other are looked for once it is proven that there is no
plan."""

LEAST_SHARE_OF_FAILURES = 0.05
"""What never worked is the cause where it failed at least so often, as a share of the failures of
what failed most."""

MAX_CAUSES = 6
"""How many causes are worth reading."""

MAX_REASONS = 3
"""Reasons, and objects in them, that are told of one cause: the most frequent ones."""


def explain_attempts(
    problem: StreamTask,
    skeletons: Sequence[Skeleton],
    experience: Experience,
    bound: Skeleton | None,
) -> tuple[SkeletonAttempt, ...]:
    """List what was tried, in the order in which it was found, and what failed in it."""
    return tuple(
        SkeletonAttempt(
            actions=tuple(
                " ".join([step.name, *_names(problem, step.arguments)]) for step in skeleton.steps
            ),
            rounds=skeleton.rounds,
            bound=skeleton is bound,
            failures=tuple(_failed(experience, skeleton)),
        )
        for skeleton in skeletons
    )


def explain_infeasible(
    problem: StreamTask,
    instantiated: InstantiatedTask,
    dead: Mapping[tuple[str, tuple[str, ...]], Rejection],
    unachievable: UnachievableFacts,
    deadline: Deadline,
    instantiate: InstantiateGoal,
) -> tuple[Cause, ...]:
    """Name the unreachable goal facts and what they lack; or the goals that exclude each other.

    Args:
        problem: The task and its streams.
        instantiated: The optimistic task, unsolvable.
        dead: The calls that ended without a value.
        unachievable: Says what a fact lacks.
        deadline: When to look no further.
        instantiate: Instantiates the task with another goal.
    """
    causes: list[Cause] = []
    blamed: set[tuple[str, tuple[str, ...]]] = set()
    for fact in unreachable(instantiated):
        words = fact[2:] if fact[0] == "not" else fact[1:]
        meaning = instantiated.meanings.get(fact[0])
        text = meaning.text if meaning else f"({' '.join(fact)})"
        terms = meaning.terms if meaning else words
        about = problem.named(terms)
        guilty = [key for key in dead if not set(_names(problem, key[1])).isdisjoint(terms)]
        blamed.update(guilty)
        reasons = [_no_value(problem, key, dead[key]) for key in guilty]
        if not reasons:
            missing, lacks = unachievable.reason(fact)
            said = missing + _kinds(problem, terms)
            reasons = [Cause(said, CauseKind.UNREACHABLE, problem.named(lacks))]
        causes += [
            Cause(f"{text} cannot be reached: {why.text}", why.kind, (*about, *why.objects))
            for why in reasons
        ]

    causes += [_no_value(problem, key, dead[key]) for key in dead if key not in blamed]
    if blamed or unreachable(instantiated):
        return distinct_causes(causes)

    soon = Deadline(min(CONFLICT_SECONDS, deadline.left()))
    goals = minimal_unsolvable_goals(instantiated, soon, problem.task.goal, instantiate)
    if len(goals) > 1:  # each can be reached, as far as one knows without looking at the others
        return distinct_causes((_exclusive(problem, goals), *causes))

    what = goals[0] if goals else Meaning("the goal")
    calls = [
        (frozenset(_names(problem, key[1])), _no_value(problem, key, why))
        for key, why in dead.items()
    ]

    about = problem.named(what.terms)
    kept = [
        Cause(f"{what.text} cannot be reached: {cause.text}", cause.kind, (*about, *cause.objects))
        for cause in kept_from(problem, instantiated, calls, what.terms)
    ]
    if kept:
        return distinct_causes((*kept, *causes))
    searched = f"every way to {what.text} was searched, and none leads there"
    none = Cause(searched, CauseKind.SEARCHED, about)
    return distinct_causes((*causes, none))


def _no_value(
    problem: StreamTask, call: tuple[str, tuple[str, ...]], rejection: Rejection
) -> Cause:
    """Return the cause that a call ended without a value."""
    objects = problem.named((*call[1], *rejection.bodies))
    return Cause(f"{_call(problem, *call)}: {rejection.reason}", CauseKind.NO_VALUE, objects)


def _exclusive(problem: StreamTask, goals: Sequence[Meaning]) -> Cause:
    both = "both hold" if len(goals) == 2 else "hold together"
    said = f"{' and '.join(goal.text for goal in goals)} cannot {both} at the end"
    text = f"{said}: each way to one of them excludes the others"
    objects = problem.named(term for goal in goals for term in goal.terms)
    return Cause(text, CauseKind.EXCLUSIVE, objects)


def explain_failures(
    problem: StreamTask, streams: Streams, rows: Sequence[FailureCount], tried: bool
) -> tuple[Cause, ...]:
    """Name the call that did not end, what never worked or failed most, and what was in the way.

    Args:
        problem: The task and its streams.
        streams: With what they were asked.
        rows: What was tried for the actions of plans.
        tried: Whether there was a plan to be tried.
    """
    causes = _endless(problem, streams)
    if not tried:
        never_worked = _never_worked(problem, streams)
        none = Cause("no action plan was found yet", CauseKind.SEARCHED)
        return (*causes, *never_worked) or (none,)

    # one that failed once or twice is no cause
    least = LEAST_SHARE_OF_FAILURES * max((row.failures for row in rows), default=0)
    never = [row for row in rows if row.always_failed and row.failures >= least]
    mostly = sorted(
        (row for row in rows if row.failures > row.successes), key=lambda row: -row.failures
    )
    causes += [
        Cause(row.text(), CauseKind.FAILED, problem.named((*row.objects, *_most(row.bodies))))
        for row in (never or mostly)[:MAX_CAUSES]
    ]

    blocking = blocking_objects(rows, problem.values)[:MAX_REASONS]
    if blocking:
        said = ", ".join(f"{name} ({count} times)" for name, count in blocking)
        objects = problem.named(name for name, _ in blocking)
        causes.append(Cause(f"most in the way: {said}", CauseKind.IN_THE_WAY, objects))

    none = Cause("no single step failed more than it worked", CauseKind.SEARCHED)
    return tuple(causes) or (none,)


def _endless(problem: StreamTask, streams: Streams) -> list[Cause]:
    """Return the cause that a call did not end, where one was running at the end."""
    running = streams.running
    if running is None:
        return []
    text = f"{_call(problem, running.stream.name, running.inputs)} did not end"
    return [Cause(text, CauseKind.ENDLESS, problem.named(running.inputs))]


def _never_worked(problem: StreamTask, streams: Streams) -> list[Cause]:
    """List the kinds of calls, by the problem's objects in them, that failed whatever was tried."""
    failed: dict[str, Counter[str]] = {}
    met: dict[str, Counter[str]] = {}
    about: dict[str, tuple[str, ...]] = {}
    worked: set[str] = set()
    for instance in streams.called():
        kind = _call(problem, instance.stream.name, instance.inputs)
        if instance.results:
            worked.add(kind)
        elif instance.last is not None:
            failed.setdefault(kind, Counter())[instance.last.reason] += 1
            met.setdefault(kind, Counter()).update(instance.last.bodies)
            about.setdefault(kind, instance.inputs)

    never = [(kind, reasons) for kind, reasons in failed.items() if kind not in worked]
    never.sort(key=lambda row: -row[1].total())
    return [
        Cause(
            f"{kind} never worked: {_counted(reasons)}",
            CauseKind.FAILED,
            problem.named((*about[kind], *_most(met[kind]))),
        )
        for kind, reasons in never[:MAX_CAUSES]
    ]


def _counted(reasons: Counter[str]) -> str:
    return ", ".join(f"{count} {reason}" for reason, count in reasons.most_common(MAX_REASONS))


def _most(bodies: Counter[str]) -> tuple[str, ...]:
    return tuple(name for name, _ in bodies.most_common(MAX_REASONS))


def _failed(experience: Experience, skeleton: Skeleton) -> list[str]:
    rows: list[tuple[int, str]] = []
    seen: set[Fact] = set()
    for node in skeleton.nodes:
        records = [(frozenset[Fact](), experience.facts.get(node.fact))]
        records += [
            (present, record)
            for (fact, present), record in experience.nogoods.items()
            if fact == node.fact
        ]
        if node.fact in seen:
            continue
        seen.add(node.fact)
        for present, record in records:
            if record is not None and record.failures > record.successes:
                rows.append((record.failures, _row(skeleton, node, present, record)))
    rows.sort(key=lambda row: -row[0])
    return list(dict.fromkeys(text for _, text in rows[:MAX_CAUSES]))


def _row(
    skeleton: Skeleton, node: CallNode, present: frozenset[Fact], record: FailureRecord
) -> str:
    objects = ", ".join(name for name in node.guess[0] if not name.startswith(PLACEHOLDER_MARK))
    reasons = _counted(record.reasons)
    tries = record.failures + record.successes
    place = (
        " while " + " and ".join(f"({' '.join(fact)})" for fact in sorted(present))
        if present
        else ""
    )
    return (
        f"{node.stream.name}({objects}) failed {record.failures} of {tries} times{place}: {reasons}"
    )


def _kinds(problem: StreamTask, words: tuple[str, ...]) -> str:
    types = problem.task.objects
    kinds = [f"{word} is {' and '.join(types[word])}" for word in words if types.get(word)]
    return f" ({', '.join(kinds)})" if kinds else ""


def _names(problem: StreamTask, inputs: tuple[str, ...]) -> list[str]:
    return [name for name in inputs if isinstance(problem.values.get(name), str)]


def _call(problem: StreamTask, name: str, inputs: tuple[str, ...]) -> str:
    """Write the call with the objects that the user knows: those of the problem."""
    return f"{name}({', '.join([x for x in inputs if x in problem.task.objects] or inputs)})"
