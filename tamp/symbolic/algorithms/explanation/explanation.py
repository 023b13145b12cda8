"""Explanations of why there is no plan, in words that name objects."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence

from tamp.stream import Rejection
from tamp.symbolic.algorithms.binding.skeleton import Node, Skeleton
from tamp.symbolic.algorithms.bound_stream import Streams
from tamp.symbolic.algorithms.experience.failure_counts import FailureCount, blocking_objects
from tamp.symbolic.algorithms.experience.stream_statistics import Experience, FailureRecord
from tamp.symbolic.algorithms.explanation.goal_conflicts import (
    InstantiateGoal,
    minimal_unsolvable_goals,
)
from tamp.symbolic.algorithms.explanation.kept import kept_from
from tamp.symbolic.algorithms.explanation.unachievable_facts import UnachievableFacts
from tamp.symbolic.algorithms.optimistic.optimistic_facts import MARK
from tamp.symbolic.algorithms.result import SkeletonAttempt, StreamTask
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.operators import InstantiatedTask
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
) -> tuple[str, ...]:
    """Name the unreachable goal facts and what they lack; or the goals that exclude each other.

    Args:
        problem: The task and its streams.
        instantiated: The optimistic task, unsolvable.
        dead: The calls that ended without a value.
        unachievable: Says what a fact lacks.
        deadline: When to look no further.
        instantiate: Instantiates the task with another goal.
    """
    lines: list[str] = []
    blamed: set[tuple[str, tuple[str, ...]]] = set()
    for fact in unreachable(instantiated):
        words = fact[2:] if fact[0] == "not" else fact[1:]
        meaning = instantiated.meanings.get(fact[0])
        text = meaning or f"({' '.join(fact)})"
        words = tuple(re.findall(r"[^\s()]+", meaning)) if meaning else words
        causes: list[str] = []
        for key, rejection in dead.items():
            if set(_names(problem, key[1])) & set(words):
                blamed.add(key)
                causes.append(f"{_call(problem, *key)}: {rejection.reason}")
        causes = causes or [unachievable.reason(fact) + _kinds(problem, words)]
        lines += [f"{text} cannot be reached: {cause}" for cause in causes]

    lines += [
        f"{_call(problem, *key)}: {reason.reason}"
        for key, reason in dead.items()
        if key not in blamed
    ]
    if blamed or unreachable(instantiated):
        return tuple(dict.fromkeys(lines))

    soon = Deadline(min(CONFLICT_SECONDS, deadline.left()))
    goals = minimal_unsolvable_goals(instantiated, soon, problem.task.goal, instantiate)
    if len(goals) > 1:  # each can be reached, as far as one knows without looking at the others
        return tuple(dict.fromkeys((_exclusive(goals), *lines)))

    what = goals[0] if goals else "the goal"
    calls = {
        _call(problem, *key): (frozenset(_names(problem, key[1])), why.reason)
        for key, why in dead.items()
    }

    forbidding = kept_from(problem, instantiated, calls, what)
    kept = tuple(dict.fromkeys(f"{what} cannot be reached: {cause}" for cause in forbidding))
    if kept:
        return tuple(dict.fromkeys((*kept, *lines)))
    return tuple(dict.fromkeys((*lines, f"every way to {what} was searched, and none leads there")))


def _exclusive(goals: Sequence[str]) -> str:
    both = "both hold" if len(goals) == 2 else "hold together"
    said = f"{' and '.join(goals)} cannot {both} at the end"
    return f"{said}: each way to one of them excludes the others"


def explain_failures(
    problem: StreamTask, streams: Streams, rows: Sequence[FailureCount], tried: bool
) -> tuple[str, ...]:
    """Name the call that did not end, what never worked or failed most, and what was in the way.

    Args:
        problem: The task and its streams.
        streams: With what they were asked.
        rows: What was tried for the actions of plans.
        tried: Whether there was a plan to be tried.
    """
    running = streams.running
    endless = (
        [f"{_call(problem, running.stream.name, running.inputs)} did not end"] if running else []
    )
    # one that failed once or twice is no cause
    least = LEAST_SHARE_OF_FAILURES * max((row.failures for row in rows), default=0)
    never = [row for row in rows if row.always_failed and row.failures >= least]
    mostly = sorted(
        (row for row in rows if row.failures > row.successes), key=lambda row: -row.failures
    )
    lines = [row.text() for row in never or mostly]
    blocking = [
        f"{name} ({count} times)" for name, count in blocking_objects(rows, problem.values)[:3]
    ]
    lines = lines[:MAX_CAUSES] + ([f"most in the way: {', '.join(blocking)}"] if blocking else [])
    lines = lines if tried else _never_worked(problem, streams)
    none = "no single step failed more than it worked" if tried else "no action plan was found yet"
    return (*endless, *lines) or (none,)


def _never_worked(problem: StreamTask, streams: Streams) -> list[str]:
    """List the kinds of calls, by the problem's objects in them, that failed whatever was tried."""
    failed: dict[str, Counter[str]] = {}
    worked: set[str] = set()
    for instance in streams.called():
        kind = _call(problem, instance.stream.name, instance.inputs)
        if instance.results:
            worked.add(kind)
        elif instance.last is not None:
            failed.setdefault(kind, Counter())[instance.last.reason] += 1
    never = [(kind, reasons) for kind, reasons in failed.items() if kind not in worked]
    never.sort(key=lambda row: -row[1].total())
    texts = (
        ", ".join(f"{count} {reason}" for reason, count in reasons.most_common(3))
        for _, reasons in never
    )
    return [
        f"{kind} never worked: {text}"
        for (kind, _), text in zip(never[:MAX_CAUSES], texts, strict=False)
    ]


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


def _row(skeleton: Skeleton, node: Node, present: frozenset[Fact], record: FailureRecord) -> str:
    objects = ", ".join(name for name in node.guess[0] if not name.startswith(MARK))
    reasons = ", ".join(f"{count} {reason}" for reason, count in record.reasons.most_common(3))
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
