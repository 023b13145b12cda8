"""The part of tamp-solve that plans a domain and a problem in PDDL."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from tamp.errors import InputError
from tamp.planner.pddl_only.anytime import optimize_symbolic
from tamp.planner.pddl_only.parallel import solve_symbolic_parallel
from tamp.planner.pddl_only.problem import load_symbolic
from tamp.planner.pddl_only.report import document, headline, improvement, plan_text, summary, write_symbolic_plan
from tamp.planner.pddl_only.solve import SymbolicSolution, choose
from tamp.symbolic.algorithms.result import Outcome
from tamp.system import guard
from tamp.verification.report import Report


@dataclass(frozen=True)
class Ended:
    """How the command ended: the solution, the judge's verdict if it was asked, the file that was written."""

    solution: SymbolicSolution
    verdict: Report | None
    written: Path | None

    @property
    def interrupted(self) -> bool:
        """Whether the user ended it."""
        return self.solution.outcome is Outcome.INTERRUPTED

    def json(self) -> str:
        """What `--json` prints."""
        content = {**document(self.solution), "plan": None if self.written is None else str(self.written)}
        if self.verdict is not None:
            content["verification"] = self.verdict.json()
        return json.dumps(content, indent=2)


def plan_files(
    files: Sequence[str],
    *,
    search: str | None,
    heuristic: str | None,
    jobs: int,
    optimize: bool,
    left: Callable[[], float],
    out: Path,
    judge: Callable[[str], Report] | None,
    show: Callable[[str], None],
) -> Ended:
    """Plan, show what is to be said, write the plan.

    Args:
        files: The domain, a file or the name of a shipped one, and the problem's file.
        search: A name of `SEARCHES` or None.
        heuristic: A name of `HEURISTICS` or None.
        jobs: How many searches at a time.
        optimize: Whether to look for cheaper plans after the first one.
        left: Seconds that remain.
        out: Where the plan is written.
        judge: Says whether a plan file's text holds; one that does not hold is not written.
        show: Prints a line.

    Raises:
        InputError: Anything wrong with the files or the names, with its place.
    """
    choose(search, heuristic)
    if len(files) != 2:
        remedy = "For example: tamp-solve domain.pddl problem.pddl"
        raise InputError(f"'{files[-1]}' alone: a problem in PDDL needs its domain before it", remedy=remedy)
    if not files[0].endswith(".pddl") and Path(files[0]).suffix:
        raise InputError(f"expected [DOMAIN] PROBLEM, found '{files[0]}' in the domain's place")
    loaded = load_symbolic(*files)
    show(headline(loaded))
    if optimize:
        solution = optimize_symbolic(loaded, max_time=left(), improved=lambda better: show(improvement(better)))
    else:
        solution = solve_symbolic_parallel(loaded, jobs=jobs, search=search, heuristic=heuristic, max_time=left())
    show(summary(solution))
    stopped = guard.asked()  # what was found is kept, and nothing begun
    verdict = judge(plan_text(solution)) if solution.solved and judge is not None and not stopped else None
    holds = solution.solved and (verdict is None or verdict.holds)
    return Ended(solution, verdict, write_symbolic_plan(solution, out) if holds else None)
