"""Placements on movable bodies: they move with them, and no tower tips."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.scene.pose import Pose
from tamp.geometric.streams.collisions import near
from tamp.geometric.streams.loads import LOADED_TILT_RAD, LevelChecker
from tamp.geometric.streams.movable_supports import (
    inside,
    sample_inside_movable,
    sample_on_movable,
    shift,
)
from tamp.geometric.values import Grasp
from tamp.planner.problem import Problem, load_problem
from tamp.simulation.engines import open_world
from tamp.stream import Call, Rejection
from tamp.system.deadline import Deadline
from tamp.verification.support_geometry import SupportContact, Supports

PROBLEM = """\
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


@pytest.fixture
def problem(tmp_path: Path) -> Problem:
    file = tmp_path / "own.yaml"
    file.write_text(PROBLEM)
    return load_problem(file)


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


def test_one_that_rests_on_another_is_not_near_it_but_one_beside_is(problem: Problem) -> None:
    context, cube = problem.context, Pose((1.2, 0.2, 0.7))
    post = Pose((1.2, 0.2, 0.7 - 0.02 - 0.05 - 0.001))
    assert not near(context, "cube", cube, "post", post)
    assert not near(context, "post", post, "cube", cube)
    assert near(context, "cube", cube, "post", Pose((1.2, 0.2, 0.7 - 0.07 + 0.001)))  # in it
    assert near(context, "cube", cube, "post", Pose((1.2 + 0.046, 0.2, 0.7)))  # beside


def test_what_is_carried_along_stays_where_it_is_on_the_body_below(problem: Problem) -> None:
    was, now = (Pose.from_xyz_yaw(x, 0.1, 0.6, x) for x in (0.3, -0.8))
    on_it = was @ Pose.from_xyz_yaw(0.02, 0.01, 0.0255, 0.4)
    (shifted,) = shift(problem.context, "cube", on_it, "plate", "plate", was, now, call())
    assert np.allclose((now.inverse() @ shifted).matrix, (was.inverse() @ on_it).matrix, atol=1e-9)


def test_a_load_is_level_at_home_and_not_when_the_wrist_turns(problem: Problem) -> None:
    context = problem.context
    conf = context.conf((0.0, 0.0, 0.0), context.home)
    tool = context.kinematics.tool(conf)
    upright = np.eye(4)
    upright[:3, :3] = tool[:3, :3].T
    grasp = Grasp("plate", Pose.from_matrix(upright), 0.04)
    level = LevelChecker(
        context, context.collisions.arrangement({}), grasp, np.array([0.0, 0.0, 1.0])
    )
    assert level.tilt(conf) < 1e-6
    leaning = conf.copy()
    leaning[3 + 5] += 2 * LOADED_TILT_RAD
    assert level.tilt(leaning) == pytest.approx(2 * LOADED_TILT_RAD, abs=1e-6)
    back = conf.copy()
    back[3 + 5] -= 2 * LOADED_TILT_RAD
    assert not level.free(leaning) and not level.edge_free(leaning, back)


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
