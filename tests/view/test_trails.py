"""Trails: rods along the ways of hand and base, that grow with time."""

from __future__ import annotations

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.kinematics import ArmsKinematics
from tamp.geometric.scene.scene import Box
from tamp.plan.read import StoredSegment
from tamp.view.timeline import timeline_of
from tamp.view.trails import (
    DRIVE_COLOUR,
    EMPTY_COLOUR,
    FULL_COLOUR,
    POINT_SPACING_M,
    TRAIL_RADIUS_M,
    Trail,
    trails,
)
from tests.geometric.making import body, scene, table
from tests.plan.making import base, close, let_go, plan_of

ROBOT = ROBOTS["panda_mobile"]()
SCENE = scene(table(), body("cup", Box((0.05, 0.05, 0.1)), (0, 0, 0.551)), base=(0.0, -2.0, 0.0))
STEPS = np.linspace(0.0, 1.0, 101)


def drive(start: float, end: float, holding: str | None = None) -> StoredSegment:
    """Along y = -2 in ten seconds."""
    rows = np.column_stack([start + (end - start) * STEPS, np.full(101, -2.0), np.zeros(101)])
    return base(10 * STEPS, rows, holding=holding)


def made(*segments: StoredSegment) -> dict[tuple[float, ...], Trail]:
    plan = plan_of(*(("act", ("cup",), [segment]) for segment in segments))
    found = trails(timeline_of(SCENE, ROBOT, plan), ArmsKinematics(ROBOT))
    return {tuple(trail.line.colours[0].round(6)): trail for trail in found}


EMPTY, FULL, DRIVE = (tuple(colour[:3]) for colour in (EMPTY_COLOUR, FULL_COLOUR, DRIVE_COLOUR))


def test_a_drive_leaves_a_line_on_the_floor_and_one_of_the_empty_hand() -> None:
    found = made(drive(0.0, 1.0))
    assert found.keys() == {EMPTY, DRIVE}
    floor = found[DRIVE].line.corners
    assert floor[:, :, 0].min() == pytest.approx(0.0, abs=1e-9)
    assert floor[:, :, 0].max() == pytest.approx(1.0, abs=POINT_SPACING_M)
    around = np.hypot(floor[:, :, 1] + 2.0, floor[:, :, 2] - 0.01)
    assert around == pytest.approx(np.full(around.shape, TRAIL_RADIUS_M))  # a rod about the way
    hand = found[EMPTY].line.corners
    tool = ArmsKinematics(ROBOT).tool(np.array([0.0, -2.0, 0.0, *ROBOT.home, ROBOT.opening]))[:3, 3]
    assert hand[:, :, 2].mean() == pytest.approx(tool[2], abs=TRAIL_RADIUS_M)


def test_points_are_a_spacing_apart() -> None:
    rods = len(made(drive(0.0, 1.0))[DRIVE].passed) / 6  # six triangles each
    assert rods <= 1.0 / POINT_SPACING_M + 1 and rods > 0.4 / POINT_SPACING_M


def test_it_grows_with_time() -> None:
    trail = made(drive(0.0, 1.0))[DRIVE]
    assert (np.diff(trail.passed) >= 0.0).all()
    assert len(trail.until(-1.0).corners) == 0
    assert len(trail.until(1e9).corners) == len(trail.line.corners)
    half = trail.until(5.0)
    assert half.corners[:, :, 0].max() == pytest.approx(0.5, abs=POINT_SPACING_M)
    assert len(half.normals) == len(half.colours) == len(half.corners)


def test_with_a_body_in_it_the_hands_line_has_another_colour() -> None:
    found = made(
        drive(0.0, 0.5), close("cup"), drive(0.5, 1.0, "cup"), let_go("cup"), drive(1.0, 1.5)
    )
    assert found.keys() == {EMPTY, FULL, DRIVE}
    tool = ArmsKinematics(ROBOT).tool(np.array([0.0, -2.0, 0.0, *ROBOT.home, ROBOT.opening]))[0, 3]
    full = found[FULL].line.corners[:, :, 0] - tool
    assert full.min() == pytest.approx(0.5, abs=POINT_SPACING_M) and full.max() == pytest.approx(
        1.0, abs=0.03
    )
    assert (found[FULL].passed > 10.4).all() and (found[FULL].passed < 21.1).all()


def test_who_stands_still_leaves_none() -> None:
    assert made(base([0, 5], [[0, -2, 0], [0, -2, 0]])) == {}
    assert trails(timeline_of(SCENE, ROBOT), ArmsKinematics(ROBOT)) == []
