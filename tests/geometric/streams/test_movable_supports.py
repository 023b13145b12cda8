"""Placements on movable bodies: they move with them, and no tower tips."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.scene.pose import Pose
from tamp.geometric.streams.collisions import near
from tamp.geometric.streams.movable_supports import (
    inside,
    sample_inside_movable,
    sample_on_movable,
    shift,
)
from tamp.planner.problem import Problem
from tamp.simulation.engines import open_world
from tamp.stream import Call, Rejection
from tamp.system.deadline import Deadline
from tamp.verification.support_geometry import SupportContact, Supports
from tests.geometric.streams.scenes import carriers


@pytest.fixture
def problem(tmp_path: Path) -> Problem:
    return carriers(tmp_path)


def call(**fluents: Pose) -> Call:
    shown = [("at-pose", name, pose) for name, pose in fluents.items()]
    return Call(np.random.default_rng(0), Deadline(60.0), shown)


def drawn(poses: Iterable[Pose | Rejection], count: int) -> list[Pose]:
    found: list[Pose] = []
    for result in poses:
        if isinstance(result, Pose):
            found.append(result)
        if len(found) == count:
            break
    return found


def test_what_is_on_a_plate_is_over_the_post_under_it(problem: Problem) -> None:
    context = problem.context
    plate = context.scene.bodies["plate"].pose
    poses = drawn(
        sample_on_movable(context, "cube", "plate", "plate", plate, call(plate=plate)), 20
    )
    assert len(poses) == 20
    post = np.array(context.scene.bodies["post"].pose.position[:2])
    assert max(np.abs(np.array(pose.position[:2]) - post).max() for pose in poses) < 0.025

    on_the_table = Pose((1.2, 0.2, 0.607), plate.quaternion)  # there it cannot tip
    poses = drawn(sample_on_movable(context, "cube", "plate", "plate", on_the_table, call()), 20)
    assert max(abs(pose.position[0] - 1.2) for pose in poses) > 0.05
    assert {round(pose.position[2], 3) for pose in poses} == {0.633}


def test_a_cavity_is_where_its_body_is(problem: Problem) -> None:
    context = problem.context
    turned = Pose.from_xyz_yaw(-1.0, 0.5, 0.001, math.radians(30.0))
    poses = drawn(sample_inside_movable(context, "cube", "crate", "crate", turned, call()), 20)
    assert len(poses) == 20
    for pose in poses:
        x, y, _ = (turned.inverse() @ pose).position
        assert abs(x) < 0.14 and abs(y) < 0.09
        assert (
            not near(context, "cube", pose, "crate", turned)
            or min(0.14 - abs(x), 0.09 - abs(y)) < 0.032
        )


def test_a_place_on_its_side_carries_nothing(problem: Problem) -> None:
    lying = Pose.from_xyz_rpy((1.2, 0.2, 0.7), (math.pi / 2, 0.0, 0.0))
    (refused,) = sample_inside_movable(problem.context, "cube", "crate", "crate", lying, call())
    assert isinstance(refused, Rejection) and "crate is not level" in refused.reason


def test_what_is_carried_along_stays_where_it_is_on_the_body_below(problem: Problem) -> None:
    was, now = (Pose.from_xyz_yaw(x, 0.1, 0.6, x) for x in (0.3, -0.8))
    on_it = was @ Pose.from_xyz_yaw(0.02, 0.01, 0.0255, 0.4)
    (shifted,) = shift(problem.context, "cube", on_it, "plate", "plate", was, now, call())
    assert np.allclose((now.inverse() @ shifted).matrix, (was.inverse() @ on_it).matrix, atol=1e-9)


def test_inside_measures_to_the_nearest_edge() -> None:
    square = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    assert inside(np.array([0.75, 0.0]), square) == pytest.approx(0.25)
    assert inside(np.array([1.5, 0.0]), square) == pytest.approx(-0.5)


def test_the_judge_feels_what_tips_under_its_load(problem: Problem) -> None:
    """A cube at the edge of a plate on a post: each stands by itself, together they fall."""
    scene = problem.scene
    with open_world(scene) as world:
        supports = Supports(world)

        def stands() -> dict[str, SupportContact]:
            return {name: supports.stand(name) for name in scene.movable}

        x, y, z = scene.bodies["plate"].pose.position
        cube = scene.bodies["cube"].pose.matrix.copy()
        cube[:3, 3] = [x, y, z + 0.026]
        world.place("cube", cube)
        assert supports.why_overloaded("plate", stands()) is None
        cube[0, 3] = x + 0.1
        world.place("cube", cube)
        assert supports.stand("plate").stable and supports.stand("cube").stable
        assert str(supports.why_overloaded("plate", stands())).startswith("under cube it tips")
