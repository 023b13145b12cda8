"""A good plan holds; each way of spoiling it is found out for what it is."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tamp.commands.verify import main
from tamp.plan.violation import KINDS
from tamp.verification.replay import LOOKS_BEYOND, MAX_STATES_AT_FIRST
from tamp.verification.tolerances import tolerances
from tamp.verification.verify import verify
from tests.needs import INSTALLED

Plan = dict[str, Any]


@pytest.fixture(autouse=True, params=INSTALLED)
def engine(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """Each test asks each engine."""
    monkeypatch.setattr("tamp.simulation.engines.default_engine", lambda: request.param)
    return request.param


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


SPOILT: dict[str, tuple[Callable[[Plan], Any], str, str]] = {
    "arm through the table": (lambda p: detour(p, PICK, 0, 1, 0.8), "collision", "right"),
    "base through the table": (lambda p: detour(p, MOVE_LOADED, 0, 0, 0.3), "collision", "base and"),
    "held body through the table": (lambda p: detour(p, MOVE_LOADED, 0, 0, 0.12), "collision", "base and"),
    "arm into itself": (lambda p: detour(p, MOVE_EMPTY, 0, 2, 0.0) or fold(p), "collision", "panda_link"),
    "skipped pick": (lambda p: drop(p, PICK), "precondition", "holding"),
    "skipped move": (lambda p: drop(p, MOVE_LOADED), "precondition", "at-base b2"),
    "skipped place": (lambda p: drop(p, PLACE), "goal", "on block left"),
    "no actions": (lambda p: drop(p, 0, 1, 2, 3) or say("duration", 0.0)(p), "goal", "block"),
    "another pose is claimed": (lambda p: shift(p["values"]["p1"], 0.02), "state", "from p1"),
    "a turned pose is claimed": (lambda p: p["values"]["p1"].update(quaternion=[0, 0, 0.1, 0.995]), "state", "deg"),
    "another place to close": (
        lambda p: shift(segment(p, PICK, 1)["attach"]["T_tool_body"], 0.01), "grasp", "from where"
    ),
    "another grasp is claimed": (lambda p: shift(p["values"]["g1"]["T_tool_body"], 0.005), "state", "otherwise than"),
    "grasp beside the body": (lambda p: shift(p["values"]["g1"]["T_tool_body"], 0.06, 1), "certified", "finger"),
    "fingers not closed": (lambda p: press(p, 0.065), "grasp", "off it"),
    "fingers through the body": (lambda p: press(p, 0.03), "grasp", "in it"),
    "base jumps": (lambda p: shift_rows(p, MOVE_LOADED, 0, 1, 0.1), "continuity", "jumps"),
    "arm jumps": (lambda p: shift_rows(p, PICK, 2, 0, 0.01), "continuity", "jumps"),
    "fingers jump": (lambda p: segment(p, PICK, 0).update(opening=0.06), "continuity", "fingers"),
    "joint limit": (lambda p: detour(p, PICK, 0, 6, 4.0), "limit", "panda_joint7"),
    "out of the room": (lambda p: detour(p, MOVE_EMPTY, 0, 1, -3.0), "limit", "base y"),
    "too fast": (lambda p: retime(p, PICK, 2, lambda t: 0.3 * t), "velocity", "too fast"),
    "too harsh": (constant_speed, "acceleration", "too harsh"),
    "time stands still": (lambda p: retime(p, PICK, 2, lambda t: np.where(t < 1.0, 0.0, t)), "time", "increase"),
    "an action begins early": (lambda p: p["actions"][2].update(start=1.0), "time", "before"),
    "wrong duration": (say("duration", 99.0), "time", "99"),
    "other problem file": (lambda p: p["inputs"]["problem"].update(sha256="0" * 64), "hash", "problem"),
    "other domain file": (lambda p: p["inputs"]["domain"].update(sha256="0" * 64), "hash", "domain"),
    "easier goal": (say("goal", "(on can right)"), "goal", "not the problem's"),
    "reach-clear missing": (lambda p: uncertify(p, "reach-clear"), "precondition", "reach-blocked"),
    "pose-clear missing": (lambda p: uncertify(p, "pose-clear"), "precondition", "pose-blocked"),
    "supported missing": (lambda p: uncertify(p, "supported"), "goal", "follow"),
    "supported by another": (
        lambda p: p["certified"].append(["supported", "block", "p1", "right"]), "certified", "p1 right"
    ),
    "approach-clear missing": (lambda p: uncertify(p, "approach-clear"), "precondition", "approach-blocked"),
    "approach that is not clear": (lambda p: beside(p, "approach-clear", "g1"), "certified", "the hand is"),
    "approach into the table": (lambda p: sunk(p), "certified", "mm in left"),
    "reach that is not clear": (lambda p: beside(p, "reach-clear", "g1", "b2", "q2"), "certified", "panda_"),
    "goal as certified": (lambda p: p["certified"].append(["on", "block", "left"]), "certified", "rules decide"),
    "fluent as certified": (lambda p: p["certified"].append(["at-pose", "block", "p1"]), "certified", "decide"),
    "poses that collide": (
        lambda p: p["certified"].append(["pose-clear", "block", "p1", "can", "p1"]), "certified", "penetrate"
    ),
    "unreachable kin": (lambda p: p["values"]["b2"].update(base=[0.2, 0.7, 0.0]), "certified", "kin"),
    "base elsewhere": (lambda p: p["values"]["b1"].update(base=[0.25, 0.0, 0.0]), "state", "base"),
    "starts elsewhere": (lambda p: shift(p["values"]["can_start"], 0.05), "initial", "can"),
    "base starts elsewhere": (lambda p: p["values"]["base_start"].update(base=[0.1, 0, 0]), "initial", "base"),
    "forgets a body": (lambda p: p["initial"].remove(["at-pose", "can", "can_start"]), "initial", "0 poses"),
    "two starts": (lambda p: p["initial"].append(["at-pose", "block", "p1"]), "initial", "2 poses"),
    "invents a start": (lambda p: p["initial"].append(["holding", "can", "g1"]), "initial", "imply"),
    "calls a table movable": (lambda p: p["objects"].update(left=["movable", "surface"]), "initial", "movable"),
    "invents a body": (lambda p: p["objects"].update(ghost=["movable"]), "initial", "ghost"),
    "let go in the air": (stop_early, "support", "block"),
    "holds nothing, it says": (lambda p: segment(p, MOVE_LOADED, 0).update(holding=None), "continuity", "says"),
    "never lets go": (lambda p: segment(p, PLACE, 1).pop("detach"), "state", "hand"),
    "takes another body": (lambda p: segment(p, PICK, 1)["attach"].update(body="can"), "grasp", "can"),
    "unknown action": (lambda p: p["actions"][0].update(name="fly"), "precondition", "fly"),
    "wrong types": (lambda p: p["actions"][0].update(arguments=["block", "t1"]), "precondition", "base-conf"),
    "does not open": (
        lambda p: segment(p, PLACE, 1).update(opening=[0.05, 0.05]) or segment(p, PLACE, 2).update(opening=0.05),
        "grasp", "do not open",
    ),
    "a mesh of another problem": (
        lambda p: p["inputs"].update(meshes=[{"path": "/mug.obj", "sha256": "0" * 64}]), "hash", "mug.obj"
    ),
    "another motion is claimed": (
        lambda p: p["values"]["t3"]["segments"][0]["points"][-1].__setitem__(0, 0.5), "state", "off its motion"
    ),
    "a motion of other parts": (lambda p: p["values"]["t2"]["segments"].pop(), "state", "not those"),
    "wrong sum of costs": (say("cost", 1.0), "state", "cost"),
    "base in two places": (lambda p: p["initial"].append(["at-base", "b1"]), "initial", "2 times"),
    "thrown far away": (lambda p: shift_rows(p, MOVE_EMPTY, 0, 0, 1e9), "continuity", "jumps"),
    "wrong cost": (lambda p: p["actions"][0].update(cost=0.0), "state", "costs"),
    "another robot": (say("robot", "r2d2"), "initial", "r2d2"),
}  # fmt: skip


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


def test_a_good_plan_holds(plan: Plan) -> None:
    report = verify(plan)
    assert report.holds, report.text()
    assert report.actions == 4 and report.states > 500 and not report.trusted
    assert "holds: 4 actions" in report.text()


CAN = "can:    {cylinder: {radius: 0.03, height: 0.1}, on: right, at: [-0.05, 0.25]}"


def test_what_carries_another_body_must_stay(plan_for: Callable[[str, str], Plan]) -> None:
    small = "can:    {cylinder: {radius: 0.02, height: 0.04}, on: block, at: [0.0, 0.0]}"
    report = verify(plan_for(CAN, small))
    found = {(violation.kind, *violation.bodies) for violation in report.violations}
    assert ("support", "can") in found, report.text()
    assert ("collision", "panda_hand", "can") in found


def test_a_body_that_stands_close_is_no_collision(plan_for: Callable[[str, str], Plan]) -> None:
    beside = "can:    {cylinder: {radius: 0.03, height: 0.1}, on: right, at: [-0.1, 0.0715]}"
    report = verify(plan_for(CAN, beside))
    assert {violation.kind for violation in report.violations} <= {"collision", "certified"}
    assert not any(
        "block" in violation.bodies
        for violation in report.violations
        if violation.kind == "collision"
    )


def test_a_body_that_floats_by_the_problem_is_only_noted(
    plan_for: Callable[[str, str], Plan],
) -> None:
    floating = "can:    {cylinder: {radius: 0.03, height: 0.1}, pose: {position: [-1.5, 0, 1]}}"
    report = verify(plan_for(CAN, floating).copy() | {})
    assert any("can stands on nothing" in note for note in report.notes)
    assert not [violation for violation in report.violations if violation.kind == "support"]


@pytest.mark.parametrize("name", SPOILT)
def test_a_spoilt_plan_is_rejected(plan: Plan, name: str) -> None:
    spoil, kind, fragment = SPOILT[name]
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


def test_a_base_that_turned_often_is_judged_where_it_is(plan: Plan) -> None:
    spun = segment(plan, MOVE_LOADED, 0)
    rows = np.array(spun["positions"])
    rows[:, 0] += 0.12 * np.sin(np.linspace(0, np.pi, len(rows))) ** 2
    for whole in (0, 40):  # 40 turns are 251 rad
        turned = rows.copy()
        turned[:, 2] += 2 * np.pi * whole
        spun["positions"] = turned.tolist()
        retime(plan, MOVE_LOADED, 0, lambda times: 10 * times)
        assert any(one.kind == "collision" for one in verify(plan).violations), whole


def test_a_plan_far_beyond_the_limits_gets_its_verdict_soon(plan: Plan) -> None:
    wild = segment(plan, PICK, 0)
    rows = [[5.0 * (-1) ** k] * 7 for k in range(2000)]
    wild["positions"] = [wild["positions"][0], *rows, wild["positions"][-1]]
    wild["times"] = np.linspace(0.0, 40_000.0, len(wild["positions"])).tolist()
    report = verify(plan)
    assert any(one.kind == "limit" for one in report.violations)
    assert report.states < 20_000


def test_a_motion_longer_than_the_judge_looks_at_does_not_hold(plan: Plan) -> None:
    long = segment(plan, MOVE_LOADED, 0)
    start, end = np.array(long["positions"][0]), np.array(long["positions"][-1])
    # To and fro in the free part of the room, ever turning.
    wild = [[start[0] - 0.5 * (k % 2), start[1], 2000.0 * k] for k in range(60)]
    long["positions"] = [start.tolist(), *wild[1:], end.tolist()]
    long["times"] = [2100.0 * k for k in range(len(long["positions"]))]
    long["times"][-1] += 2e5
    report = verify(plan)
    assert any(one.kind == "unchecked" for one in report.violations)


def test_the_makers_limits_bind_and_not_the_urdfs(plan: Plan) -> None:
    rows = np.array(segment(plan, PICK, 0)["positions"])
    detour(plan, PICK, 0, 1, -1.80 - float(rows[len(rows) // 2, 1]))
    worst = [one.message for one in verify(plan).violations if one.kind == "limit"]
    assert worst and worst[0].startswith("panda_joint2 is out of range: -1.8")


def test_fingers_faster_than_the_hands_own_are_noticed(plan: Plan) -> None:
    retime(
        plan, PICK, 1, lambda times: 0.5 * times
    )  # 30 mm in a quarter of a second; the hand opens 100 mm a second
    assert any(
        one.kind == "velocity" and "opening" in one.message for one in verify(plan).violations
    )


def test_the_tolerances_are_said_in_the_help_and_in_the_documentation(
    root: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end:
        main(["--help"])
    assert not end.value.code
    said, written = (
        capsys.readouterr().out,
        (root / "docs" / "how-it-works.md").read_text(encoding="utf-8"),
    )
    rows = tolerances()
    assert len(rows) > 8
    for what, much in rows:
        assert what in said and much in said
        assert f"| {what} | {much} |" in written
    assert f"{MAX_STATES_AT_FIRST:,} states" in written and f"{LOOKS_BEYOND:,}" in written
