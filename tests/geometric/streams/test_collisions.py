"""Movable bodies keep away from each other, but for what rests on another, and from the arm's last stretch."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.collision.arrangement import TRANSIT_CLEARANCE_M
from tamp.geometric.collision.swept_boxes import SweptBoxes
from tamp.geometric.context import Context
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Box, Cylinder, RobotStart
from tamp.geometric.streams import collisions
from tamp.geometric.streams.collisions import NEIGHBOUR_CLEARANCE_M, REACH_CLEARANCE_M, near
from tamp.geometric.streams.reach import arm_length
from tamp.geometric.values import BaseConf, Grasp, Reach
from tamp.planner.problem import Problem
from tamp.stream import Rejection
from tests.geometric.making import body, scene
from tests.geometric.streams.scenes import call, carriers, problem_with


@pytest.fixture(scope="module")
def problem(tmp_path_factory: pytest.TempPathFactory) -> Problem:
    """A box of 0.045 x 0.09 x 0.175 m on a table, and a lamp."""
    return problem_with("box", Path(tmp_path_factory.mktemp("collisions")))


@pytest.mark.parametrize(
    ("gap", "clear"),
    [(2 * NEIGHBOUR_CLEARANCE_M, True), (0.5 * NEIGHBOUR_CLEARANCE_M, False), (-0.01, False)],
)
def test_placed_bodies_keep_some_air(problem: Problem, gap: float, clear: bool) -> None:
    upright = Pose((0.0, 0.0, 2.0))
    lamp = problem.scene.bodies["lamp"].parts[0].shape
    beside = Pose((0.0225 + lamp.radius + gap, 0.0, 2.0))  # type: ignore[union-attr]
    found = collisions.test_pose_clear(problem.context, "box", upright, "lamp", beside, call())
    assert (found is True) == clear
    assert found is True or (isinstance(found, Rejection) and found.blockers == ("lamp",))
    assert (
        collisions.test_pose_clear(problem.context, "box", upright, "box", upright, call()) is True
    )


def test_one_that_rests_on_another_is_not_near_it_but_one_beside_is(tmp_path: Path) -> None:
    context, cube = carriers(tmp_path).context, Pose((1.2, 0.2, 0.7))
    post = Pose((1.2, 0.2, 0.7 - 0.02 - 0.05 - 0.001))
    assert not near(context, "cube", cube, "post", post)
    assert not near(context, "post", post, "cube", cube)
    assert near(context, "cube", cube, "post", Pose((1.2, 0.2, 0.7 - 0.07 + 0.001)))  # in it
    assert near(context, "cube", cube, "post", Pose((1.2 + 0.046, 0.2, 0.7)))  # beside


BASE = BaseConf(0.0, 0.0, 0.0)
HELD = Grasp("thing", Pose((0.0, 0.0, 0.1)), 0.04)
"""A slim thing of 0.2 m whose middle is 0.1 m beyond the tool: it goes on for as much again."""


@pytest.fixture(scope="module")
def context() -> Context:
    """A robot whose hand points down half a metre ahead of its foot, a slim thing for it and a post of 0.4 m."""
    bodies = (
        body("thing", Box((0.02, 0.02, 0.2)), (5, 5, 1)),
        body("post", Cylinder(0.05, 0.4), (4, 4, 1)),
    )
    ahead = RobotStart("panda_mobile", (0.0, 0.0, 0.0), (0.0, 0.3, 0.0, -1.5, 0.0, 1.8, 0.785))
    return Context(replace(scene(*bodies), robot=ahead), ROBOTS["panda_mobile"](), {})


def turned(context: Context, pan: float) -> Array:
    """The arm at home, turned about the upright by its first joint."""
    return context.home + pan * np.eye(len(context.home))[0]


def tool(context: Context, pan: float, below: float) -> Pose:
    """A place so far below the tool, upright."""
    at = context.kinematics.tool(context.conf(BASE.array, turned(context, pan)))[:3, 3]
    return Pose((float(at[0]), float(at[1]), float(at[2]) - below))


def reach(context: Context, to: float = 0.0, *, back: float = 0.0) -> Reach:
    """From home to the arm turned by `to`, and with the body from there back to `back`."""
    home, there, out = (turned(context, pan) for pan in (0.0, to, back))
    return Reach(np.array([home, there]), np.array([there, out]))


def asked(context: Context, way: Reach, post: Pose, base: BaseConf = BASE) -> bool | Rejection:
    start = Pose((5.0, 5.0, 1.0))
    return collisions.test_reach_clear(
        context, "thing", start, HELD, base, way, "post", post, call()
    )


def test_a_body_is_never_in_its_own_way(context: Context) -> None:
    at = tool(context, 0.0, 0.0)
    clear = collisions.test_reach_clear(
        context, "thing", at, HELD, BASE, reach(context), "thing", at, call()
    )
    assert clear is True


def test_what_the_base_stands_in_or_the_load_at_home_is_hit_by_the_base(context: Context) -> None:
    """The post reaches 0.2 m up from its middle, the thing 0.2 m below the tool, the fingers about 1 cm."""
    at_home = reach(context)
    for post in (Pose((0.0, 0.0, 0.2)), tool(context, 0.0, 0.2), tool(context, 0.0, 0.39)):
        refused = asked(context, at_home, post)
        assert refused == Rejection.hits("post", who="base", blockers=("post",))
    assert asked(context, at_home, tool(context, 0.0, 0.41)) is True


def test_what_the_empty_hand_meets_on_its_way_is_a_blocker(context: Context) -> None:
    """The arm turns by 2.4 rad: what stands half-way is met, at home and at the end nothing is."""
    half_way = tool(context, 1.2, 0.1)
    refused = asked(context, reach(context, 2.4, back=2.4), half_way)
    assert refused == Rejection.hits("post", blockers=("post",))
    assert asked(context, reach(context, 2.4, back=2.4), tool(context, -1.2, 0.1)) is True


def test_what_only_the_load_meets_on_its_way_back_is_a_blocker(context: Context) -> None:
    """0.3 m below the tool: the hand passes over the post, the thing in it, 0.2 m long, does not."""
    low = tool(context, 1.2, 0.3)
    refused = asked(context, reach(context, 2.4), low)
    assert refused == Rejection.hits("post", blockers=("post",))
    # Carried on from the end, away from the post, nothing is in the way.
    assert asked(context, reach(context, 2.4, back=2.6), low) is True


def test_the_end_of_the_lift_keeps_the_clearance_of_a_transit(context: Context) -> None:
    """A millimetre from the thing is enough on the way, and not where the arm's motion begins."""
    gap = (REACH_CLEARANCE_M + TRANSIT_CLEARANCE_M) / 2
    beside = tool(context, 2.4, 0.2 + 0.2 + gap)
    assert asked(context, reach(context, 2.4), beside) is True  # on the way only
    refused = asked(context, reach(context, 2.4, back=2.4), beside)
    assert refused == Rejection.hits("post", blockers=("post",))


def test_what_the_stretched_arm_does_not_get_to_is_not_looked_at(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    x, y, _ = context.robot.T_base_arm.position
    things = 2 * context.radius("thing") + context.radius("post")
    far = float(np.hypot(x, y)) + arm_length(context.robot) + things
    looked: list[object] = []
    arrangement = context.collisions.arrangement

    def counted(*arguments: object, **options: object) -> object:
        looked.append(arguments)
        return arrangement(*arguments, **options)

    monkeypatch.setattr(context.collisions, "arrangement", counted)
    for distance, count in ((far + 1e-3, 0), (far - 1e-3, 2)):
        looked.clear()
        base = BaseConf(1.0, -1.0, 0.3)
        assert asked(context, reach(context), Pose((1.0 + distance, -1.0, 0.2)), base) is True
        assert len(looked) >= count and bool(looked) is bool(count)


def test_the_broad_phase_leaves_no_body_out_that_is_in_the_way(
    context: Context, rng: np.random.Generator, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Asked about each place alone, with the broad phase and without."""
    ways = [reach(context), reach(context, 0.5, back=0.5), reach(context, -0.6, back=-0.2)]
    posts = [Pose((*rng.uniform(-0.9, 0.9, 2), float(rng.uniform(0.2, 1.6)))) for _ in range(200)]
    said = [asked(context, way, post) for way in ways for post in posts]
    everything = SweptBoxes(np.full((1, 3), -np.inf), np.full((1, 3), np.inf))
    monkeypatch.setattr(collisions, "_swept", lambda *_: everything)
    assert [asked(context, way, post) for way in ways for post in posts] == said
    assert 30 < sum(one is not True for one in said) < 500
