"""Two arms on a base that drives: each picks and places, the base drives with what both hold."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tamp
from tamp.execution.execute import execute
from tamp.execution.execution_options import ExecutionOptions
from tamp.plan.open import open_plan
from tamp.plan.write import plan_text
from tamp.simulation.engines import installed
from tamp.verification.verify import verify

ENGINES = [name for name in ("pybullet", "mujoco") if installed(name)]

BOTH = """
name: both
domain: two_arms_driving
robot: {model: two_ur5, base: [0.0, 0.0, 0 deg]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  table: {furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0.0, 0.0], yaw: 90 deg}
  other: {furniture: table, size: [1.2, 0.7, 0.72], at: [-1.6, 0.0, 0.0], yaw: 90 deg}
  third: {furniture: table, size: [0.6, 0.6, 0.72], at: [0.0, 1.9, 0.0]}
  can:   {cylinder: {radius: 0.033, height: 0.102}, on: table, at: [-0.3, 0.1], mass: 0.35}
  cup:   {cylinder: {radius: 0.033, height: 0.102}, on: other, at: [0.3, 0.1], mass: 0.35}
  pot:   {cylinder: {radius: 0.033, height: 0.102}, on: third, at: [0.0, 0.0], mass: 0.35}
goal: (and (exists (?g - grasp) (holding left can ?g)) (exists (?g - grasp) (holding right cup ?g))
           (not (hand-empty left)))
"""


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A plan at whose end both hands hold a body, from tables that are far from each other."""
    folder = tmp_path_factory.mktemp("both")
    (folder / "both.yaml").write_text(BOTH, encoding="utf-8")
    solution = tamp.solve(tamp.load_problem(folder / "both.yaml"), max_time=60.0, seed=0)
    assert solution.solved, solution.explanation
    return tamp.write_plan(solution, folder / "plan.json")


def test_groceries_go_to_the_cupboard_by_either_arm() -> None:
    solution = tamp.solve(tamp.load_problem("two_arms_cupboard"), max_time=60.0, seed=0)
    assert solution.solved, solution.explanation
    assert {action.objects[0] for action in solution.plan if action.name == "pick"} == {
        "left", "right",
    }  # fmt: skip
    report = verify(json.loads(plan_text(solution)))
    assert report.holds and not report.trusted, report.text()


def test_the_base_drives_while_a_hand_holds_something(both: Path) -> None:
    assert verify(both).holds
    actions = json.loads(both.read_text(encoding="utf-8"))["actions"]
    assert [action["name"] for action in actions] == ["move", "pick", "move", "pick"]
    drive = actions[2]["segments"]
    assert {segment["part"] for segment in drive} == {"base"}
    assert {segment["holding"] for segment in drive} & {"can", "cup"}


@pytest.mark.parametrize("engine", ENGINES)
def test_what_both_hands_hold_is_known_in_physics(engine: str, both: Path) -> None:
    done = execute(open_plan(both), ExecutionOptions(grasp="constraint", engine=engine))
    assert done.reached and len(done.goal) == 3
    assert not any(action.displaced or action.deviations for action in done.actions)


def test_the_judge_sees_what_the_other_hand_carries_through_a_table(both: Path) -> None:
    plan: dict[str, Any] = copy.deepcopy(json.loads(both.read_text(encoding="utf-8")))
    drive = plan["actions"][2]["segments"][0]
    rows = np.array(drive["positions"])
    rows[1:-1, :2] = (1.5, 0.0)
    drive["positions"] = rows.tolist()
    report = verify(plan)
    assert not report.holds
    assert {"collision"} & {violation.kind for violation in report.violations}
