"""What the tests of the algorithms share: toy problems from PDDL text, and a symbolic replay of their plans."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from typing import Any

from tamp.symbolic.algorithms.adaptive import solve_adaptive
from tamp.symbolic.algorithms.bound_stream import FOREIGN_CALLERS, BoundStream, Objects
from tamp.symbolic.algorithms.incremental import solve_incremental
from tamp.symbolic.algorithms.result import Outcome, Result, StreamTask
from tamp.symbolic.pddl.parser import (
    output_types,
    parse_domain,
    parse_facts,
    parse_goal,
    parse_streams,
)
from tamp.symbolic.pddl.relations import SAMPLE_PREFIX
from tamp.symbolic.pddl.structs import Task
from tamp.system.deadline import Deadline, OutOfTime
from tamp.system.interrupts import Interrupter
from tests.symbolic.search.interpreter import Interpreter

ALGORITHMS = {"adaptive": solve_adaptive, "incremental": solve_incremental}


def stream_task(
    domain: str,
    streams: str,
    functions: Mapping[str, Callable[..., Any]],
    objects: Mapping[str, tuple[str, ...]],
    init: str,
    goal: str,
    values: Mapping[str, object] | None = None,
) -> StreamTask:
    """A problem from texts; an object without a value stands for itself."""
    parsed = parse_domain(domain)
    declared = parse_streams(streams, parsed)
    bound = []
    for stream in declared.streams:
        types = output_types(stream, parsed)
        bound.append(
            BoundStream(
                stream,
                functions[stream.name],
                tuple(types[name] for name in stream.outputs),
                advises=stream.name.startswith(SAMPLE_PREFIX),
            )
        )
    task = Task(
        "toy",
        parsed,
        dict(objects),
        parse_facts(init, parsed, objects),
        parse_goal(goal, parsed, objects),
        {},
    )
    return StreamTask(task, tuple(bound), {name: name for name in objects} | dict(values or {}))


def solve(algorithm: str, problem: StreamTask, *, seconds: float = 8.0, seed: int = 0) -> Result:
    """Run an algorithm as the api does: under an alarm, every stream call with a generator of its own."""
    deadline = Deadline(seconds)
    try:
        return Interrupter(deadline, strangers=FOREIGN_CALLERS).run(
            lambda: ALGORITHMS[algorithm](
                problem, lambda key: random.Random(f"{seed} {key}"), deadline, lambda effort: None
            )
        )
    except OutOfTime:
        return Result(Outcome.TIMEOUT, Objects({}, {}))


def replay(problem: StreamTask, result: Result) -> None:
    """Run the plan by the book: from the initial facts and those that it says it rests on, to the goal."""
    assert result.outcome is Outcome.SOLVED, (result.outcome, result.explanation, result.warnings)
    used = {name for action in result.actions for name in action.arguments}
    used |= {name for fact in result.certified for name in fact[1:]}
    objects = {name: result.objects.types[name] for name in sorted(used)}
    interpreter = Interpreter(problem.task, result.certified, objects)
    interpreter.run((action.name, action.arguments) for action in result.actions)


def plan_text(result: Result) -> str:
    """The plan with its values, to compare."""
    names = sorted({name for action in result.actions for name in action.arguments})
    values = {name: result.objects.values.get(name) for name in names}
    return (
        repr([(a.name, a.arguments) for a in result.actions])
        + repr(values)
        + repr(result.certified)
    )
