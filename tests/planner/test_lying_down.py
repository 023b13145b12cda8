"""A thing that stands has to lie where it cannot stand: the planner lays it down, and the judge agrees."""

from __future__ import annotations

from pathlib import Path

from tamp.plan.write import plan_document
from tamp.planner.problem import load_problem
from tamp.planner.solve import solve
from tamp.verification.verify import verify

SHELF = """\
domain: cupboard
robot: {model: panda_mobile, base: [0.0, 0.0, 0.0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  table: {furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0.0, 0.0], yaw: 90 deg}
  shelf: {furniture: shelf, size: [0.9, 0.42, 0.93], compartments: 3, plinth: 0.4, at: [-1.6, 0.0, 0.0], yaw: 90 deg}
  can: {cylinder: {radius: 0.028, height: 0.19}, on: table, at: [0.0, 0.1]}
goal: (on can shelf_2)
"""


def test_a_can_too_tall_for_a_board_is_laid_on_its_side(tmp_path: Path) -> None:
    file = tmp_path / "scene.yaml"
    file.write_text(SHELF, encoding="utf-8")
    solution = solve(load_problem(file), max_time=120.0, seed=0)
    assert solution.solved, solution.explanation
    report = verify(plan_document(solution))
    assert report.holds, report.violations
