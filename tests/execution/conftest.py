"""A plan of four actions for one can, and the same with a box beside it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tamp.execution.expected import Expected
from tamp.plan.open import PlanBundle, open_plan
from tamp.plan.read import Hold, Value
from tamp.plan.write import write_plan
from tamp.planner.problem import load_problem
from tamp.planner.solve import solve
from tests.execution.cup import DOMAIN, GOAL, GRASP, SCENE, START
from tests.plan.making import plan_of

PROBLEM = """\
name: short_way
domain: cupboard
robot: {model: panda_mobile, base: [0.0, 0.4, 0.0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  left:   {furniture: table, size: [0.6, 0.7, 0.5], at: [0.95, 0.8, 0.0]}
  right:  {furniture: table, size: [0.6, 0.7, 0.5], at: [0.95, 0.0, 0.0]}
  Can:    {cylinder: {radius: 0.03, height: 0.1}, on: right, at: [-0.1, 0.1], mass: 0.3}
  block:  {box: [0.05, 0.05, 0.12], on: right, at: [0.15, -0.2], mass: 0.3}
goal: (on Can left)
"""


@pytest.fixture(scope="session")
def plan_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("execution")
    (folder / "short_way.yaml").write_text(PROBLEM)
    return write_plan(solve(load_problem(folder / "short_way.yaml"), seed=1), folder / "plan.json")


@pytest.fixture
def stored(plan_file: Path) -> PlanBundle:
    return open_plan(plan_file)


@pytest.fixture
def expected() -> Expected:
    """A cup that a plan takes from the table into the crate."""
    plan = plan_of(
        values={
            "p0": Value("pose", START),
            "p1": Value("pose", GOAL),
            "g": Value("grasp", Hold("cup", GRASP, 0.05)),
        },
        initial=[("at-pose", "cup", "p0"), ("hand-empty",), ("supported", "cup", "p0", "table")],
        certified=[("contained", "cup", "p1", "crate_inside")],
    )
    objects = {"cup": ("movable",), "table": ("surface",), "crate_inside": ("container",)}
    return Expected(replace(plan, objects=objects), DOMAIN, SCENE)
