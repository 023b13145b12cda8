"""Planning a purely symbolic problem: instantiate, search, say how it ended."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from tamp.errors import InputError
from tamp.planner.pddl_only.cheaper_plan import cheaper_plan, refutation
from tamp.planner.pddl_only.problem import SymbolicProblem
from tamp.symbolic.algorithms.cause import Cause, CauseKind, distinct_causes
from tamp.symbolic.algorithms.explanation.explanation import explain_infeasible
from tamp.symbolic.algorithms.explanation.unachievable_facts import UnachievableFacts
from tamp.symbolic.algorithms.optimistic.optimistic_instantiation import type_facts
from tamp.symbolic.algorithms.result import Outcome, StreamTask
from tamp.symbolic.pddl.structs import Formula
from tamp.symbolic.search.heuristics.registry import ADMISSIBLE
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.operators import InstantiatedTask, Operator
from tamp.symbolic.search.search import (
    SEARCHES,
    Reason,
    SearchResult,
    search,
    split_heuristics,
)
from tamp.system.deadline import Deadline, OutOfTime, counted
from tamp.system.garbage import infrequent_collection
from tamp.system.interrupts import Interrupter

DEFAULT_SEARCH = "greedy"
"""The search when none is named."""

FALLBACK_SEARCHES = (("eager", "ff"), ("wastar", "blind"))
"""Searches and heuristics that go on where a plan does not hold when it is replayed."""

OUTCOMES = {
    Reason.UNSOLVABLE: Outcome.INFEASIBLE,
    Reason.TIME: Outcome.TIMEOUT,
    Reason.LIMIT: Outcome.EXHAUSTED,
}


@dataclass(frozen=True)
class SymbolicSolution:
    """The end of planning a symbolic problem.

    Attributes:
        plan: Operators in order, empty unless solved.
        optimal: Whether the search proves that no plan is cheaper.
        causes: Why there is no plan; `explanation` has their texts.
        operators: How many operators the task has.
        facts: How many facts may change.
        history: The plans on the way to this one and itself, where the first was not enough:
            seconds and cost.
        bound: What no plan costs less than, as far as a search with an admissible heuristic knows.
        seconds: Wall-clock time: "total", "instantiation", "search".
        refuted: Plans that did not hold when they were replayed by the book: mistakes of the
            planner's, not returned.
    """

    problem: SymbolicProblem
    outcome: Outcome
    search: str
    heuristic: str
    plan: tuple[Operator, ...] = ()
    optimal: bool = False
    causes: tuple[Cause, ...] = ()
    expanded: int = 0
    evaluated: int = 0
    operators: int = 0
    facts: int = 0
    history: tuple[tuple[float, float], ...] = ()
    bound: float = 0.0
    seconds: dict[str, float] = field(default_factory=dict[str, float])
    refuted: int = 0

    @property
    def explanation(self) -> tuple[str, ...]:
        """Return why there is no plan, a line a cause."""
        return tuple(cause.text for cause in self.causes)

    @property
    def solved(self) -> bool:
        """Tell that there is a plan."""
        return self.outcome is Outcome.SOLVED

    @property
    def cost(self) -> float:
        """Sum the actions' costs."""
        return sum(operator.cost for operator in self.plan)

    @property
    def gap(self) -> float:
        """Return the part of the cost that the lower bound leaves open: 0 when no plan is
        cheaper.
        """
        return max(0.0, 1.0 - self.bound / self.cost) if self.cost > 0.0 else 0.0


def choose(search: str | None, heuristic: str | None) -> tuple[str, str]:
    """Choose the names of a search and a heuristic that go together: A* asks for an admissible
    estimate.

    Raises:
        InputError: A name that is not known.
    """
    if search is not None and search not in SEARCHES:
        raise InputError(f"unknown search '{search}'", found=search, choices=SEARCHES)
    search = search or DEFAULT_SEARCH
    heuristic = heuristic or ("lmcut" if search == "astar" else "ff+landmarks")
    split_heuristics(heuristic)
    return search, heuristic


def solve_symbolic(
    problem: SymbolicProblem,
    *,
    search: str | None = None,
    heuristic: str | None = None,
    max_time: float = 30.0,
    seed: int = 0,
) -> SymbolicSolution:
    """Plan: instantiate the task, search, and have the plan replayed.

    Args:
        problem: From `load_symbolic`.
        search: A name of `SEARCHES`, by default "greedy"; "astar" with "lmcut", "hmax" or "blind"
            is optimal.
        heuristic: Names of `HEURISTICS` with + between them, by default "ff+landmarks", for A*
            "lmcut".
        max_time: Seconds.
        seed: Of the random orders in which greedy search begins anew where it stalls.

    Raises:
        InputError: A name that is not known, or a task that cannot be instantiated.
    """
    search, heuristic = choose(search, heuristic)
    deadline = Deadline(max_time)
    try:
        return Interrupter(deadline).run(lambda: _solve(problem, search, heuristic, deadline, seed))
    except (OutOfTime, KeyboardInterrupt) as end:
        outcome = Outcome.TIMEOUT if isinstance(end, OutOfTime) else Outcome.INTERRUPTED
        return SymbolicSolution(
            problem, outcome, search, heuristic, seconds={"total": deadline.elapsed()}
        )


@infrequent_collection()
def _solve(
    problem: SymbolicProblem, name: str, heuristic: str, deadline: Deadline, seed: int
) -> SymbolicSolution:
    started = counted()
    task = problem.task
    instantiated = instantiate(task)
    ready = counted()
    refuted: list[str] = []

    for way in ((name, heuristic), *FALLBACK_SEARCHES):
        found = search(instantiated, search=way[0], heuristic=way[1], deadline=deadline, seed=seed)
        reason = refutation(task, found.plan)
        if reason is None:
            found = (
                cheaper_plan(task, instantiated, found, deadline)
                if name == DEFAULT_SEARCH
                else found
            )
            name, heuristic = way
            break
        refuted.append(reason)
    else:
        found = SearchResult(None, Reason.LIMIT, found.expanded, found.evaluated)

    done = counted()
    outcome = (
        Outcome.SOLVED if found.plan is not None or found.reason is None else OUTCOMES[found.reason]
    )
    infeasible = outcome is Outcome.INFEASIBLE

    return SymbolicSolution(
        problem,
        outcome,
        name,
        heuristic,
        plan=found.plan.operators if found.plan is not None else (),
        optimal=found.plan is not None
        and name == "astar"
        and ADMISSIBLE.issuperset(split_heuristics(heuristic)),
        causes=distinct_causes(Cause(text, CauseKind.REFUTED) for text in refuted)
        + (_why(problem, instantiated, deadline) if infeasible else ()),
        expanded=found.expanded,
        evaluated=found.evaluated,
        operators=len(instantiated.operators),
        facts=len(instantiated.reachable | instantiated.initial),
        seconds={"total": done - started, "instantiation": ready - started, "search": done - ready},
        refuted=len(refuted),
    )


def _why(
    problem: SymbolicProblem, instantiated: InstantiatedTask, deadline: Deadline
) -> tuple[Cause, ...]:
    task = problem.task
    facts = {*task.initial, *type_facts(task), *instantiated.reachable, *instantiated.initial}
    missing = UnachievableFacts(task, (), facts, {**task.domain.constants, **task.objects})

    def towards(goal: Formula) -> InstantiatedTask:
        return instantiate(replace(task, goal=goal))

    return explain_infeasible(
        StreamTask(task, (), {}), instantiated, {}, missing, deadline, towards
    )
