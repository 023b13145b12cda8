"""Base poses and last stretches: straight and certified, or refused with the reason and given up in the end."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.context import Context
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box
from tamp.geometric.streams.approach import LIFT_DISTANCE_M, RETREAT_DISTANCE_M, test_approach
from tamp.geometric.streams.inverse_kinematics import (
    MAX_FAILED_TRIES,
    MAX_JOINT_TURN_RAD,
    follow_line,
    inverse_kinematics,
    inverse_kinematics_here,
    reach_from,
)
from tamp.geometric.streams.sampling import sample_grasp, sample_inside
from tamp.geometric.values import BaseConf, Grasp, Reach
from tamp.stream import Rejection, RejectionKind
from tests.geometric.making import body, scene, table
from tests.geometric.streams.scenes import call, problem_with, values

test_approach.__test__ = False  # type: ignore[attr-defined]  # a stream, not a test of ours


@pytest.mark.parametrize("name", ["can", "box"])
def test_inverse_kinematics_yields_straight_certified_reaches(name: str, tmp_path: Path) -> None:
    problem = problem_with(name, tmp_path)
    context = problem.context
    start = context.scene.bodies[name].pose
    poses = [start, *values(sample_inside(context, name, "cupboard_2", call()), 3)]
    checked = 0
    for pose in poses:
        for grasp in values(sample_grasp(context, name, call(1)), 12):
            if test_approach(context, name, pose, grasp, call()) is not True:
                continue
            found = values(inverse_kinematics(context, name, pose, grasp, call(2)), 1, most=6)
            for base, reach in found:
                checked += 1
                conf = [
                    np.array([context.conf(base.array, q) for q in path])
                    for path in (reach.approach, reach.lift)
                ]
                wanted = pose.matrix @ grasp.T_tool_body.inverse().matrix
                for at in (conf[0][-1], conf[1][0]):
                    assert np.abs(context.kinematics.tool(at) - wanted).max() < 1e-5
                back = -wanted[:3, 2]
                up = np.array([0.0, 0.0, LIFT_DISTANCE_M])
                begin = wanted[:3, 3] + RETREAT_DISTANCE_M * back
                assert straight(context, conf[0], begin, wanted[:3, 3]) < 0.002
                rows = next(
                    i
                    for i, c in enumerate(conf[1])
                    if abs(c[3:] - conf[1][0][3:]).max() > 0 and on(context, c, wanted[:3, 3] + up)
                )
                assert (
                    straight(context, conf[1][: rows + 1], wanted[:3, 3], wanted[:3, 3] + up)
                    < 0.002
                )
                assert straight(context, conf[1][rows:], wanted[:3, 3] + up, begin + up) < 0.002
                assert context.fixed_only(None).path_hits(conf[0]) is None
                assert context.fixed_only(grasp).path_hits(conf[1]) is None
    assert checked >= 4


def on(context, conf, point) -> bool:
    return bool(np.linalg.norm(context.kinematics.tool(conf)[:3, 3] - point) < 1e-4)


def straight(context, path, start, end) -> float:
    """How far the tool strays from a line, metres; it is followed between the rows, too."""
    steps = [a + t * (b - a) for a, b in pairwise(path) for t in np.linspace(0, 1, 8)]
    points = np.array([context.kinematics.tool(conf)[:3, 3] for conf in steps])
    direction = (end - start) / np.linalg.norm(end - start)
    offsets = points - start
    return float(np.linalg.norm(offsets - (offsets @ direction)[:, None] * direction, axis=1).max())


DOWN = Pose((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))
HELD = Grasp("box", DOWN, 0.041)
"""The box upright in a hand that points down, its middle between the fingers."""
AT = Pose((1.2, 0.0, 0.551))
"""Where a table of 0.5 m has it, half a metre and more before the arm."""


def made(*more: Body) -> Context:
    """A box of 0.04 x 0.04 x 0.1 m on a table that is in front of a robot at the origin."""
    box = body("box", Box((0.04, 0.04, 0.1)), AT.position)
    bodies = box, table(at=(1.4, 0.0)), *more
    return Context(scene(*bodies, base=(0.0, 0.0, 0.0)), ROBOTS["panda_mobile"](), {})


def here(context: Context, base: BaseConf, pose: Pose = AT) -> list[Reach | Rejection]:
    """All answers from a base pose, at most as many as make it give up and one more."""
    tries = inverse_kinematics_here(context, "box", pose, HELD, base, call())
    return [found for found, _ in zip(tries, range(MAX_FAILED_TRIES + 1), strict=False)]


@pytest.mark.parametrize(
    ("base", "pose", "reason", "kind"),
    [
        (BaseConf(0.0, 3.1, 0.0), AT, "base outside of the room", RejectionKind.NO_STANCE),
        (BaseConf(1.4, 0.0, 0.0), AT, "base hits table", RejectionKind.COLLISION),
        (BaseConf(-2.0, 0.0, 0.0), AT, "out of reach", RejectionKind.UNREACHABLE),
        # The hand would have to be in the table.
        (BaseConf(0.3, 0.0, 0.0), Pose((1.2, 0.0, 0.45)), "hits table", RejectionKind.COLLISION),
    ],
)
def test_a_place_that_never_serves_is_given_up_after_some_tries(
    base: BaseConf, pose: Pose, reason: str, kind: RejectionKind
) -> None:
    found = here(made(), base, pose)
    assert len(found) == MAX_FAILED_TRIES
    assert all(
        isinstance(one, Rejection) and (one.reason, one.kind) == (reason, kind) for one in found
    )
    assert [one.given_up for one in found] == [False] * (MAX_FAILED_TRIES - 1) + [True]  # type: ignore[union-attr]


def test_a_place_that_served_once_is_not_given_up() -> None:
    found = here(made(), BaseConf(0.3, 0.0, 0.0))
    assert len(found) == MAX_FAILED_TRIES + 1
    reaches = [one for one in found if isinstance(one, Reach)]
    assert reaches and not any(one.given_up for one in found if isinstance(one, Rejection))


def test_what_hangs_in_the_hand_must_have_room_at_home() -> None:
    """A post under the tool at home: the robot stands free there, with the box in its hand it does not."""
    free = made()
    tool = free.kinematics.tool(free.conf((0.0, 0.0, 0.0), free.home))[:3, 3]
    top = float(tool[2]) - 0.04  # the box reaches 5 cm below the tool, the fingers about one
    post = body(
        "post", Box((0.02, 0.02, 0.2)), (float(tool[0]), float(tool[1]), top - 0.1), movable=False
    )
    context = made(post)
    assert context.fixed_only(None).free(context.conf((0.0, 0.0, 0.0), context.home))
    found = here(context, BaseConf(0.0, 0.0, 0.0))
    assert {one.reason for one in found if isinstance(one, Rejection)} == {
        "box carried here hits post"
    }


@pytest.mark.parametrize("drive", ["omnidirectional", "fixed"])
def test_a_nook_is_refused_nearly_always_but_not_to_a_robot_that_does_not_drive(drive: str) -> None:
    """Low walls behind and on both sides of its base of 0.8 x 0.7 m: it cannot slide out by half a metre."""
    walls = (
        body("back", Box((0.1, 2.0, 0.3)), (-0.55, 0.0, 0.17), movable=False),
        body("left", Box((1.0, 0.1, 0.3)), (0.0, 0.5, 0.17), movable=False),
        body("right", Box((1.0, 0.1, 0.3)), (0.0, -0.5, 0.17), movable=False),
    )
    free = made(*walls)
    context = replace(free, robot=replace(free.robot, drive=drive))
    said = [one for one in here(context, BaseConf(0.0, 0.0, 0.0)) if isinstance(one, Rejection)]
    nooks = [one for one in said if one.kind is RejectionKind.NO_STANCE]
    assert len(said) == MAX_FAILED_TRIES and {one.reason for one in nooks} <= {
        "base stands in a nook"
    }
    # It is tried all the same one time of twenty.
    assert len(nooks) >= MAX_FAILED_TRIES - 3 if drive == "omnidirectional" else not nooks


def test_out_of_reach_says_how_high_the_hand_gets() -> None:
    context = made()
    context.heights[24, 0] = 1.3  # at (1.2, 0)
    tries = inverse_kinematics(context, "box", Pose((1.2, 0.0, 2.2)), HELD, call())
    found = list(tries)
    assert len(found) == MAX_FAILED_TRIES and found[-1].given_up  # type: ignore[union-attr]
    reasons = {one.reason for one in found if isinstance(one, Rejection)}
    assert "too high: the hand reaches to 1.30 m here" in reasons and "out of reach" not in reasons


def test_a_line_is_followed_in_small_turns_and_from_where_the_arm_is() -> None:
    context = made()
    T = context.kinematics.arm_tool(context.home)
    path = follow_line(context, T, np.array([0.1, 0.0, 0.05]), context.home)
    assert path is not None and np.array_equal(path[0], context.home)
    assert np.abs(np.diff(path, axis=0)).max() <= MAX_JOINT_TURN_RAD
    ends = np.array([context.kinematics.arm_tool(q)[:3, 3] for q in path]) - T[:3, 3]
    assert ends[-1] == pytest.approx([0.1, 0.0, 0.05], abs=1e-5)
    assert np.abs(np.cross(ends, [0.1, 0.0, 0.05])).max() < 1e-6
    assert len(path) == math.ceil(math.hypot(0.1, 0.05) / 0.01) + 1
    assert follow_line(context, T, np.array([2.0, 0.0, 0.0]), context.home) is None


def test_without_a_straight_lift_there_is_no_reach(rng: np.random.Generator) -> None:
    """Of arms all over their ranges: those that can draw the hand back, and not lift it."""
    context, base = made(), np.zeros(3)
    lower, upper = np.array(context.robot.lower), np.array(context.robot.upper)
    up = np.array([0.0, 0.0, LIFT_DISTANCE_M])
    looked = 0
    for q in rng.uniform(lower, upper, (300, 7)):
        T = context.kinematics.arm_tool(q)
        if context.fixed_only(None).hits(context.conf(base, q)) is not None:
            continue
        back = follow_line(context, T, -RETREAT_DISTANCE_M * T[:3, 2], q)
        if back is not None and follow_line(context, T, up, q) is None:
            looked += 1
            at = Pose.from_matrix(T) @ HELD.T_tool_body
            assert reach_from(context, at, HELD, base, T, q) is None
    assert looked >= 3
    T = context.kinematics.arm_tool(context.home)
    at = Pose.from_matrix(T) @ HELD.T_tool_body
    assert isinstance(reach_from(context, at, HELD, base, T, context.home), Reach)
