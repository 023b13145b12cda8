"""Summary of a solution for `--json`: the outcome, and the plan without its trajectories."""

from __future__ import annotations

from typing import Any

from tamp.plan.write import rounded, statistics_document
from tamp.planner.solution import Solution


def summary_document(solution: Solution) -> dict[str, Any]:
    """Return what `--json` prints: the outcome, and the plan without its trajectories."""
    timing = {name: round(seconds, 6) for name, seconds in solution.seconds.items()}

    return {
        "outcome": solution.outcome.name.lower(),
        "message": solution.outcome.value,
        "explanation": list(solution.explanation),
        "causes": [cause.document() for cause in solution.causes],
        "tried": [
            {
                "action": tally.action,
                "stream": tally.stream,
                "tries": tally.tries,
                "successes": tally.successes,
                "reasons": dict(tally.reasons.most_common()),
            }
            for tally in solution.tallies
        ],
        "problem": solution.problem.name,
        "seed": solution.seed,
        "actions": [
            {
                "name": action.name,
                "objects": list(action.objects),
                "arguments": list(action.arguments),
                "start": rounded(action.start),
                "duration": rounded(action.trajectory.duration),
                "cost": action.cost,
            }
            for action in solution.plan
        ],
        "cost": solution.cost,
        "duration": rounded(solution.duration),
        **_optimization(solution),
        "statistics": statistics_document(solution),
        "warnings": list(solution.warnings),
        "timing": timing,
    }


def _optimization(solution: Solution) -> dict[str, Any]:
    if not solution.improvements:
        return {}
    steps = [
        {
            "seconds": round(i.seconds, 6),
            "cost": i.cost,
            "actions": i.actions,
            "duration": rounded(i.duration),
        }
        for i in solution.improvements
    ]
    return {"optimization": {"bound": solution.bound, "gap": solution.gap, "improvements": steps}}
