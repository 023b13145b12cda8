"""The height that the hand reaches is measured with the arm, and a reason that names it holds."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.context import Context
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.scene import Box
from tamp.geometric.streams.approach import LIFT_DISTANCE_M
from tamp.geometric.streams.reachable_height import (
    FOOT_DISTANCES_M,
    LOW_HEIGHT_M,
    _nearest_stand,
    highest,
    too_high,
)
from tamp.symbolic.algorithms.result import Outcome
from tests.geometric.making import body, scene
from tests.geometric.streams.scenes import HIGH, problem_with, solved


def test_the_measured_height_is_reached_and_a_hand_higher_is_not(tmp_path: Path) -> None:
    context = problem_with("can", tmp_path).context
    height = highest(context, 0.0, -1.0)
    assert height is not None and 1.2 < height < 1.7
    foot = context.robot.T_base_arm.position

    def level(z: float) -> bool:
        for distance in np.arange(0.1, 0.9, 0.05):
            T = np.eye(4)
            T[:3, 0], T[:3, 1], T[:3, 2] = (0.0, 0.0, -1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)
            T[:3, 3] = (foot[0] + distance, 0.0, z)
            if len(context.ik.solve(T, enough=1)):
                return True
        return False

    assert level(height - 0.02) and not level(height + 0.05)


@pytest.mark.parametrize("height", [1.6, 2.4])
def test_too_high_says_to_where_the_hand_reaches(height: float, tmp_path: Path) -> None:
    thing = "cup: {box: [0.05, 0.05, 0.1], on: board, at: [0.0, 0.0]}"
    outcome, said = solved(HIGH.format(height=height, thing=thing, goal="table"), tmp_path, 2.0)
    assert outcome in (Outcome.TIMEOUT, Outcome.INFEASIBLE)
    assert "too high: the hand reaches to 1." in said and "here" in said


def context(*blocks: Box, name: str = "panda_mobile") -> Context:
    """A robot in a room of 6 m, with blocks of which each stands around the middle."""
    bodies = [
        body(f"block{k}", block, (0.0, 0.0, block.size[2] / 2 + 0.001), movable=False)
        for k, block in enumerate(blocks)
    ]
    return Context(scene(*bodies, base=(1.0, 2.0, math.pi / 2)), ROBOTS[name](), {})


@pytest.mark.parametrize(
    ("z", "reached", "said"),
    [
        (LOW_HEIGHT_M - 0.01, 0.5, None),  # nobody measures there
        (LOW_HEIGHT_M + 0.01, 0.5, "too high: the hand reaches to 0.50 m here"),
        (1.4, 1.4 + LIFT_DISTANCE_M + 1e-6, None),
        (1.4, 1.4 + LIFT_DISTANCE_M - 1e-6, "too high: the hand reaches to "),
        (9.0, None, None),  # nobody gets there: that is said elsewhere
    ],
)
def test_a_point_is_too_high_where_the_lift_from_it_is_not_reached(
    z: float, reached: float | None, said: str | None
) -> None:
    known = replace(context(), heights={(10, -20): reached})
    found = too_high(known, np.array([0.51, -0.99, z]))
    assert found is said is None or str(found).startswith(str(said))


def test_a_place_is_measured_once() -> None:
    made = context()
    first = highest(made, 0.0, 0.0)
    assert first is not None and made.heights == {(0, 0): first}
    made.heights[0, 0] = 7.0
    assert highest(made, 0.02, -0.02) == 7.0  # 2 cm beside it is the same place


def test_the_robot_stands_as_near_as_the_fixed_bodies_let_it() -> None:
    """Its base is 0.8 m long, and the arm's foot ahead of its middle; a block keeps the base away from its sides."""
    foot = float(np.linalg.norm(ROBOTS["panda_mobile"]().T_base_arm.position[:2]))
    assert _nearest_stand(context(), 0.0, 0.0) == FOOT_DISTANCES_M[0]
    distance = _nearest_stand(context(Box((0.8, 0.8, 0.3))), 0.0, 0.0)
    assert distance is not None
    # From the block's middle 0.4 m to its side and 0.4 m to the middle of the base, less where the foot is.
    assert 0.4 + 0.4 - foot <= distance <= 0.4 + 0.4 - foot + 0.1
    assert _nearest_stand(context(Box((4.0, 4.0, 0.3))), 0.0, 0.0) is None
    assert _nearest_stand(context(), 20.0, 0.0) is None  # out of the room


def test_a_robot_that_does_not_drive_stands_where_it_is() -> None:
    """It looks along +y from (1, 2); its foot is where its mount says."""
    made = context(name="panda_fixed")
    x, y, _ = made.robot.T_base_arm.position
    foot = np.array([1.0 - y, 2.0 + x])
    for point in ((0.0, 0.0), (1.5, 2.5)):
        wanted = math.dist(point, foot)
        assert _nearest_stand(made, *point) == pytest.approx(wanted)


def test_no_height_where_the_arm_is_too_short() -> None:
    made = context(name="panda_fixed")
    assert highest(made, -2.0, -2.0) is None
    near = highest(made, 1.0, 2.5)
    assert near is not None and 0.4 < near - made.robot.T_base_arm.position[2] < 1.1
