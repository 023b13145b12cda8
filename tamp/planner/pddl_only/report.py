"""A symbolic solution in words, and as a plan file."""

from __future__ import annotations

import hashlib
import json
import platform
from pathlib import Path
from typing import Any

from tamp.errors import InputError, printable
from tamp.planner.pddl_only.problem import SymbolicProblem
from tamp.planner.pddl_only.solve import SymbolicSolution
from tamp.symbolic.algorithms.result import Outcome
from tamp.symbolic.pddl.structs import And
from tamp.system.distribution import distribution_version
from tamp.system.outputs import write_whole


def headline(problem: SymbolicProblem) -> str:
    """Word one line about the problem."""
    task = problem.task
    goals = len(task.goal.parts) if isinstance(task.goal, And) else 1
    objects = _count(len(task.objects), "object")
    return (
        f"{printable(problem.name)}: {_count(goals, 'goal')}, {objects}, domain {task.domain.name}"
    )


def summary(solution: SymbolicSolution) -> str:
    """Word what the command line prints when planning has ended."""
    lines = [f"warning: {text}" for text in solution.problem.warnings]
    total = solution.seconds.get("total", 0.0)
    if solution.solved:
        lines += [f"warning: {line}" for line in solution.explanation]
        optimal = " (optimal)" if solution.optimal else ""
        lines += [
            f"Solved in {total:.2f} s: {_count(len(solution.plan), 'action')}, "
            f"cost {solution.cost:g}{optimal}",
            "",
            *(f"  {number:2d}  {operator}" for number, operator in enumerate(solution.plan, 1)),
        ]
        if not solution.plan:
            lines.append("  the goal holds at the start")
    elif solution.outcome is Outcome.TIMEOUT:
        lines.append(f"No plan in {total:.1f} s")
    else:
        lines.append(f"{solution.outcome.value}{':' if solution.explanation else '.'}")
        lines += [f"  {line}" for line in solution.explanation]

    facts = f"{_count(solution.operators, 'operator')} and {_count(solution.facts, 'fact')}"
    lines += [
        "",
        f"  search   {solution.search} with {solution.heuristic} · "
        f"{_count(solution.expanded, 'state')} expanded, "
        f"{solution.evaluated:,} evaluated · {facts}",
    ]
    return "\n".join(lines)


def improvement(solution: SymbolicSolution) -> str:
    """Word one line about the latest improvement."""
    seconds, cost = solution.history[-1]
    count = _count(len(solution.plan), "action")
    bounds = f"no plan below {solution.bound:g}, gap {100 * solution.gap:.0f} %"
    return f"{seconds:7.2f} s  {count}, cost {cost:g}, {bounds}"


def document(solution: SymbolicSolution) -> dict[str, Any]:
    """Build what `--json` prints, and with the inputs the plan file's content."""
    return {
        "outcome": solution.outcome.name.lower(),
        "message": solution.outcome.value,
        "explanation": list(solution.explanation),
        "causes": [cause.document() for cause in solution.causes],
        "problem": solution.problem.name,
        **_plan(solution),
        **_optimization(solution),
        "statistics": {
            "search": solution.search,
            "heuristic": solution.heuristic,
            "expanded": solution.expanded,
            "evaluated": solution.evaluated,
            "operators": solution.operators,
            "facts": solution.facts,
            **({"refuted": solution.refuted} if solution.refuted else {}),
        },
        "warnings": list(solution.problem.warnings),
        "timing": {name: round(seconds, 6) for name, seconds in solution.seconds.items()},
    }


def plan_text(solution: SymbolicSolution) -> str:
    """Format the plan file of a solved problem; its schema is
    tamp/plan/symbolic-plan.schema.json.
    """
    problem = solution.problem
    content = {
        "format": "tamp-symbolic-plan",
        "version": 1,
        "inputs": {"problem": _file(problem.problem), "domain": _file(problem.domain)},
        "options": {"search": solution.search, "heuristic": solution.heuristic},
        "versions": {
            "tamp": distribution_version(),
            "python": platform.python_version(),
        },
        **_plan(solution),
    }
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def write_symbolic_plan(solution: SymbolicSolution, path: Path) -> Path:
    """Write a solved problem's plan file, whole or not at all. Folders are made.

    Raises:
        InputError: There is no plan, or the file cannot be written.
    """
    if not solution.solved:
        raise InputError("there is no plan to write")
    content = plan_text(solution).encode()
    try:
        write_whole(path, content)
    except OSError as error:
        raise InputError(f"cannot write the plan: {error.strerror}", file=path) from error
    return path


def _plan(solution: SymbolicSolution) -> dict[str, Any]:
    actions = [
        {"name": o.name, "arguments": list(o.arguments), "cost": o.cost} for o in solution.plan
    ]
    return {"actions": actions, "cost": solution.cost, "optimal": solution.optimal}


def _optimization(solution: SymbolicSolution) -> dict[str, Any]:
    if not solution.history:
        return {}
    steps = [{"seconds": round(seconds, 6), "cost": cost} for seconds, cost in solution.history]
    return {"optimization": {"bound": solution.bound, "gap": solution.gap, "improvements": steps}}


def _file(path: Path) -> dict[str, str]:
    try:
        return {"path": str(path), "sha256": hashlib.sha256(path.read_bytes()).hexdigest()}
    except OSError as error:
        raise InputError(f"it cannot be read any more: {error.strerror}", file=path) from error


def _count(number: int, one: str) -> str:
    return f"{number:,} {one}{'' if number == 1 else 's'}"
