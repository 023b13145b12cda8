"""Planning for a problem that was written for PDDLStream."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from random import Random
from typing import Any, NamedTuple, cast

from tamp.errors import InputError
from tamp.pddlstream.problem import PDDLProblem, bind
from tamp.symbolic.algorithms.bound_stream import FOREIGN_CALLERS
from tamp.symbolic.algorithms.experience.stream_statistics import StreamStatistics
from tamp.symbolic.algorithms.incremental import plan_incrementally, start_incremental
from tamp.symbolic.algorithms.registry import ALGORITHMS
from tamp.symbolic.algorithms.result import Outcome, Result, SearchStatistics, StreamTask
from tamp.symbolic.pddl.atoms import atoms
from tamp.symbolic.search.heuristics.loops.selection import load_kept as load_compiled_loops
from tamp.system.deadline import Deadline, OutOfTime
from tamp.system.interrupts import Interrupter

CLOSER_LOOK = 500
"""Draws after which a plan that no stream promises is given up, when none of them brought facts
besides its outputs.
"""


class Action(NamedTuple):
    """An action of a plan: its name and the values of its parameters."""

    name: str
    args: tuple[Any, ...]


@dataclass(frozen=True)
class Solution:
    """The end of planning. Unpacks as PDDLStream's solutions do: plan, cost, certificate.

    Attributes:
        outcome: How it ended.
        plan: The actions, or None.
        cost: Of the plan; infinite without one.
        certificate: What streams certified and the plan rests on, facts with values: ("Kin", "b0",
            conf, pose).
        explanation: Why there is no plan, a line a cause.
        warnings: What looks odd in the problem, and stream functions that failed.
        statistics: By stream.
        seconds: Wall-clock time.
    """

    outcome: Outcome
    plan: list[Action] | None = None
    cost: float = float("inf")
    certificate: tuple[tuple[Any, ...], ...] = ()
    explanation: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    statistics: Mapping[str, StreamStatistics] = field(default_factory=dict[str, StreamStatistics])
    effort: SearchStatistics = field(default_factory=SearchStatistics)
    seconds: float = 0.0

    @property
    def solved(self) -> bool:
        """Tell that there is a plan."""
        return self.outcome is Outcome.SOLVED

    def __iter__(self) -> Iterator[Any]:
        return iter((self.plan, self.cost, self.certificate))


def solve(
    problem: PDDLProblem | tuple[Any, ...],
    algorithm: str = "adaptive",
    *,
    unit_costs: bool = False,
    max_time: float = 30.0,
    seed: int = 0,
) -> Solution:
    """Plan with streams, as PDDLStream's `solve` does.

    Args:
        problem: The six parts of a problem, see `PDDLProblem`.
        algorithm: "adaptive" or "incremental".
        unit_costs: Whether every action costs one, whatever the domain says.
        max_time: Seconds.
        seed: Of the order in which the planner tries things; the stream functions' randomness is
            their own.

    Raises:
        InputError: Anything wrong with the problem or the names.
    """
    if algorithm not in ALGORITHMS:
        raise InputError(f"unknown algorithm '{algorithm}'", found=algorithm, choices=ALGORITHMS)
    if not max_time > 0.0:
        raise InputError(f"the time must be positive, not {max_time:g}")

    parts = cast(tuple[Any, ...], problem)
    if not isinstance(cast(Any, problem), tuple | list) or len(parts) != len(PDDLProblem._fields):
        names_of_parts = ", ".join(PDDLProblem._fields)
        what = f"a problem is a tuple of {len(PDDLProblem._fields)} parts: {names_of_parts}"
        raise InputError(what, remedy="See PDDLProblem")
    task, warnings, uncalled, names = bind(PDDLProblem(*parts), unit_costs=unit_costs)
    load_compiled_loops()  # before the clock starts
    deadline = Deadline(max_time)
    try:
        result = Interrupter(deadline, strangers=FOREIGN_CALLERS).run(
            lambda: _run(task, algorithm, seed, deadline)
        )
    except (OutOfTime, KeyboardInterrupt) as end:
        outcome = Outcome.TIMEOUT if isinstance(end, OutOfTime) else Outcome.INTERRUPTED
        return Solution(outcome, warnings=warnings, seconds=deadline.elapsed())

    values = result.objects.values
    solved = result.outcome is Outcome.SOLVED
    outcome, explanation = result.outcome, result.explanation
    if uncalled and not solved:  # an optimizer might have given what is missing
        outcome = Outcome.EXHAUSTED if outcome is Outcome.INFEASIBLE else outcome
        explanation = (*explanation, *uncalled)
    plan = [
        Action(action.name, tuple(values[word] for word in action.arguments))
        for action in result.actions
    ]
    return Solution(
        outcome,
        plan if solved else None,
        sum(action.cost for action in result.actions) if solved else float("inf"),
        tuple(
            (names.get(fact[0], fact[0]), *(values[word] for word in fact[1:]))
            for fact in result.certified
        ),
        explanation,
        (*warnings, *result.warnings),
        result.statistics,
        result.effort,
        deadline.elapsed(),
    )


def _run(task: StreamTask, algorithm: str, seed: int, deadline: Deadline) -> Result:
    """Run the algorithm; when it finds no way, look at what the streams really give."""

    def make_rng(key: str) -> Random:
        digest = hashlib.blake2b(key.encode(), digest_size=8, key=str(seed).encode()).digest()
        return Random(int.from_bytes(digest, "little"))

    result = ALGORITHMS[algorithm](task, make_rng, deadline, _silent)
    if result.outcome not in (Outcome.INFEASIBLE, Outcome.EXHAUSTED) or not task.streams:
        return result
    # Two things no stream promises: facts besides its outputs, and an output that equals a value of
    # the goal.
    second = start_incremental(task, make_rng, deadline, _silent, pruned=False)
    looked = plan_incrementally(second, CLOSER_LOOK)
    if looked.outcome is Outcome.EXHAUSTED and second.binder.draws < CLOSER_LOOK:
        # Not for want of draws: there are plans, but nothing proves that none of them holds.
        return looked
    open_end = bool(second.streams.wild) or not all(
        isinstance(value, str) for value in _goal_values(task)
    )
    if looked.outcome is Outcome.EXHAUSTED and open_end:
        looked = plan_incrementally(second)
    return looked if looked.outcome is Outcome.SOLVED or open_end else result


def _goal_values(task: StreamTask) -> list[Any]:
    """Return the values that the goal names."""
    terms = (term for atom in atoms(task.task.goal) for term in atom.terms)
    return [task.values[term] for term in terms if term in task.values]


def _silent(effort: SearchStatistics) -> None:
    pass
