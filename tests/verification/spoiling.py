"""Ways of spoiling the plan made by hand."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from typing import Any

import numpy as np

from tamp.plan.violation import KINDS
from tamp.verification.verify import verify

Plan = dict[str, Any]
Spoilt = tuple[Callable[[Plan], Any], str, str]
"""What spoils it, the kind of the violation, and a part of what is said."""

MOVE_EMPTY, PICK, MOVE_LOADED, PLACE = range(4)


def segment(plan: Plan, action: int, at: int) -> dict[str, Any]:
    return plan["actions"][action]["segments"][at]


def shift(pose: dict[str, list[float]], by: float, axis: int = 0) -> None:
    pose["position"][axis] += by


def retime(plan: Plan, action: int, at: int, times: Callable[[np.ndarray], np.ndarray]) -> None:
    """New times for a segment; all that follows moves along."""
    changed = segment(plan, action, at)
    changed["times"] = times(np.array(changed["times"])).tolist()
    clock = 0.0
    for one in plan["actions"]:
        one["start"] = clock
        one["duration"] = sum(s["times"][-1] for s in one["segments"])
        clock += one["duration"]
    plan["duration"] = clock


def detour(plan: Plan, action: int, at: int, column: int, by: float) -> None:
    """The segment swings aside and comes back, slowly."""
    rows = np.array(segment(plan, action, at)["positions"])
    rows[:, column] += by * np.sin(np.linspace(0, np.pi, len(rows))) ** 2
    segment(plan, action, at)["positions"] = rows.tolist()
    retime(plan, action, at, lambda times: 10 * times)


def drop(plan: Plan, *actions: int) -> None:
    plan["actions"] = [action for at, action in enumerate(plan["actions"]) if at not in actions]
    plan["cost"] = float(len(plan["actions"]))
    if plan["actions"]:
        retime(plan, 0, 0, lambda times: times)


def uncertify(plan: Plan, predicate: str) -> None:
    before = len(plan["certified"])
    plan["certified"] = [fact for fact in plan["certified"] if fact[0] != predicate]
    assert len(plan["certified"]) < before


def stop_early(plan: Plan) -> None:
    """Let go of the block 6 cm above the table."""
    down, up = segment(plan, PLACE, 0), segment(plan, PLACE, 2)
    keep = len(down["times"]) - 2 * 16
    for key in ("times", "positions"):
        down[key] = down[key][:keep]
    up["positions"] = up["positions"][2 * 16 :]
    up["times"] = (np.array(up["times"][2 * 16 :]) - up["times"][2 * 16]).tolist()
    retime(plan, PLACE, 0, lambda times: times)


def constant_speed(plan: Plan) -> None:
    rows = segment(plan, MOVE_EMPTY, 0)["positions"]
    rows[:] = np.linspace(rows[0], rows[-1], len(rows)).tolist()


def press(plan: Plan, width: float) -> None:
    """The fingers close to another width, consistently."""
    segment(plan, PICK, 1)["opening"] = [0.08, width]
    segment(plan, PLACE, 1)["opening"] = [width, 0.08]
    plan["values"]["g1"]["opening"] = width
    for action, at in ((PICK, 2), (MOVE_LOADED, 0), (PLACE, 0)):
        segment(plan, action, at)["opening"] = width


def say(key: str, value: Any) -> Callable[[Plan], None]:
    return lambda plan: plan.update({key: value})


def shift_rows(plan: Plan, action: int, at: int, column: int, by: float) -> None:
    rows = np.array(segment(plan, action, at)["positions"])
    rows[:, column] += by * np.linspace(1, 0, len(rows))
    segment(plan, action, at)["positions"] = rows.tolist()


def fold(plan: Plan) -> None:
    detour(plan, PLACE, 2, 3, -1.2)
    detour(plan, PLACE, 2, 5, 2.0)
    detour(plan, PLACE, 2, 1, -0.9)


def beside(plan: Plan, predicate: str, *values: str) -> None:
    """Claim that the way to the block is clear of a can where a finger goes."""
    plan["values"]["p2"] = copy.deepcopy(plan["values"]["p1"])
    shift(plan["values"]["p2"], 0.07, 1)
    plan["certified"].append([predicate, "block", "p1", *values, "can", "p2"])


def sunk(plan: Plan) -> None:
    """Claim that the hand fits into the table."""
    plan["values"]["low"] = copy.deepcopy(plan["values"]["p1"])
    shift(plan["values"]["low"], -0.1, 2)
    plan["certified"].append(["approach", "block", "low", "g1"])


def rejected(plan: Plan, spoilt: Spoilt) -> None:
    """Check that the judge finds the spoilt plan out for what it is."""
    spoil, kind, fragment = spoilt
    before = json.dumps(plan)
    spoil(plan)
    assert json.dumps(plan) != before
    report = verify(plan)
    assert not report.holds
    assert {violation.kind for violation in report.violations} <= set(KINDS)
    found = [
        violation
        for violation in report.violations
        if violation.kind == kind and fragment in str(violation)
    ]
    assert found, report.text()
    assert kind in report.text()
