"""Robots of one's own, from the URDF to a plan that the judge accepts and physics carries out."""

from __future__ import annotations

from pathlib import Path

import pytest

import tamp
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


@pytest.mark.parametrize("name", ["driving", "lifting", "five"])
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
