"""The hand's straight way to a grasp, among fixed and movable bodies, wherever the base stands."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.scene.pose import Pose
from tamp.geometric.streams import approach
from tamp.geometric.streams.approach import LIFT_DISTANCE_M, RETREAT_DISTANCE_M, approach_hits
from tamp.geometric.values import Grasp
from tamp.planner.problem import Problem
from tamp.stream import Rejection, RejectionKind
from tests.geometric.streams.scenes import call, problem_with

DOWN = (1.0, 0.0, 0.0, 0.0)
"""The tool's z looks down: half a turn about x."""


@pytest.fixture(scope="module")
def problem(tmp_path_factory: pytest.TempPathFactory) -> Problem:
    """A box of 0.045 x 0.09 x 0.175 m on a table, and a lamp."""
    return problem_with("box", Path(tmp_path_factory.mktemp("approach")))


def from_above(height: float = 0.04) -> Grasp:
    """The hand above the box, its fingers closing on the narrow sides; the tool `height` above the middle."""
    T_body_tool = (
        Pose((0.0, 0.0, height))
        @ Pose.from_xyz_rpy((0, 0, 0), (0, 0, 1.5707963267948966))
        @ Pose((0.0, 0.0, 0.0), DOWN)
    )
    return Grasp("box", T_body_tool.inverse(), 0.0455)


def shifted(pose: Pose, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Pose:
    return Pose((pose.position[0] + x, pose.position[1] + y, pose.position[2] + z), pose.quaternion)


def start(problem: Problem) -> Pose:
    return problem.scene.bodies["box"].pose


def test_nothing_is_in_the_way_from_above(problem: Problem) -> None:
    assert (
        approach.test_approach(problem.context, "box", start(problem), from_above(), call()) is True
    )
    assert approach_hits(problem.context, start(problem), from_above(), []) is None


def test_from_below_the_table_is(problem: Problem) -> None:
    below = Grasp("box", Pose((0.0, 0.0, -0.04)), 0.0455)  # the tool's z looks up
    found = approach.test_approach(problem.context, "box", start(problem), below, call())
    assert isinstance(found, Rejection) and found.kind is RejectionKind.COLLISION
    assert found.bodies == ("table",) and found.reason == "hand hits table" and found.blockers == ()


@pytest.mark.parametrize(("above", "hits"), [(0.25, True), (0.5, True), (0.65, False)])
def test_a_body_above_is_in_the_way_as_far_as_the_hand_draws_back(
    problem: Problem, above: float, hits: bool
) -> None:
    other = shifted(start(problem), z=above)
    found = approach_hits(problem.context, start(problem), from_above(), [("lamp", other)])
    # The lamp is 0.4 m high: its foot is 0.2 m lower. The hand is about 0.17 m long above the tool, which is at 0.04.
    assert (
        (found == "lamp")
        == hits
        == (above - 0.2 < 0.04 + 0.17 + LIFT_DISTANCE_M + RETREAT_DISTANCE_M)
    )


def test_a_movable_body_in_the_way_is_named_as_a_blocker(problem: Problem) -> None:
    context, pose = problem.context, start(problem)
    there = shifted(pose, z=0.2)
    found = approach.test_approach_clear(context, "box", pose, from_above(), "lamp", there, call())
    assert isinstance(found, Rejection) and (found.blockers, found.bodies) == (("lamp",), ("lamp",))
    away = shifted(pose, x=5.0)
    assert (
        approach.test_approach_clear(context, "box", pose, from_above(), "lamp", away, call())
        is True
    )
    assert (
        approach.test_approach_clear(context, "box", pose, from_above(), "box", there, call())
        is True
    )  # itself


def test_a_wider_opening_needs_more_room(problem: Problem) -> None:
    pose = start(problem)
    lamp = problem.scene.bodies["lamp"].parts[0].shape.radius  # type: ignore[union-attr]
    # Beside a finger: the open hand hits it on its way in, whatever the fingers do afterwards.
    frame = pose @ from_above().T_tool_body.inverse()
    x, y, z = frame.apply(np.array([[0.0, 0.05 + lamp, 0.0]]))[0]
    beside = Pose((float(x), float(y), float(z)))
    assert approach_hits(problem.context, pose, from_above(), [("lamp", beside)]) == "lamp"
    assert (
        approach_hits(
            problem.context, pose, replace(from_above(), opening=0.08), [("lamp", beside)]
        )
        == "lamp"
    )


def test_the_broad_phase_leaves_no_body_out_that_the_hand_hits(
    problem: Problem, rng: np.random.Generator
) -> None:
    """Asked about each place alone, with the broad phase and without."""
    context, pose, grasp = problem.context, start(problem), from_above()
    hits = 0
    for _ in range(600):
        there = shifted(pose, *(float(value) for value in rng.uniform(-0.25, 0.35, 3)))
        said = approach.test_approach_clear(context, "box", pose, grasp, "lamp", there, call())
        hit = approach_hits(context, pose, grasp, [("lamp", there)])
        assert (said is True) == (hit is None)
        hits += hit is not None
    assert 30 < hits < 500
