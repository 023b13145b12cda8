"""What lies behind a door that is too narrow is out of reach; a door that the base fits through is never in the way."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.streams.reach import test_reachable
from tamp.planner.problem import Problem, load_problem
from tests.geometric.streams.scenes import call

test_reachable.__test__ = False  # type: ignore[attr-defined]  # a stream, not a test of ours

ROOM = """
domain: cupboard
robot: {{model: panda_mobile, base: [{x:.3f}, {y:.3f}, {yaw:.3f}]}}
room: {{x: [-2.5, 2.5], y: [-2.5, 2.5]}}
bodies:
  table: {{furniture: table, size: [0.6, 0.6, 0.7], at: [-2.1, 0.0, 0.0]}}
{walls}
  can: {{cylinder: {{radius: 0.03, height: 0.1}}, on: table, at: [0.0, 0.0]}}
goal: (on can table)
"""


def walled(
    folder: Path, door: float, middle: float = 0.3, height: float = 2.0, *, x: float = 0.8
) -> Problem:
    """A wall across the room with a door, the robot on one side and a can on the other."""
    walls = ""
    for i, (low, high) in enumerate(((-3.0, middle - door / 2), (middle + door / 2, 3.0))):
        size, y = f"[0.06, {high - low:.4f}, {height}]", (low + high) / 2
        walls += f"  wall_{i}: {{box: {size}, at: [-0.7, {y:.4f}, {height / 2}], fixed: true, surfaces: {{}}}}\n"
    path = folder / "door.yaml"
    path.write_text(ROOM.format(x=x, y=0.0, yaw=0.0, walls=walls), encoding="utf-8")
    return load_problem(path)


def reached(problem: Problem) -> str | None:
    """Why the can is out of reach; None when that is not proven."""
    found = test_reachable(problem.context, "can", problem.scene.bodies["can"].pose, call())
    return None if found is True else found.reason  # type: ignore[union-attr]


@pytest.mark.parametrize("door", [0.31, 0.5, 0.62])
@pytest.mark.parametrize("middle", [-1.0, 0.3, 1.27])
def test_a_narrow_door_is_named_with_its_width(door: float, middle: float, tmp_path: Path) -> None:
    reason = reached(walled(tmp_path, door, middle))
    assert reason == f"out of reach (the door is {door:.2f} m, the base 0.70 m wide)"


@pytest.mark.parametrize("door", [0.70, 0.74, 0.9, 2.0])
@pytest.mark.parametrize("middle", [-1.0, 0.3, 1.27])
def test_a_door_that_the_base_fits_through_proves_nothing(
    door: float, middle: float, tmp_path: Path
) -> None:
    assert reached(walled(tmp_path, door, middle)) is None


def test_without_a_door_the_wall_is_named(tmp_path: Path) -> None:
    reason = reached(walled(tmp_path, 1e-3, 1.0))
    assert reason is not None and "no way leads there: wall_" in reason


def test_what_the_arm_reaches_over_a_low_wall_is_in_reach(tmp_path: Path) -> None:
    problem = walled(tmp_path, 0.3, height=0.5)
    near = problem.scene.bodies["can"].pose
    shifted = type(near)((-1.2, 0.0, near.position[2]), near.quaternion)
    assert test_reachable(problem.context, "can", shifted, call()) is True


def test_what_may_be_taken_away_is_no_wall(tmp_path: Path) -> None:
    path = tmp_path / "boxes.yaml"
    walls = "".join(
        f"  box_{i}: {{box: [0.3, 0.3, 0.5], on: floor, at: [-0.7, {-2.7 + 0.31 * i:.2f}]}}\n"
        for i in range(18)
    )
    path.write_text(ROOM.format(x=0.8, y=0.0, yaw=0.0, walls=walls), encoding="utf-8")
    assert reached(load_problem(path)) is None


def test_the_base_stands_nowhere_beyond_what_is_called_closed(
    tmp_path: Path, rng: np.random.Generator
) -> None:
    """Where the base can be driven by any chain of free places, nothing near is called out of reach."""
    context = walled(tmp_path, 0.8).context
    passage = context.passage
    for _ in range(40):
        base = np.array([rng.uniform(-2.4, -1.2), rng.uniform(-2.4, 2.4), rng.uniform(-3, 3)])
        if context.fixed_only(None).free(context.conf(base, context.home)):
            assert passage.closed(base[:2] - 0.01, base[:2] + 0.01, 0.1) is None
