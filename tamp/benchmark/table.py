"""Results as tables, in Markdown that is read as it stands."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from tamp.benchmark.summary import Summary, summaries

Row = dict[str, str]

MOST_WARNINGS = 10
"""Warnings of samplers that a report names."""


def report(lines: Sequence[Mapping[str, Any]], baseline: str | None = None) -> str:
    """Format the report: success and times, time by part, and where the figures come from.

    Args:
        lines: Results of one budget and algorithm, at least one.
        baseline: The sampler that the others are compared with.
    """
    found = summaries(lines, baseline)
    tables = [table([_success(one, baseline) for one in found])]
    told = [(one, one.parts) for one in found if one.parts]
    if told:
        tables += [
            "Mean seconds by part, of all runs:",
            table([_parts(one, parts) for one, parts in told]),
        ]
    return "\n\n".join([*tables, *_sidelined(lines), _origins(lines)])


def _sidelined(lines: Iterable[Mapping[str, Any]]) -> list[str]:
    """Describe the samplers that took no part to the end, once for each: without them the figures
    are others'.
    """
    said = Counter(
        (line["config"]["sampler"], warning)
        for line in lines
        for warning in line.get("warnings", ())
        if "is sidelined" in warning
    )
    if not said:
        return []
    shown = [
        f"{count} x {sampler}: {warning}"
        for (sampler, warning), count in said.most_common(MOST_WARNINGS)
    ]
    more = len(said) - len(shown)
    return [
        "\n".join(
            ["Samplers that were sidelined:", *shown, *([f"and {more} more"] if more > 0 else [])]
        )
    ]


def table(rows: Sequence[Row]) -> str:
    """Format rows of cells under the first one's keys, numbers to the right."""
    head = list(rows[0])
    widths = [max(len(name), *(len(row[name]) for row in rows)) for name in head]
    left = [name in ("problem", "sampler") for name in head]
    rule = [
        "-" * (width + 2) if to_left else "-" * (width + 1) + ":"
        for width, to_left in zip(widths, left, strict=True)
    ]
    written = [_written(head, widths, left), f"|{'|'.join(rule)}|"]
    return "\n".join(
        [*written, *(_written([row[name] for name in head], widths, left) for row in rows)]
    )


def short(problem: str) -> str:
    """Shorten a problem's name to that of its file, when it is a path."""
    return Path(problem).stem if "/" in problem else problem


def _written(cells: Sequence[str], widths: Sequence[int], left: Sequence[bool]) -> str:
    parts = (
        cell.ljust(width) if to_left else cell.rjust(width)
        for cell, width, to_left in zip(cells, widths, left, strict=True)
    )
    return f"| {' | '.join(parts)} |"


def _success(one: Summary, baseline: str | None) -> Row:
    low, high = one.interval
    row = {
        "problem": short(one.problem),
        "sampler": one.sampler,
        "solved": f"{one.solved}/{one.runs}",
        "95 %": f"{low:.2f}-{high:.2f}",
        "median [s]": _seconds(one.median, one.budget),
        "p95 [s]": _seconds(one.p95, one.budget),
        "PAR-2 [s]": _seconds(one.par2, math.inf),
        "CPU median [s]": _seconds(one.cpu, math.inf),
    }
    if baseline is not None:
        row[f"faster than {baseline}"] = "" if one.speedup is None else f"{one.speedup:.2g}x"
    return {**row, "rejected": str(one.rejected), "broken": str(one.broken)}


def _parts(one: Summary, parts: Mapping[str, float]) -> Row:
    total = sum(parts.values())
    cells = {
        name: f"{seconds:.3f} ({100 * seconds / max(total, 1e-9):.0f} %)"
        for name, seconds in parts.items()
    }
    return {"problem": short(one.problem), "sampler": one.sampler, **cells, "total": f"{total:.3f}"}


def _seconds(value: float, budget: float) -> str:
    if math.isnan(value):
        return ""
    return f">{budget:g}" if math.isinf(value) else f"{value:.2f}"


def _origins(lines: Sequence[Mapping[str, Any]]) -> str:
    config = lines[0]["config"]
    loads = [line["load"] for line in lines if "load" in line]
    load = f", load {min(loads):.1f}-{max(loads):.1f}" if loads else ""
    commits = _listed(line["commit"] for line in lines if "commit" in line)
    machines = _listed(
        f"{line['machine']['cpu']}, {line['machine']['cores']} cores"
        for line in lines
        if "machine" in line
    )
    return (
        f"{len(lines)} runs of {config['time']:g} s, {config['algorithm']}; "
        "a plan counts when the independent judge accepts it.\n"
        f"Commit {commits}; {machines}{load}."
    )


def _listed(words: Iterable[str]) -> str:
    return " and ".join(dict.fromkeys(words)) or "unknown"
