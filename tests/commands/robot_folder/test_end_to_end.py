"""Robots of one's own, from the URDF to a plan that the judge accepts and physics carries out."""

from __future__ import annotations

import hashlib
import shutil
from pathlib import Path

import pytest

import tamp
from tamp.errors import InputError
from tamp.execution.execute import ExecutionOptions, execute
from tamp.plan.open import open_plan
from tamp.verification.verify import verify

BENCH = """
name: bench
domain: cupboard
robot: {{model: {robot}, base: [0.0, 0.0, 0 deg]}}
room: {{x: [-2.0, 2.0], y: [-2.0, 2.0]}}
bodies:
  table:  {{furniture: table, size: [0.8, 0.5, 0.5], at: [0.3, 0.0, 0.0], yaw: 90 deg}}
  shelf:  {{furniture: table, size: [0.5, 0.3, 0.55], at: [0.15, 0.6, 0.0]}}
  can:    {{cylinder: {{radius: 0.03, height: 0.1}}, on: table, at: [-0.15, -0.1], mass: 0.3}}
goal: (on can shelf)
"""


@pytest.mark.parametrize("name", ["driving", "steered", "lifting", "five"])
def test_a_robot_of_ones_own_solves_a_shipped_problem(
    name: str, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    robot = request.getfixturevalue(name)
    problem = tamp.load_problem("one_object", robot=robot)
    solution = tamp.solve(problem, max_time=60.0, seed=0)
    assert solution.solved
    plan = tmp_path / "plan.json"
    tamp.write_plan(solution, plan)
    report = verify(plan)
    assert report.holds, report.text()
    assert any("given beside the problem" in note for note in report.notes)
    assert execute(open_plan(plan), ExecutionOptions(grasp="constraint")).reached


def test_what_a_base_cannot_drive_is_neither_planned_nor_judged_good(
    steered: Path, driving: Path, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=r"cannot move by 'se2'.*Choices: reeds-shepp"):
        tamp.load_problem("one_object", robot=steered, steering="se2")
    with pytest.raises(InputError, match=r"cannot move by 'se2'.*differential, reeds-shepp"):
        tamp.load_problem("one_object", robot=driving, steering="se2")

    # The same robot, but for what its base can do: its plan turns on the spot.
    car, plan = tmp_path / "boxes", tmp_path / "plan.json"
    shutil.copytree(driving, car)
    solution = tamp.solve(tamp.load_problem("one_object", robot=car), max_time=60.0, seed=0)
    tamp.write_plan(solution, plan)
    assert verify(plan).holds
    told = (car / "robot.yaml").read_text(encoding="utf-8")
    as_car = told.replace("drive: differential", "drive: car\n  turning_radius: 0.7")
    (car / "robot.yaml").write_text(as_car, encoding="utf-8")
    old, new = (hashlib.sha256(text.encode()).hexdigest() for text in (told, as_car))
    forged = plan.read_text(encoding="utf-8").replace(old, new)
    plan.write_text(forged, encoding="utf-8")
    report = verify(plan)
    assert not report.holds and "it is a car" in report.text()


def test_a_bolted_arm_never_moves_its_base(bolted: Path, tmp_path: Path) -> None:
    file = tmp_path / "bench.yaml"
    file.write_text(BENCH.format(robot=bolted), encoding="utf-8")
    problem = tamp.load_problem(file)
    solution = tamp.solve(problem, max_time=60.0, seed=0)
    assert solution.solved
    plan = tmp_path / "plan.json"
    tamp.write_plan(solution, plan)
    assert verify(plan).holds
    bases = [s for action in solution.plan for s in action.trajectory.segments if s.part == "base"]
    assert all((s.positions == s.positions[0]).all() for s in bases)
