"""Plans made by hand from segments, without a file, and the least that a plan file may say."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from tamp.geometric.scene.pose import Array, Pose
from tamp.plan.read import Hold, PlanFile, StoredSegment, TimedAction, Value
from tamp.symbolic.pddl.structs import Fact

OPEN = 0.08
"""Metres between the fingers."""


def base(
    times: Sequence[float],
    rows: Sequence[Sequence[float]],
    opening: float = OPEN,
    holding: str | None = None,
) -> StoredSegment:
    """The base through rows of x, y, yaw."""
    return StoredSegment(
        "base", np.array(times, float), np.array(rows, float), np.full(len(times), opening), holding
    )


def arm(
    times: Sequence[float], rows: Sequence[Array], opening: float = OPEN, holding: str | None = None
) -> StoredSegment:
    """The arm through rows of seven angles."""
    return StoredSegment(
        "arm", np.array(times, float), np.array(rows, float), np.full(len(times), opening), holding
    )


def close(
    body: str, width: float = 0.05, seconds: float = 0.5, T_tool_body: Array | None = None
) -> StoredSegment:
    """The fingers close on a body."""
    hold = Hold(body, Pose().matrix if T_tool_body is None else T_tool_body, width)
    return StoredSegment(
        "gripper", np.array([0.0, seconds]), np.empty((2, 0)), np.array([OPEN, width]), attach=hold
    )


def let_go(body: str, width: float = 0.05, seconds: float = 0.5) -> StoredSegment:
    """The fingers open and let a body go."""
    return StoredSegment(
        "gripper", np.array([0.0, seconds]), np.empty((2, 0)), np.array([width, OPEN]), detach=body
    )


def plan_of(
    *actions: tuple[str, tuple[str, ...], Sequence[StoredSegment]],
    values: Mapping[str, Value] | None = None,
    initial: Sequence[Fact] = (),
    certified: Sequence[Fact] = (),
) -> PlanFile:
    """Actions of a name, arguments and segments, one after the other without a break."""
    clock, timed = 0.0, []
    for name, arguments, segments in actions:
        lasts = sum(float(segment.times[-1]) for segment in segments)
        timed.append(TimedAction(name, arguments, clock, lasts, 1.0, tuple(segments)))
        clock += lasts
    return PlanFile(
        file=None, sources=(), robot="panda_mobile", objects={}, initial=tuple(initial), goal="(and)",
        values=values or {}, actions=tuple(timed), certified=tuple(certified), cost=float(len(timed)), duration=clock,
    )  # fmt: skip


def moved(plan: Path, folder: Path) -> tuple[Path, Path]:
    """The plan as if made from a problem file that the test may change."""
    document = json.loads(plan.read_text(encoding="utf-8"))
    problem = folder / "mine.yaml"
    problem.write_bytes(Path(document["inputs"]["problem"]["path"]).read_bytes())
    document["inputs"]["problem"]["path"] = str(problem)
    file = folder / "moved.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    return file, problem


SHA = "0" * 64
DOCUMENT = {
    "format": "tamp-plan", "version": 1, "inputs": {"problem": {"path": "p.yaml", "sha256": SHA},
    "domain": {"path": "d.pddl", "sha256": SHA}}, "robot": "panda_mobile", "objects": {"cup": ["movable"]},
    "initial": [], "goal": "(and)", "values": {}, "actions": [], "certified": [], "cost": 0.0, "duration": 0.0,
}  # fmt: skip
