"""What goes wrong while a plan is carried out is found out for what it is."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from tamp.verification.replay import SEGMENT_JUMP, TIME_TOLERANCE_S
from tamp.verification.verify import verify
from tests.verification.spoiling import (
    MOVE_EMPTY,
    MOVE_LOADED,
    PICK,
    PLACE,
    Plan,
    Spoilt,
    constant_speed,
    detour,
    drop,
    fold,
    press,
    rejected,
    retime,
    say,
    segment,
    shift,
    shift_rows,
    stop_early,
    uncertify,
)

pytestmark = pytest.mark.usefixtures("each_engine")

CAN = "can:    {cylinder: {radius: 0.03, height: 0.1}, on: right, at: [-0.05, 0.25]}"

SPOILT: dict[str, Spoilt] = {
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
    "reach-clear missing": (lambda p: uncertify(p, "reach-clear"), "precondition", "reach-blocked"),
    "pose-clear missing": (lambda p: uncertify(p, "pose-clear"), "precondition", "pose-blocked"),
    "supported missing": (lambda p: uncertify(p, "supported"), "goal", "follow"),
    "approach-clear missing": (lambda p: uncertify(p, "approach-clear"), "precondition", "approach-blocked"),
    "base elsewhere": (lambda p: p["values"]["b1"].update(base=[0.25, 0.0, 0.0]), "state", "base"),
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
    "another motion is claimed": (
        lambda p: p["values"]["t3"]["segments"][0]["points"][-1].__setitem__(0, 0.5), "state", "off its motion"
    ),
    "a motion of other parts": (lambda p: p["values"]["t2"]["segments"].pop(), "state", "not those"),
    "wrong sum of costs": (say("cost", 1.0), "state", "cost"),
    "thrown far away": (lambda p: shift_rows(p, MOVE_EMPTY, 0, 0, 1e9), "continuity", "jumps"),
    "wrong cost": (lambda p: p["actions"][0].update(cost=0.0), "state", "costs"),
    "one argument less": (lambda p: p["actions"][0]["arguments"].pop(), "precondition", "takes 2 arguments"),
    "lets another go": (lambda p: segment(p, PLACE, 1).update(detach="can"), "grasp", "does not hold can"),
    "takes the table": (lambda p: segment(p, PICK, 1)["attach"].update(body="left"), "grasp", "cannot be moved"),
    "an action that lasts longer": (lambda p: p["actions"][1].update(duration=99.0), "time", "not 99.000 s"),
    "times that begin late": (lambda p: retime(p, PICK, 0, lambda t: t + 0.1), "time", "do not start at 0"),
}  # fmt: skip


@pytest.mark.parametrize("name", SPOILT)
def test_a_spoilt_plan_is_rejected(plan: Plan, name: str) -> None:
    rejected(plan, SPOILT[name])


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


def test_what_differs_by_half_of_a_tolerance_is_nothing(plan: Plan) -> None:
    shift_rows(plan, MOVE_LOADED, 0, 1, 0.5 * SEGMENT_JUMP)
    segment(plan, PICK, 0)["opening"] -= 0.5 * SEGMENT_JUMP
    plan["duration"] += 0.5 * TIME_TOLERANCE_S
    plan["actions"][2]["start"] -= 0.5 * TIME_TOLERANCE_S
    plan["cost"] += 5e-7
    report = verify(plan)
    assert report.holds, report.text()


def test_what_hand_and_body_touch_by_nature_is_no_collision(plan: Plan) -> None:
    """The fingers at the block, the block on its table before and after: of these pairs none."""
    report = verify(plan)
    assert report.holds and report.nearest is None  # nothing else comes within 2 cm
