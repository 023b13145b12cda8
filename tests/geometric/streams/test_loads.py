"""What stands on a body that is carried: told by the facts, where the body is, and level on the way."""

from __future__ import annotations

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from tamp.geometric.context import Context
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box
from tamp.geometric.streams.loads import (
    LEVEL_TILT_RAD,
    LOADED_TILT_RAD,
    LevelChecker,
    body_poses,
    load_of,
    plan_loaded_pick,
)
from tamp.geometric.values import BaseConf, Grasp, Grip, Motion, Reach
from tamp.geometric.values import Path as Way
from tamp.stream import Call, Rejection, RejectionKind
from tamp.system.deadline import Deadline
from tests.geometric.making import body, scene
from tests.geometric.streams.scenes import carriers


def test_a_load_is_level_at_home_and_not_when_the_wrist_turns(tmp_path: Path) -> None:
    context = carriers(tmp_path).context
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


WAS, NOW = Pose.from_xyz_yaw(1.0, 0.0, 0.5, 0.3), Pose.from_xyz_yaw(-1.0, 2.0, 0.6, math.pi / 2)
"""Where the tray was when the cup was put on it, and where it is."""
ON_TRAY = Pose.from_xyz_yaw(0.1, 0.0, 0.05, 0.2)


def told(*facts: tuple[object, ...]) -> Call:
    return Call(np.random.default_rng(0), Deadline(60.0), facts)


def rides(name: str, below: str, T_below: Pose = WAS) -> tuple[object, ...]:
    return ("riding", name, T_below @ ON_TRAY, below, T_below)


def test_a_load_is_what_rides_on_the_body_in_its_frame_then() -> None:
    call = told(rides("cup", "tray"), ("at-pose", "tray", NOW), rides("spoon", "plate", NOW))
    ((name, T_tray_cup),) = load_of(call, "tray")
    assert name == "cup" and T_tray_cup.matrix == pytest.approx(ON_TRAY.matrix)
    assert load_of(call, "cup") == load_of(call, None) == ()
    assert [name for name, _ in load_of(told(rides("a", "t"), rides("b", "t")), "t")] == ["a", "b"]


def test_what_rides_stands_where_its_body_has_got_to() -> None:
    """The tray has been turned by a quarter: 0.1 m along its x is +y."""
    poses = body_poses(
        told(rides("cup", "tray"), ("at-pose", "tray", NOW), ("at-pose", "pan", WAS))
    )
    assert poses.keys() == {"tray", "cup", "pan"} and poses["pan"] == WAS
    assert poses["cup"].position == pytest.approx((-1.0, 2.1, 0.65))
    assert poses["cup"].yaw == pytest.approx(math.pi / 2 + 0.2)


def test_what_rides_on_a_body_in_the_hand_stands_nowhere() -> None:
    assert body_poses(told(rides("cup", "tray"), ("holding", "tray", None))) == {}


BAR, CUP, POST = Box((0.25, 0.02, 0.02)), Box((0.02, 0.02, 0.03)), Box((0.04, 0.04, 0.4))
BASE = BaseConf(0.0, 0.0, 0.0)
ON_BAR = Pose((0.1, 0.0, 0.026))
"""The cup stands at one end of the bar, whose middle the hand holds from above."""


@pytest.fixture(scope="module")
def context() -> Context:
    bodies: list[Body] = [
        body(name, shape, (5.0, k, 1.0))
        for k, (name, shape) in enumerate((("bar", BAR), ("cup", CUP), ("post", POST)))
    ]
    return Context(scene(*bodies), ROBOTS["panda_mobile"](), {})


def held(context: Context, tilt: float = 0.0) -> tuple[Pose, Grasp]:
    """The bar in the hand while the arm is at home, and how it is held; it leans by `tilt` about x."""
    T_tool = context.kinematics.tool(context.conf(BASE.array, context.home))
    x, y, z = T_tool[:3, 3]
    pose = Pose.from_xyz_rpy((float(x), float(y), float(z)), (tilt, 0.0, 0.0))
    return pose, Grasp("bar", Pose.from_matrix(np.linalg.inv(T_tool) @ pose.matrix), 0.0205)


def answers(
    context: Context, *facts: tuple[object, ...], tilt: float = 0.0, on: Pose = ON_BAR,
    wrist: float = 0.0,
) -> list[Motion | Rejection]:  # fmt: skip
    """All answers; the lift turns the wrist's bend."""
    pose, grasp = held(context, tilt)
    upright = Pose(pose.position)  # where it stands, it does not lean
    out = context.home + wrist * np.eye(7)[5]
    reach = Reach(np.array([context.home] * 2), np.array([context.home, out]))
    load = (("cup", on),)
    return list(plan_loaded_pick(context, upright, grasp, BASE, reach, load, told(*facts)))


def test_a_loaded_pick_goes_there_empty_and_back_with_all(context: Context) -> None:
    found = answers(context)
    assert found and isinstance(found[0], Motion)
    there, grip, back = found[0].segments
    assert isinstance(there, Way) and isinstance(grip, Grip) and isinstance(back, Way)
    wide = context.robot.opening
    assert (there.holding, there.opening, back.holding, back.opening) == (None, wide, "bar", 0.0205)
    assert grip.opening == (wide, 0.0205) and grip.attach == held(context)[1]
    assert grip.load == (("cup", ON_BAR),)
    for row in (there.points[0], there.points[-1], back.points[0], back.points[-1]):
        assert row == pytest.approx(context.home)


@pytest.mark.parametrize(("tilt", "refused"), [(0.5 * LEVEL_TILT_RAD, False), (0.1, True)])
def test_what_leans_at_home_is_refused_for_good(
    context: Context, tilt: float, refused: bool
) -> None:
    found = answers(context, tilt=tilt)
    said = Rejection(
        "bar would lean by 6 degrees at home", given_up=True, kind=RejectionKind.UNSTABLE
    )
    assert (found == [said]) is refused


def test_the_load_is_in_the_hands_way(context: Context) -> None:
    assert answers(context, on=Pose((0.0, 0.0, 0.05))) == [Rejection.hits("cup")]


def test_another_body_is_in_the_way_unless_it_is_carried_along(context: Context) -> None:
    below = (
        "at-pose",
        "post",
        Pose((held(context)[0].position[0], 0.0, held(context)[0].position[2] - 0.2)),
    )
    (refused,) = answers(context, below)
    assert refused == Rejection.hits("post", who="base", blockers=("post",))
    away = ("at-pose", "post", Pose((0.0, 2.0, 0.2)))
    assert isinstance(answers(context, away)[0], Motion)
    # The cup's own facts, and the bar's, are no obstacles to their pick.
    own = ("at-pose", "bar", held(context)[0]), ("at-pose", "cup", held(context)[0])
    assert isinstance(answers(context, *own)[0], Motion)


def test_no_level_way_is_said_with_what_is_on_it(context: Context) -> None:
    """The end of the lift leans by more than what stands on it would bear: looking again is of no use."""
    (said,) = answers(context, wrist=1.1 * LOADED_TILT_RAD)
    assert isinstance(said, Rejection) and said.kind is RejectionKind.NO_MOTION
    assert said.reason == "no level way with cup: the goal is in collision"
    assert isinstance(answers(context, wrist=0.9 * LOADED_TILT_RAD)[0], Motion)


@pytest.mark.parametrize("free", [True, False])
def test_an_edge_is_looked_at_between_its_ends_and_among_the_others(
    context: Context, free: bool
) -> None:
    """A forearm that turns once round ends as level as it began; a twentieth of a turn leans little."""
    _, grasp = held(context)
    among = SimpleNamespace(free=lambda conf: free, edge_free=lambda start, end: free)
    level = LevelChecker(context, among, grasp, np.array([0.0, 0.0, 1.0]))
    home = context.conf(BASE.array, context.home)
    round_once, a_little = (home + turn * np.eye(10)[3 + 4] for turn in (math.tau, 0.15))
    assert level.tilt(round_once) < 1e-6 < level.tilt(a_little) < LOADED_TILT_RAD
    assert not level.edge_free(home, round_once)
    assert level.edge_free(home, a_little) is level.free(round_once) is free
