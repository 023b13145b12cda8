"""Anytime search for a symbolic problem: greedy first, then weighted A* with less weight, then
A* for the proof.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable
from dataclasses import replace

from tamp.planner.pddl_only.cheaper_plan import refutation
from tamp.planner.pddl_only.problem import SymbolicProblem
from tamp.planner.pddl_only.solve import SymbolicSolution, solve_symbolic
from tamp.symbolic.algorithms.result import Outcome
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.search import Plan, Reason, search
from tamp.system.deadline import Deadline, OutOfTime, counted
from tamp.system.interrupts import Interrupter

SEARCH_LADDER = (
    ("wastar", "ff+landmarks", 5.0),
    ("wastar", "ff+landmarks", 2.0),
    ("wastar", "ff", 1.0),
    ("astar", "lmcut", 1.0),
)
"""Search, heuristic and weight, one after the other; the last one proves that nothing is cheaper.
"""

TIME_SHARE_PER_SEARCH = 0.25
"""The part of the remaining time that a search before the last one gets."""


def optimize_symbolic(
    problem: SymbolicProblem, *, max_time: float, improved: Callable[[SymbolicSolution], None]
) -> SymbolicSolution:
    """Plan greedily, then look for cheaper plans until one is proven to be the cheapest, or the
    time is up.

    Args:
        problem: From `load_symbolic`.
        max_time: Seconds.
        improved: Called with each plan that is cheaper than those before it.

    Raises:
        InputError: As for `solve_symbolic`.
    """
    deadline = Deadline(max_time)
    best = solve_symbolic(problem, max_time=max_time)
    if not best.solved:
        return best
    best = replace(best, history=((deadline.elapsed(), best.cost),))

    def improve() -> None:
        nonlocal best
        instantiated = instantiate(problem.task)
        start = search(instantiated, search="astar", heuristic="lmcut", limit=1, deadline=deadline)
        best = replace(best, bound=min(start.bound, best.cost))
        improved(best)

        for name, heuristic, weight in SEARCH_LADDER:
            last = name == "astar"
            within = deadline if last else Deadline(TIME_SHARE_PER_SEARCH * deadline.left())
            while best.bound < best.cost:
                started = counted()
                found = search(
                    instantiated,
                    search=name,
                    heuristic=heuristic,
                    weight=weight,
                    deadline=within,
                    below=best.cost,
                )
                best = _counted(best, found.expanded, found.evaluated, counted() - started)

                if refutation(problem.task, found.plan) is not None:
                    best = replace(best, refuted=best.refuted + 1)
                    break

                if last or found.reason is Reason.UNSOLVABLE:
                    # There is none: the bound is the cost.
                    proven = found.reason is Reason.UNSOLVABLE or found.plan is not None
                    bound = best.cost if found.plan is None and proven else found.bound
                    best = replace(best, bound=max(best.bound, min(bound, best.cost)))
                if found.plan is not None:
                    best = _better(
                        best, found.plan, name, heuristic, deadline.elapsed(), optimal=last
                    )
                    improved(best)
                if found.plan is None:
                    break

    with contextlib.suppress(OutOfTime, KeyboardInterrupt):
        Interrupter(deadline).run(improve)
    optimal = math.isclose(best.bound, best.cost, rel_tol=1e-9, abs_tol=1e-9)
    return replace(best, optimal=optimal, seconds={**best.seconds, "total": deadline.elapsed()})


def _counted(
    best: SymbolicSolution, expanded: int, evaluated: int, seconds: float
) -> SymbolicSolution:
    spent = {**best.seconds, "search": best.seconds["search"] + seconds}
    return replace(
        best, expanded=best.expanded + expanded, evaluated=best.evaluated + evaluated, seconds=spent
    )


def _better(
    best: SymbolicSolution,
    plan: Plan,
    search: str,
    heuristic: str,
    elapsed: float,
    *,
    optimal: bool,
) -> SymbolicSolution:
    found = replace(
        best, outcome=Outcome.SOLVED, plan=plan.operators, search=search, heuristic=heuristic
    )
    history = (*best.history, (elapsed, found.cost))
    return replace(found, history=history, bound=found.cost if optimal else best.bound)
