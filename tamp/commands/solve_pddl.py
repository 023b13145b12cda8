"""tamp-solve for a domain and a problem in PDDL: load, plan, judge, write, show."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from tamp.commands.solve_options import Arguments, Budget
from tamp.commands.solve_verdict import closing_lines, judge_text
from tamp.errors import InputError
from tamp.planner.pddl_only.anytime import optimize_symbolic
from tamp.planner.pddl_only.parallel import solve_symbolic_parallel
from tamp.planner.pddl_only.problem import SymbolicProblem, load_symbolic
from tamp.planner.pddl_only.report import (
    document,
    headline,
    improvement,
    plan_text,
    summary,
    write_symbolic_plan,
)
from tamp.planner.pddl_only.solve import SymbolicSolution, choose
from tamp.symbolic.algorithms.result import Outcome
from tamp.system import guard
from tamp.system.files import find_domain
from tamp.system.outputs import check_outputs
from tamp.system.progress import Progress, say
from tamp.verification.report import Report


@dataclass(frozen=True)
class Ended:
    """The end of the command: the solution, the judge's verdict if it was asked, the file that was
    written.
    """

    solution: SymbolicSolution
    verdict: Report | None
    written: Path | None

    @property
    def interrupted(self) -> bool:
        """Return whether the user ended it."""
        return self.solution.outcome is Outcome.INTERRUPTED

    def json(self) -> str:
        """Return what `--json` prints."""
        content = {
            **document(self.solution),
            "plan": None if self.written is None else str(self.written),
        }
        if self.verdict is not None:
            content["verification"] = self.verdict.json()
        return json.dumps(content, indent=2)


def solve_pddl(options: Arguments, budget: Budget, shown: Progress) -> bool | None:
    """Plan a problem in PDDL, write the plan and show it.

    Args:
        options: Of the command line, checked.
        budget: The time that planning may take.
        shown: Says how far the command is.

    Returns:
        Whether a plan was written; None when the user has ended it.

    Raises:
        InputError: Anything wrong with the files or the names, with its place.
    """
    *domain, problem = options.files
    check_outputs(options.outputs, (*(find_domain(name) for name in domain), Path(problem)))
    shown.begin("searching")

    loaded = load(options)
    shown.line(headline(loaded))
    solution = plan(options, loaded, budget, shown)
    shown.line(summary(solution))
    verdict = judge(options, solution)
    ended = write(options, solution, verdict)
    show(options, ended, shown)

    return None if ended.interrupted else ended.written is not None


def load(options: Arguments) -> SymbolicProblem:
    """Read the domain, a file or the name of a shipped one, and the problem's file."""
    files = options.files
    choose(options.pddl.search, options.pddl.heuristic)
    if len(files) != 2:
        remedy = "For example: tamp-solve domain.pddl problem.pddl"
        raise InputError(
            f"'{files[-1]}' alone: a problem in PDDL needs its domain before it", remedy=remedy
        )
    if not files[0].endswith(".pddl") and Path(files[0]).suffix:
        raise InputError(f"expected [DOMAIN] PROBLEM, found '{files[0]}' in the domain's place")
    return load_symbolic(*files)


def plan(
    options: Arguments, loaded: SymbolicProblem, budget: Budget, shown: Progress
) -> SymbolicSolution:
    """Search for a plan; for ever cheaper ones, if that is wanted."""
    if options.optimize:
        return optimize_symbolic(
            loaded, max_time=budget.left(), improved=lambda better: shown.line(improvement(better))
        )
    return solve_symbolic_parallel(
        loaded,
        jobs=options.jobs,
        search=options.pddl.search,
        heuristic=options.pddl.heuristic,
        max_time=budget.left(),
        seed=options.seed,
    )


def judge(options: Arguments, solution: SymbolicSolution) -> Report | None:
    """Ask the independent judge, if that is wanted; after an interruption, nothing is begun."""
    if solution.solved and options.verify and not guard.asked():
        return judge_text(plan_text(solution))
    return None


def write(options: Arguments, solution: SymbolicSolution, verdict: Report | None) -> Ended:
    """Write a plan that the judge does not refuse."""
    holds = solution.solved and (verdict is None or verdict.holds)
    return Ended(solution, verdict, write_symbolic_plan(solution, options.out) if holds else None)


def show(options: Arguments, ended: Ended, shown: Progress) -> None:
    """Print how it ended: one JSON document, or the last lines."""
    if options.json:
        say(ended.json())
    for line in closing_lines(options.out, ended.written, ended.verdict):
        shown.line(line)
