"""A room anywhere in the world: what holds at the origin holds there, in plans, for the judge and in physics."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tamp.commands.solve import run
from tamp.geometric.loading.load import load_scene
from tamp.plan.write import plan_document
from tamp.planner.problem import load_problem
from tamp.planner.solve import solve
from tamp.simulation.engines import open_world
from tamp.verification.verify import verify

FLAT = """\
domain: cupboard
robot: {{model: panda_mobile, base: [{x}, {y}, 180 deg]}}
room: {{x: [{x0}, {x1}], y: [{y0}, {y1}]}}
bodies:
  table: {{furniture: table, size: [1.2, 0.7, 0.5], at: [{tx}, {y}, 0.0], yaw: 90 deg}}
  can: {{cylinder: {{radius: 0.03, height: 0.2}}, on: floor, at: [{cx}, {y}]}}
goal: (on can table)
"""


def scene_at(folder: Path, x: float, y: float) -> Path:
    file = folder / "room.yaml"
    room = {"x0": x - 2.5, "x1": x + 2.5, "y0": y - 2.5, "y1": y + 2.5}
    file.write_text(FLAT.format(x=x, y=y, tx=x + 1.6, cx=x - 1.3, **room))
    return file


@pytest.mark.parametrize(("x", "y"), [(500.0, -300.0), (-20_000.0, 45_000.0)])
def test_a_plan_far_from_the_origin_holds(tmp_path: Path, x: float, y: float) -> None:
    problem = load_problem(scene_at(tmp_path, x, y))
    solution = solve(problem, max_time=60.0, seed=0)
    assert solution.solved and len(solution.plan) == 4, solution.explanation
    report = verify(plan_document(solution))
    assert report.holds, report.violations


def test_the_floor_is_under_the_room(tmp_path: Path) -> None:
    scene = load_scene(scene_at(tmp_path, 500.0, -300.0)).scene
    with open_world(scene, dynamic=True) as world:
        before = world.pose("can")
        world.step(1.0)
        after = world.pose("can")
    assert np.abs(after - before).max() < 0.003


def test_a_plan_two_kilometres_out_is_carried_out(tmp_path: Path) -> None:
    file, out = scene_at(tmp_path, 2000.0, -300.0), tmp_path / "plan.json"
    assert run([str(file), "--time", "60", "--execute", "--quiet", "--out", str(out)]) == 0
