"""A plan's pauses, in which physics would stand still for as long as a file says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tamp.errors import InputError
from tamp.plan.read import PlanFile, StoredSegment

MAX_PAUSE_S = 10.0
"""Seconds that nothing moves in a segment; what is longer is cut."""

MAX_PLAN_DURATION_S = 7_200.0
"""Of a plan's motion that is carried out."""


def without_pauses(plan: PlanFile) -> tuple[PlanFile, float]:
    """Cut the plan's long pauses; return the plan, and the seconds that were left out.

    Raises:
        InputError: Times of a segment do not increase, or the plan moves for hours.
    """
    cut = moving = 0.0
    actions = []
    for action in plan.actions:
        segments = [_shortened(segment, plan) for segment in action.segments]
        cut += sum(
            float(a.times[-1] - b.times[-1]) for a, b in zip(action.segments, segments, strict=True)
        )
        moving += sum(float(segment.times[-1]) for segment in segments)
        actions.append(replace(action, segments=tuple(segments)))
    if moving > MAX_PLAN_DURATION_S:
        most = f"{MAX_PLAN_DURATION_S:,.0f} s"
        what = f"its motions last {moving:,.0f} s; physics carries out at most {most}"
        raise InputError(what, file=plan.file)
    return (replace(plan, actions=tuple(actions)), cut) if cut else (plan, 0.0)


def _shortened(segment: StoredSegment, plan: PlanFile) -> StoredSegment:
    spans = np.diff(segment.times, prepend=0.0)
    if (spans < 0.0).any():
        raise InputError(f"times of the {segment.part} do not increase", file=plan.file)
    rows = np.column_stack([segment.positions, segment.opening])
    still = (np.diff(rows, axis=0, prepend=rows[:1]) == 0.0).all(axis=1)
    if segment.part == "gripper":  # which takes the time that fingers take
        still[:] = True
    longer = np.where(still & (spans > MAX_PAUSE_S), spans - MAX_PAUSE_S, 0.0)
    return replace(segment, times=segment.times - np.cumsum(longer)) if longer.any() else segment
