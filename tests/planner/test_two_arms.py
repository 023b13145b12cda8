"""Two arms on one body: each picks and places, a body goes from hand to hand, and the judge sees what does not hold."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tamp
from tamp.errors import InputError
from tamp.execution.execute import execute
from tamp.execution.execution_options import ExecutionOptions
from tamp.geometric.robot.states import arm_of
from tamp.geometric.values import Grasp, Reach
from tamp.plan.open import open_plan
from tamp.plan.write import plan_text
from tamp.system.files import find_domain
from tamp.verification.verify import verify
from tests.needs import INSTALLED


def planned(problem: str, seed: int = 0, **more: Any) -> tamp.Solution:
    return tamp.solve(tamp.load_problem(problem, **more), max_time=60.0, seed=seed)


@pytest.fixture(scope="module")
def handed() -> dict[str, Any]:
    solution = planned("two_arms_handover")
    assert solution.solved, solution.explanation
    return json.loads(plan_text(solution))


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The domain without its handover."""
    folder = tmp_path_factory.mktemp("domains")
    text = find_domain("two_arms").read_text(encoding="utf-8")
    (folder / "alone.pddl").write_text(text[: text.index("  (:action handover")] + ")")
    streams = find_domain("two_arms").with_suffix(".streams.pddl").read_text(encoding="utf-8")
    cut = streams.index("  ; Where one arm gives")
    (folder / "alone.streams.pddl").write_text(streams[:cut] + ")")
    return folder / "alone.pddl"


@pytest.mark.parametrize("seed", range(3))
def test_a_bar_goes_from_hand_to_hand_over_a_wall(seed: int) -> None:
    solution = planned("two_arms_handover", seed)
    names = [(action.name, *action.objects) for action in solution.plan]
    assert names == [
        ("pick", "left", "bar"), ("handover", "left", "bar", "right"), ("place", "right", "bar"),
    ]  # fmt: skip
    report = verify(json.loads(plan_text(solution)))
    assert report.holds, report.text()
    assert not report.trusted


def test_no_arm_can_do_it_alone(alone: Path) -> None:
    solution = tamp.solve(
        tamp.load_problem("two_arms_handover", alone), max_time=8.0, seed=0
    )  # fmt: skip
    assert not solution.solved


@pytest.mark.parametrize("engine", INSTALLED)
def test_a_body_is_put_down_by_one_arm_and_taken_by_the_other(engine: str, alone: Path) -> None:
    solution = planned("two_arms_tables", domain=alone)
    taken = [(a.name, a.objects[0]) for a in solution.plan if a.objects[1] == "soup_can"]
    assert taken == [("pick", "left"), ("place", "left"), ("pick", "right"), ("place", "right")]
    report = verify(json.loads(plan_text(solution)), engine=engine)
    assert report.holds, report.text()


def test_both_hold_it_at_once_and_hands_keep_apart() -> None:
    solution = planned("two_arms_handover", 1)
    problem, handover = solution.problem, solution.plan[1]
    giver, _, grasp, taker, other, _, pose, gives, takes, _ = handover.arguments
    values = solution.values
    T_world_body = values[pose].matrix  # type: ignore[attr-defined]
    for arm, held, reach in ((giver, grasp, gives), (taker, other, takes)):
        context, hold, way = problem.context.of_arm(arm), values[held], values[reach]
        assert isinstance(hold, Grasp) and isinstance(way, Reach)
        assert context.robot.arm == arm_of(problem.context.robot, arm).arm
        for joints in (way.approach[-1], way.lift[0]):
            T = context.kinematics.tool(context.conf((0.0, 0.0, 0.0), joints))
            assert pytest.approx(T_world_body, abs=1e-5) == T @ hold.T_tool_body.matrix


def segments(plan: dict[str, Any]) -> list[dict[str, Any]]:
    return [segment for action in plan["actions"] for segment in action["segments"]]


def test_what_is_wrong_with_arms_is_seen(handed: dict[str, Any]) -> None:
    def said(plan: dict[str, Any]) -> set[str]:
        return {violation.kind for violation in verify(plan).violations}

    assert said(handed) == set()

    swapped = copy.deepcopy(handed)  # the other arm makes the motion
    for segment in segments(swapped):
        segment["arm"] = {"left": "right", "right": "left"}[segment["arm"]]
    assert {"state", "grasp"} <= said(swapped)

    early = copy.deepcopy(handed)  # the giver lets go before the taker has it
    grips = [s for s in segments(early)[2:] if s["part"] == "gripper"]
    taker = next(s for s in grips if s.get("attach"))
    del taker["attach"]
    assert "support" in said(early)

    through = copy.deepcopy(handed)  # the giver stays where it is, the taker comes through it
    moved = through["actions"][1]["segments"]
    home = np.array(moved[0]["positions"][0])
    ahead = next(s for s in moved if s["arm"] == "right" and s["part"] == "arm")
    turned = np.array(ahead["positions"])
    turned[1:-1] = home + np.array([1.5, 1.2, 0.0, 1.0, 0.0, 0.0, 0.0])
    ahead["positions"] = turned.tolist()
    assert "collision" in said(through)

    certified = copy.deepcopy(handed)
    fact = next(one for one in certified["certified"] if one[0] == "exchange")
    fact[4] = fact[1]
    assert "certified" in said(certified)


def test_no_hand_draws_back_from_what_two_hold(handed: dict[str, Any]) -> None:
    """The giver's fingers slide off the bar while they are closed: they meet nothing on the way."""
    plan = copy.deepcopy(handed)
    (action,) = (one for one in plan["actions"] if one["name"] == "handover")
    segments = action["segments"]
    opens = next(k for k, one in enumerate(segments) if one.get("detach"))
    (back,) = (k for k in range(opens + 1, len(segments)) if segments[k].get("arm") == "left")
    segments[back] |= {"opening": segments[opens]["opening"][0], "holding": "bar"}
    segments.insert(back, segments.pop(opens))
    said = [one.message for one in verify(plan).violations]
    assert "an arm moves while two hands hold bar" in said


def test_an_arm_that_there_is_not_is_refused(handed: dict[str, Any]) -> None:
    plan = copy.deepcopy(handed)
    segments(plan)[0]["arm"] = "middle"
    with pytest.raises(InputError, match=r"has no arm 'middle'.*left"):
        verify(plan)


def test_a_body_has_no_arms_name(tmp_path: Path) -> None:
    text = Path("problems/two_arms_handover.yaml").read_text(encoding="utf-8")
    (tmp_path / "p.yaml").write_text(text.replace("bar:", "Left:").replace("on bar", "on Left"))
    with pytest.raises(InputError, match="'Left' is the name of one of the robot's arms"):
        tamp.load_problem(tmp_path / "p.yaml")


@pytest.mark.parametrize("engine", INSTALLED)
def test_a_handover_is_carried_out(engine: str, handed: dict[str, Any], tmp_path: Path) -> None:
    plan = tmp_path / "plan.json"
    plan.write_text(json.dumps(handed))
    done = execute(open_plan(plan), ExecutionOptions(grasp="constraint", engine=engine))
    assert done.reached
    assert all(not action.deviations and not action.touches for action in done.actions)


def test_a_robot_of_one_arm_plans_in_the_domain_of_several() -> None:
    solution = planned("bench_one_object", domain=find_domain("two_arms"))
    assert [(a.name, a.objects[0]) for a in solution.plan] == [("pick", "arm"), ("place", "arm")]
    assert verify(json.loads(plan_text(solution))).holds
