"""A portfolio of searches for a symbolic problem, each in a process of its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace
from typing import Any

from tamp.planner.pddl_only.problem import SymbolicProblem
from tamp.planner.pddl_only.solve import SymbolicSolution, choose, solve_symbolic
from tamp.symbolic.algorithms.result import Outcome
from tamp.symbolic.search.heuristics.loops.selection import prepare as prepare_loops
from tamp.symbolic.search.heuristics.registry import ADMISSIBLE
from tamp.symbolic.search.operators import NO_FACTS, Operator
from tamp.system.deadline import Deadline
from tamp.system.race import Tell, race

SATISFICING_SEARCHES = (
    ("greedy", "ff+landmarks"),
    ("wastar", "ff+landmarks"),
    ("eager", "ff"),
    ("greedy", "hadd"),
    ("wastar", "hadd"),
)
"""Searches that differ in what they find easy."""

OPTIMAL_SEARCHES = (("astar", "lmcut"), ("astar", "hmax"), ("astar", "blind"))
"""Those whose plans are the cheapest."""


def portfolio(search: str | None, heuristic: str | None, jobs: int) -> list[tuple[str, str]]:
    """Return the search that was asked for, and up to `jobs - 1` others that promise as much."""
    first = choose(search, heuristic)
    optimal = first[0] == "astar" and ADMISSIBLE.issuperset(first[1].split("+"))
    return list(dict.fromkeys((first, *(OPTIMAL_SEARCHES if optimal else SATISFICING_SEARCHES))))[
        :jobs
    ]


def solve_symbolic_parallel(
    problem: SymbolicProblem,
    *,
    jobs: int,
    search: str | None,
    heuristic: str | None,
    max_time: float,
    seed: int = 0,
) -> SymbolicSolution:
    """Plan by several searches; the first plan, or proof that there is none, counts.

    Args:
        problem: From `load_symbolic`.
        jobs: Most processes at a time; there are only as many as there are different searches for
            the purpose.
        search: Of the first one, as for `solve_symbolic`; if it is optimal, so are the others.
        heuristic: Of the first one.
        max_time: Seconds.
        seed: As for `solve_symbolic`.

    Raises:
        InputError: As for `solve_symbolic`.
    """
    if jobs == 1:
        return solve_symbolic(
            problem, search=search, heuristic=heuristic, max_time=max_time, seed=seed
        )
    prepare_loops()
    deadline = Deadline(max_time)
    pairs = portfolio(search, heuristic, jobs)

    def member(search: str, heuristic: str) -> Callable[[Tell], dict[str, Any]]:
        def run(tell: Tell) -> dict[str, Any]:
            solution = solve_symbolic(
                problem,
                search=search,
                heuristic=heuristic,
                max_time=deadline.left(),
                seed=seed,
            )
            solution = replace(solution, plan=tuple(map(_bare, solution.plan)))
            return {
                part.name: getattr(solution, part.name)
                for part in fields(solution)
                if part.name != "problem"
            }

        return run

    def ends(number: int, answer: dict[str, Any]) -> bool:
        return answer["outcome"] in (Outcome.SOLVED, Outcome.INFEASIBLE)

    try:
        found = race([member(*pair) for pair in pairs], ends, deadline)
        outcome = Outcome.TIMEOUT
    except KeyboardInterrupt:
        found, outcome = None, Outcome.INTERRUPTED
    if found is None:
        return SymbolicSolution(problem, outcome, *pairs[0], seconds={"total": deadline.elapsed()})
    return SymbolicSolution(problem=problem, **found.answer)


def _bare(operator: Operator) -> Operator:
    """Keep of an operator what a report reads."""
    return Operator(
        operator.name, operator.arguments, NO_FACTS, NO_FACTS, NO_FACTS, NO_FACTS, operator.cost
    )
