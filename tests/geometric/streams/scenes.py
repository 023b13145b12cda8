"""Small scenes for the tests of the streams."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np

from tamp.planner.problem import Problem, load_problem
from tamp.planner.solve import solve
from tamp.stream import Call, Rejection
from tamp.symbolic.algorithms.result import Outcome
from tamp.system.deadline import Deadline
from tests.needs import MESHES

THINGS = {
    "box": "box: [0.045, 0.09, 0.175]",
    "can": "cylinder: {radius: 0.033, height: 0.102}",
    "mug": "mesh: objects/mug.urdf, scale: 0.85",
    "duck": f"mesh: {MESHES}/duck_vhacd.obj, scale: 0.03",
    "lego": f"mesh: {MESHES}/lego/lego.urdf",
    "mustard": "mesh: objects/mustard_bottle.obj",
    "bowl": "mesh: objects/bowl.obj",
    "blob": f"mesh: {MESHES}/random_urdfs/007/007.urdf, scale: 0.7",
}

SCENE = """
domain: cupboard
robot: {{model: panda_mobile, base: [0.0, 0.0, 0.0]}}
room: {{x: [-2.5, 2.5], y: [-2.5, 2.5]}}
bodies:
  table: {{furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0.0, 0.0], yaw: 80 deg}}
  cupboard: {{furniture: cupboard, size: [0.9, 0.42, 1.0], compartments: 2, at: [-1.6, 0.4, 0.0], yaw: 100 deg}}
  lamp: {{cylinder: {{radius: 0.08, height: 0.4}}, on: table, at: [0.1, 0.1], fixed: true, surfaces: {{}}}}
  {name}: {{{shape}, on: table, at: [-0.3, 0.0], yaw: 30 deg}}
goal: (on {name} cupboard_top)
"""


def problem_with(name: str, folder: Path, shape: str | None = None) -> Problem:
    """One thing on a table with a lamp, and a cupboard of two compartments."""
    path = folder / f"{name}.yaml"
    path.write_text(SCENE.format(name=name, shape=shape or THINGS[name]), encoding="utf-8")
    return load_problem(path)


def call(seed: int = 0) -> Call:
    return Call(np.random.default_rng(seed), Deadline(math.inf))


def values(tries: object, count: int, most: int = 2000) -> list:
    """The first values among a stream's tries."""
    kept = (value for value in itertools.islice(tries, most) if not isinstance(value, Rejection))  # type: ignore
    return list(itertools.islice(kept, count))


HIGH = """
domain: cupboard
robot: {{model: panda_mobile, base: [0.0, 0.0, 0.0]}}
room: {{x: [-2.5, 2.5], y: [-2.5, 2.5]}}
bodies:
  table: {{furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0.0, 0.0], yaw: 90 deg}}
  board: {{box: [0.8, 0.3, 0.03], at: [-1.6, 0.4, {height}], yaw: 90 deg, fixed: true}}
  {thing}
goal: (on cup {goal})
"""


def solved(text: str, folder: Path, seconds: float) -> tuple[Outcome, str]:
    """What comes out of a scene, and the lines that explain it."""
    path = folder / "scene.yaml"
    path.write_text(text, encoding="utf-8")
    solution = solve(load_problem(path), max_time=seconds)
    return solution.outcome, "\n".join(solution.explanation)


CARRIERS = """\
domain: carriers
robot: {model: panda_mobile, base: [0.0, 0.0, 0.0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  table:  {furniture: table, size: [1.2, 0.7, 0.6], at: [1.2, 0.0, 0.0], yaw: 90 deg}
  post:   {box: [0.05, 0.05, 0.1], on: table}
  plate:  {box: [0.3, 0.3, 0.01], on: post}
  cube:   {box: [0.04, 0.04, 0.04], on: table, at: [0.4, 0.1]}
  crate:  {furniture: open_box, size: [0.3, 0.2, 0.1], fixed: false, on: table, at: [-0.4, 0.0]}
goal: (and (on cube plate) (inside cube crate))
"""


def carriers(folder: Path) -> Problem:
    """A plate on a post, an open crate and a cube on a table, all movable."""
    file = folder / "own.yaml"
    file.write_text(CARRIERS, encoding="utf-8")
    return load_problem(file)
