"""One verdict from two engines: one decides, and what the other sees otherwise is noted."""

from __future__ import annotations

from dataclasses import replace

from tamp.plan.violation import Violation
from tamp.verification.report import Report

Key = tuple[int | None, str, tuple[str, ...]]


def compared(decides: Report, other: Report) -> Report:
    """Return the first report, with notes on each violation that only one of both engines finds."""
    first, second = _by_key(decides), _by_key(other)
    notes = [
        f"{other.engine} does not see this: {first[key]}" for key in first if key not in second
    ]
    notes += [
        f"{other.engine} alone sees this, which does not count: {second[key]}"
        for key in second
        if key not in first
    ]
    if decides.holds != other.holds:
        notes.insert(0, f"by {other.engine} alone the plan {_verdict(other)}")

    return replace(
        decides,
        notes=(*decides.notes, *notes),
        engine=f"{decides.engine}, {other.engine}",
        seconds=max(decides.seconds, other.seconds),
    )


def _by_key(report: Report) -> dict[Key, Violation]:
    """Return violations by what they are about, whatever their figures."""
    return {(one.index, one.kind, tuple(sorted(one.bodies))): one for one in report.violations}


def _verdict(report: Report) -> str:
    return "holds" if report.holds else "does not hold"
