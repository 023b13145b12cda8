"""Statistics of a benchmark's runs: success with its interval, times, paired comparison, time by
part.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

PENALTY = 2.0
"""A run without a plan counts as this many times its budget (PAR-2)."""


@dataclass(frozen=True)
class Summary:
    """One problem with one sampler. Times in seconds, over all runs.

    Attributes:
        problem: As in `Case`.
        sampler: As in `Case`.
        budget: Of one run.
        runs: How many.
        solved: Those with a plan that the judge accepts.
        rejected: Those with one that it does not.
        broken: Runs in which the planner raised, or whose process was lost each time.
        interval: Wilson's, 95 %, of the share of solved ones.
        median: Of the planning times; a run without a plan takes for ever.
        p95: The same, 95th percentile.
        par2: Mean planning time; a run without a plan counts as twice the budget.
        cpu: Median processor time of all runs.
        speedup: Median over the paired seeds of the baseline's time by this one's, both as for
            PAR-2; or None.
        parts: Mean time by part, and None when no run tells.
    """

    problem: str
    sampler: str
    budget: float
    runs: int
    solved: int
    rejected: int
    broken: int
    interval: tuple[float, float]
    median: float
    p95: float
    par2: float
    cpu: float
    speedup: float | None
    parts: Mapping[str, float] | None


def succeeded(line: Mapping[str, Any]) -> bool:
    """Check whether a run ended with a plan that the judge accepts."""
    return line["solved"] and line["verified"] is True


def summaries(lines: Iterable[Mapping[str, Any]], baseline: str | None = None) -> list[Summary]:
    """Summarize the runs, once for each problem and sampler, in the order in which they first
    appear, the problems together.

    Args:
        lines: Results of one budget and algorithm.
        baseline: The sampler that the others are compared with, seed by seed.
    """
    groups: dict[str, dict[str, list[Mapping[str, Any]]]] = {}
    for line in lines:
        config = line["config"]
        groups.setdefault(config["problem"], {}).setdefault(config["sampler"], []).append(line)
    return [
        _summary(problem, sampler, found, by_sampler.get(baseline or ""))
        for problem, by_sampler in groups.items()
        for sampler, found in by_sampler.items()
    ]


def times(lines: Iterable[Mapping[str, Any]]) -> list[float]:
    """Return planning times, infinite without a plan, the shortest first."""
    return sorted(line["planning_s"] if succeeded(line) else math.inf for line in lines)


def penalised(line: Mapping[str, Any]) -> float:
    """Return the penalised planning time: twice the budget without a plan."""
    return line["planning_s"] if succeeded(line) else PENALTY * line["config"]["time"]


def percentile(ordered: Sequence[float], q: float) -> float:
    """Compute the q-th percentile, 0 to 100, of sorted values, linear between the two nearest; NaN
    of nothing.
    """
    if not ordered:
        return math.nan
    place = q / 100 * (len(ordered) - 1)
    low, high = ordered[math.floor(place)], ordered[math.ceil(place)]
    share = place - math.floor(place)
    return low if share == 0.0 or low == high else low + share * (high - low)


def wilson(successes: int, trials: int, z: float = 1.96) -> tuple[float, float]:
    """Compute Wilson's score interval of a success rate, 95 % by default; (0, 1) when nothing was
    tried.

    Source: E. B. Wilson, Journal of the American Statistical Association 22 (1927), 209-212.
    """
    if trials == 0:
        return 0.0, 1.0
    rate = successes / trials
    centre = rate + z * z / (2 * trials)
    spread = z * math.sqrt(rate * (1 - rate) / trials + z * z / (4 * trials * trials))
    scale = 1 + z * z / trials
    return max(0.0, (centre - spread) / scale), min(1.0, (centre + spread) / scale)


def _summary(
    problem: str,
    sampler: str,
    lines: list[Mapping[str, Any]],
    against: list[Mapping[str, Any]] | None,
) -> Summary:
    ordered = times(lines)
    solved = sum(map(succeeded, lines))
    return Summary(
        problem=problem,
        sampler=sampler,
        budget=max(line["config"]["time"] for line in lines),
        runs=len(lines),
        solved=solved,
        rejected=sum(line["solved"] and not succeeded(line) for line in lines),
        broken=sum(line["outcome"] in ("ERROR", "LOST") for line in lines),
        interval=wilson(solved, len(lines)),
        median=percentile(ordered, 50),
        p95=percentile(ordered, 95),
        par2=sum(map(penalised, lines)) / len(lines),
        cpu=percentile(sorted(line["cpu_s"] for line in lines if "cpu_s" in line), 50),
        speedup=None if against is None or against is lines else _speedup(lines, against),
        parts=_parts(lines),
    )


def _speedup(lines: list[Mapping[str, Any]], against: list[Mapping[str, Any]]) -> float | None:
    others = {line["config"]["seed"]: penalised(line) for line in against}
    ratios = sorted(
        others[line["config"]["seed"]] / max(penalised(line), 1e-9)
        for line in lines
        if line["config"]["seed"] in others
    )
    return percentile(ratios, 50) if ratios else None


def _parts(lines: list[Mapping[str, Any]]) -> dict[str, float] | None:
    told = [line["parts_s"] for line in lines if "parts_s" in line]
    names = dict.fromkeys(name for parts in told for name in parts)
    return (
        {name: sum(parts.get(name, 0.0) for parts in told) / len(told) for name in names}
        if told
        else None
    )
