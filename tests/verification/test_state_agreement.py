"""The facts after each action are compared with where bodies, base and hand are: what differs is said."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box
from tamp.plan.read import Hold, PlanFile, Value
from tamp.symbolic.pddl.parser import parse_domain
from tamp.system.files import find_domain
from tamp.verification.execution_state import ExecutionState, Held
from tamp.verification.semantics import State
from tamp.verification.state_agreement import Agreement
from tamp.verification.violation_log import ViolationLog
from tests.geometric.making import body, scene, table
from tests.plan.making import arm, base, plan_of

ROBOT = ROBOTS["panda_mobile"]()
DOMAIN = parse_domain(find_domain("cupboard").read_text(encoding="utf-8"))
AT = Pose((0.1, 0.0, 0.55)).matrix
SCENE = scene(table(), body("Cup", Box((0.1, 0.1, 0.1)), (0.1, 0.0, 0.55)))
HOLD = Hold("cup", Pose((0.0, 0.0, 0.1)).matrix, 0.05)
VALUES = {
    "p": Value("pose", AT),
    "b": Value("base-conf", np.array([0.0, -2.0, 0.0])),
    "g": Value("grasp", HOLD),
}
START = {("at-pose", "cup", "p"), ("at-base", "b"), ("hand-empty",)}
CARRIED = {("holding", "cup", "g"), ("at-base", "b")}


def agreement(plan: PlanFile | None = None, at: np.ndarray = AT) -> tuple[Agreement, ViolationLog]:
    world: Any = SimpleNamespace(scene=SCENE, pose=lambda name: at)
    log = ViolationLog()
    return Agreement(plan or plan_of(values=VALUES), world, ROBOT, DOMAIN, log), log


def said(facts: set[tuple[str, ...]], held: Held | None = None, **more: Any) -> list[str]:
    compared, log = agreement(**more)
    row = np.array([0.0, -2.0, 0.0, *[0.0] * 7, 0.05])
    compared.compare(State.of(facts), ExecutionState(row, {} if held is None else {0: held}, 0.0))
    assert all(one.kind == "state" for one in log.violations)
    return [one.message for one in log.violations]


def test_what_agrees_is_silent_in_the_hand_and_on_the_table() -> None:
    assert said(START) == []
    assert said(CARRIED, Held("Cup", HOLD.T_tool_body)) == []


@pytest.mark.parametrize(
    ("facts", "message"),
    [
        (START - {("at-pose", "cup", "p")}, "by the facts Cup is nowhere"),
        (START | {("at-pose", "cup", "b")}, "by the facts Cup is in 2 places"),
        (START - {("at-base", "b")}, "by the facts the base is in 0 places"),
        ((START - {("at-base", "b")}) | {("at-base", "p")}, "the base is not at p"),
        (START - {("hand-empty",)}, "the hand is empty, the facts differ"),
        (START | {("holding", "cup", "g")}, "cup is not in the hand by g"),
    ],
)
def test_facts_that_the_scene_denies_are_named(facts: set[tuple[str, ...]], message: str) -> None:
    assert message in said(facts)


@pytest.mark.parametrize(("metres", "wrong"), [(0.0009, False), (0.0011, True)])
def test_a_body_may_be_off_its_pose_by_a_millimetre(metres: float, wrong: bool) -> None:
    told = said(START, at=Pose((metres, 0.0, 0.0)).matrix @ AT)
    assert bool(told) is wrong
    assert all("cup" in text.lower() for text in told)


@pytest.mark.parametrize("metres", [0.0, 0.002])
def test_a_grasp_is_compared_with_how_the_body_is_held(metres: float) -> None:
    T_tool_body = Pose((metres, 0.0, 0.0)).matrix @ HOLD.T_tool_body
    told = said(CARRIED, Held("Cup", T_tool_body))
    expected = ["cup is held otherwise than g says: 2.0 mm, 0.0 deg, fingers 0.0 mm"]
    assert told == (expected if metres else [])


def test_what_is_held_is_at_no_pose() -> None:
    told = said(CARRIED | {("at-pose", "cup", "p")}, Held("Cup", HOLD.T_tool_body))
    assert "cup is in the hand, not at p" in told
    assert "by the facts Cup is not in the hand" in told


ROWS = np.array([[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]])


@pytest.mark.parametrize(
    ("stretches", "message"),
    [
        ((("base", ROWS),), None),
        ((("base", ROWS + np.array([0.0, 0.0, 2 * np.pi])),), None),
        (
            (("base", ROWS + np.array([0.01, 0.0, 0.0])),),
            "its segment 1 is 0.01 (m, rad) off its motion",
        ),
        ((("arm", np.zeros((2, 7))),), "its segments are not those of its motion"),
        ((), "its segments are not those of its motion"),
    ],
)
def test_an_action_does_what_its_motion_says(stretches: Any, message: str | None) -> None:
    plan = plan_of(
        ("move", ("b", "t"), [base([0, 1], ROWS.tolist())]),
        values={**VALUES, "t": Value("motion", tuple((*one, None) for one in stretches))},
    )
    compared, log = agreement(plan)
    compared.follows(plan.actions[0])
    assert {one.message for one in log.violations} == ({message} if message else set())


def test_an_action_without_a_motion_is_not_compared() -> None:
    plan = plan_of(("wave", ("b",), [arm([0, 1], [np.zeros(7), np.ones(7)])]), values=VALUES)
    compared, log = agreement(plan)
    compared.follows(plan.actions[0])
    assert log.violations == []
