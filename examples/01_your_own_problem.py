"""Your own scene and goal, in a YAML file of your own.

Bodies are boxes, cylinders, spheres, meshes or parametric furniture; docs/problem-format.md has all of it.
"""

from pathlib import Path

import tamp

SCENE = """
name: tea
domain: cupboard
robot: {model: panda_mobile, base: [0.0, 0.0, 0.0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}

bodies:
  table: {furniture: table, size: [1.2, 0.7, 0.72], at: [1.4, 0.0, 0.0], yaw: 90 deg}
  shelf: {furniture: shelf, size: [0.8, 0.35, 1.0], compartments: 3, at: [-1.4, 0.3, 0.0], yaw: 90 deg}
  tea:   {box: [0.06, 0.06, 0.12], on: table, at: [0.1, 0.2], yaw: 20 deg, colour: [0.2, 0.5, 0.2]}
  sugar: {cylinder: {radius: 0.035, height: 0.1}, on: table, at: [-0.2, 0.1]}

goal: (and (on tea shelf_2) (on sugar shelf_2))
"""

path = Path("tea.yaml")
path.write_text(SCENE, encoding="utf-8")

try:
    solution = tamp.solve(tamp.load_problem(path), max_time=30.0, seed=0)
    print(solution.outcome.value)
except tamp.InputError as error:  # names the file, the line, the choices, and what you probably meant
    raise SystemExit(f"{error}") from error

print(len(solution.plan), "actions")
