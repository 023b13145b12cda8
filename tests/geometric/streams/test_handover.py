"""Handovers: which poses in the air are drawn, when two hands exclude each other, what both arms then do."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tamp.geometric.context import Context
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body, Box, Part, RobotStart, Room, Scene
from tamp.geometric.streams import handover
from tamp.geometric.streams.approach import RETREAT_DISTANCE_M
from tamp.geometric.streams.handover import (
    FARTHEST_SHARE,
    FINGER_STEP_M,
    MAX_FAILED_TRIES,
    NEAREST_SHARE,
    plan_handover,
    sample_handover,
)
from tamp.geometric.values import BaseConf, Grasp, Grip, Motion, Path, Reach, Stance
from tamp.stream import Rejection, RejectionKind
from tests.geometric.streams.scenes import call

BASE = BaseConf(0.3, -0.2, 0.8)
BAR = 0.3
"""Metres that the bar is long, along x."""


@pytest.fixture(scope="module")
def context() -> Context:
    """Two arms, and a bar that is out of the way."""
    bar = Body("bar", (Part(Box((BAR, 0.04, 0.04))),), Pose((0.0, 2.0, 1.0)), movable=True)
    start = RobotStart("two_pandas", BASE.array)
    scene = Scene("s", {"bar": bar}, start, Room((-3.0, 3.0), (-3.0, 3.0)))
    return Context(scene, ROBOTS["two_pandas"](), {})


def grasp(along: float, turned: bool = False) -> Grasp:
    """A hand at a place along the bar, across it, from above or from below."""
    T_body_tool = np.eye(4)
    if not turned:
        T_body_tool[:3, :3] = np.diag([1.0, -1.0, -1.0])
    T_body_tool[0, 3] = along
    return Grasp("bar", Pose.from_matrix(np.linalg.inv(T_body_tool)), 0.041)


def test_poses_are_within_reach_of_both_shoulders(context: Context) -> None:
    """The shoulders by the kinematics: where the second joint is, however the arm stands."""
    shoulders: list[Array] = []
    lengths: list[float] = []
    for name in ("left", "right"):
        robot = context.of_arm(name).robot
        poses = Kinematics(robot).link_poses(np.array([*BASE.array, *robot.home]), 0.0)
        shoulders.append(poses[robot.joints[0].child][:3, 3])
        lengths.append(handover.arm_length(robot))
    drawn = list(handover._poses(context, "left", "right", BASE, np.random.default_rng(0), 2000))
    assert 200 < len(drawn) < 2000
    for shoulder, length in zip(shoulders, lengths, strict=True):
        shares = np.array([np.linalg.norm(pose.position - shoulder) for pose in drawn]) / length
        assert NEAREST_SHARE <= shares.min() < NEAREST_SHARE + 0.1
        assert FARTHEST_SHARE - 0.1 < shares.max() <= FARTHEST_SHARE
    middle = np.mean([pose.position for pose in drawn], axis=0)
    assert middle == pytest.approx(np.mean(shoulders, axis=0), abs=0.1)
    for pose in drawn:
        assert np.linalg.norm(pose.quaternion) == pytest.approx(1.0)


def test_fingers_are_looked_at_so_closely_that_none_passes_another() -> None:
    """Each finger goes half of what the opening changes."""
    for closed, opened in ((0.04, 0.08), (0.0, 0.085), (0.079, 0.08)):
        openings = handover._between(closed, opened)
        assert (openings[0], openings[-1]) == (closed, pytest.approx(opened))
        steps = np.diff(openings) / 2
        assert np.all(steps > 0) and steps.max() <= FINGER_STEP_M + 1e-12
    assert handover._between(0.08, 0.08) == [0.08, 0.08]


def test_a_hand_comes_along_its_own_axis() -> None:
    T = Pose.from_xyz_rpy((0.1, 0.2, 0.3), (0.4, 1.0, -2.0)).matrix
    for share in (0.0, 0.5, 1.0):
        moved = handover._back(T, share)
        assert moved[:3, :3] == pytest.approx(T[:3, :3])
        assert np.linalg.inv(T) @ moved[:, 3] == pytest.approx(
            [0.0, 0.0, -share * RETREAT_DISTANCE_M, 1.0]
        )


@pytest.mark.parametrize(
    ("first", "second", "meet"),
    [
        (grasp(-0.12), grasp(0.12), False),
        (grasp(-0.12), grasp(0.12, turned=True), False),
        (grasp(0.0), grasp(0.01), True),
        (grasp(0.0), grasp(0.0, turned=True), True),
    ],
)
def test_hands_at_the_ends_of_a_bar_keep_apart_and_in_one_place_do_not(
    context: Context, first: Grasp, second: Grasp, meet: bool
) -> None:
    found = handover._hands_meet(context, "left", first, "right", second)
    assert (found is not None) is meet
    back = handover._hands_meet(context, "right", second, "left", first)
    assert (back is not None) is meet


class Hands:
    """Two hands in the place of a context: they meet where a rule says, of their openings and how far they are."""

    def __init__(self, rule: Any) -> None:
        self._rule = rule

    def of_arm(self, name: str) -> Any:
        def meets(opening: float, T: Array, other: Any, its: float, T_other: Array) -> bool:
            mine, yours = (opening, away(T)), (its, away(T_other))
            return self._rule(*((mine, yours) if name == "left" else (yours, mine)))

        return SimpleNamespace(
            robot=SimpleNamespace(opening=0.08), hand=SimpleNamespace(meets=meets)
        )


def away(T_body_tool: Array) -> float:
    """How far a hand has drawn back from its grasp: along its z, of which grasps have none."""
    return float(-T_body_tool[2, 3] * np.sign(T_body_tool[2, 2]))


@pytest.mark.parametrize(
    ("rule", "said"),
    [
        (lambda gives, takes: gives[0] > 0.06 and takes[1] == 0.0, "fingers hit the taker's as they open"),
        (lambda gives, takes: takes[0] > 0.06 and gives[1] == 0.0 and takes[1] == 0.0,
         "fingers hit the giver's as they close"),
        (lambda gives, takes: takes[1] > 0.05 and takes[0] > 0.06, "taker's hand hits the giver's"),
        (lambda gives, takes: gives[1] > 0.05 and gives[0] > 0.06, "giver's hand hits the taker's"),
        (lambda gives, takes: gives[1] > 0 and takes[1] > 0, None),
        (lambda gives, takes: gives[0] > 0.06 and takes[0] > 0.06, None),
    ],
)  # fmt: skip
def test_each_moves_while_the_other_holds(rule: Any, said: str | None) -> None:
    """Neither goes while the other comes, nor are both open at once where the body would fall."""
    found = handover._hands_meet(Hands(rule), "left", grasp(0.1), "right", grasp(-0.1))  # type: ignore[arg-type]
    assert (said is None and found is None) or (said is not None and said in (found or ""))


def tries(context: Any, found: Any, monkeypatch: pytest.MonkeyPatch, most: int = 200) -> list[Any]:
    """What is yielded where each exchange gives what `found` says in turn."""
    monkeypatch.setattr(handover, "_hands_meet", lambda *_: None)
    monkeypatch.setattr(handover, "_poses", lambda *_: iter([Pose()]))
    monkeypatch.setattr(handover, "_exchange", lambda *_: next(found))
    got = sample_handover(context, "left", "bar", grasp(0.1), "right", grasp(-0.1), BASE, call())
    return list(itertools.islice(got, most))


def test_two_grasps_are_given_up_after_so_many_tries_in_vain(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    hit = Rejection.hits("wall", who="left_hand")
    got = tries(None, itertools.cycle([None, hit]), monkeypatch)
    assert len(got) == MAX_FAILED_TRIES
    assert [one.given_up for one in got] == [False] * (MAX_FAILED_TRIES - 1) + [True]
    assert {one.reason for one in got[::2]} == {"no pose within reach of both arms"}
    assert {one.reason for one in got[1::2]} == {hit.reason}
    assert got[0].kind is RejectionKind.UNREACHABLE and got[1].kind is RejectionKind.COLLISION


def test_grasps_that_served_once_are_never_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """After a success failures are not even told."""
    later = itertools.chain(itertools.repeat(None, 3 * MAX_FAILED_TRIES), [("more", "too")])
    got = tries(None, itertools.chain([None, ("gives", "takes")], later), monkeypatch, most=3)
    assert not got[0].given_up
    assert got[1:] == [(Pose(), "gives", "takes"), (Pose(), "more", "too")]


def test_hands_that_meet_and_an_arm_alone_are_refused_at_once(context: Context) -> None:
    def said(taker: str, other: Grasp) -> list[Any]:
        found = sample_handover(context, "left", "bar", grasp(0.0), taker, other, BASE, call())
        return list(found)

    (met,) = said("right", grasp(0.01))
    assert met.kind is RejectionKind.COLLISION
    (alone,) = said("left", grasp(0.12))
    assert "itself" in alone.reason


def test_both_hands_are_at_the_body_and_nothing_meets_on_the_way(context: Context) -> None:
    """By the kinematics of each arm, and by collision of each with the other where it holds."""
    first, second = grasp(-0.12), grasp(0.12)
    found = sample_handover(context, "left", "bar", first, "right", second, BASE, call(2))
    pose, gives, takes = next(one for one in found if isinstance(one, tuple))
    for arm, held, reach in (("left", first, gives), ("right", second, takes)):
        own = context.of_arm(arm)
        before = own.kinematics.tool(own.conf(BASE.array, reach.approach[0]))
        there = own.kinematics.tool(own.conf(BASE.array, reach.approach[-1]))
        assert there @ held.T_tool_body.matrix == pytest.approx(pose.matrix, abs=1e-5)
        assert np.linalg.inv(there) @ before[:, 3] == pytest.approx(
            [0.0, 0.0, -RETREAT_DISTANCE_M, 1.0], abs=1e-4
        )

    holding = context.of_arm("right", {"left": Stance(tuple(gives.approach[-1].tolist()), first)})
    free = holding.collisions.arrangement({}, None, fixed=False)
    for q in takes.approach:
        assert free.hits(holding.conf(BASE.array, q)) is None
    assert free.hits(holding.conf(BASE.array, holding.home)) is None


def test_fingers_that_would_be_in_the_body_are_no_exchange(context: Context) -> None:
    """Closed by 1 mm more than the bar is wide; the way there, with the hand open, is free."""
    first, second = grasp(-0.12), grasp(0.12)
    found = sample_handover(context, "left", "bar", first, "right", second, BASE, call(2))
    pose = next(one for one in found if isinstance(one, tuple))[0]
    for width, free in ((0.041, True), (0.039, False)):
        closer = dataclasses.replace(second, opening=width)
        got = handover._exchange(
            context, "left", "bar", first, "right", closer, BASE, pose, np.random.default_rng(0)
        )
        assert isinstance(got, tuple) is free


WIDE = {"left": 0.08, "right": 0.07}
FIRST, SECOND = Grasp("bar", Pose(), 0.04), Grasp("bar", Pose((0.0, 0.0, 0.1)), 0.03)
GIVES = Reach(np.array([[1.0], [2.0]]), np.array([[2.0], [3.0]]))
TAKES = Reach(np.array([[11.0], [12.0]]), np.array([[12.0], [13.0]]))


class Ways:
    """In the place of a context: notes under which stances, with what in hand, ways were asked for."""

    robot = SimpleNamespace(arms=[SimpleNamespace(arm=name, opening=WIDE[name]) for name in WIDE])

    def __init__(self, blocked: dict[tuple[str, str | None], tuple[str, str]]) -> None:
        self.blocked = blocked
        self.asked: list[tuple[str, dict[str, Stance], Grasp | None, float]] = []
        self.collisions = self

    def of_arm(self, arm: str, stances: dict[str, Stance]) -> Any:
        here = Ways(self.blocked)
        here.arm, here.stances, here.asked = arm, dict(stances), self.asked  # type: ignore[attr-defined]
        return here

    def attachment(self, held: Grasp) -> str:
        return held.body

    @staticmethod
    def conf(base: Any, joints: Array) -> Array:
        return np.array([*base, *joints])

    def arrangement(self, poses: Any, held: str | None, *, fixed: bool) -> Any:
        assert not fixed
        assert poses == {"cup": Pose()}
        found = self.blocked.get((self.arm, held))  # type: ignore[attr-defined]
        return SimpleNamespace(path_hits=lambda confs: found)

    def ways(self, load: Grasp | None, out: Array) -> Iterator[Array | Rejection]:
        self.asked.append((self.arm, self.stances, load, float(out[0])))  # type: ignore[attr-defined]
        yield Rejection("not yet")
        yield np.array([[0.0], out])


def planned(monkeypatch: pytest.MonkeyPatch, blocked: Any = ()) -> tuple[Ways, list[Any]]:
    context = Ways(dict(blocked))
    monkeypatch.setattr(
        handover, "arm_ways", lambda here, others, load, base, out, call: here.ways(load, out)
    )
    third = Grasp("jar", Pose(), 0.02)
    fluents = (
        ("holding", "left", "bar", FIRST), ("holding", "third", "jar", third),
        ("at-pose", "cup", Pose()),
    )  # fmt: skip
    shown = dataclasses.replace(call(), fluents=fluents)
    found = plan_handover(
        context,
        "left",
        "bar",
        FIRST,
        "right",
        SECOND,
        BASE,
        Pose(),
        GIVES,
        TAKES,
        shown,  # type: ignore[arg-type]
    )
    return context, list(found)


def test_a_handover_comes_in_its_order(monkeypatch: pytest.MonkeyPatch) -> None:
    """The giver brings, the taker comes and closes, the giver opens and goes home, the taker goes home."""
    _, found = planned(monkeypatch)
    assert found[:-1] == [Rejection("not yet")] * 4
    motion = found[-1]
    assert isinstance(motion, Motion)
    seen = [
        (one.arm, one.points[:, 0].tolist(), one.opening, one.holding)
        if isinstance(one, Path)
        else (one.arm, one.opening, one.attach, one.detach)
        for one in motion.segments
    ]
    assert seen == [
        ("left", [0.0, 3.0, 3.0, 2.0], 0.04, "bar"),
        ("right", [0.0, 11.0, 11.0, 12.0], 0.07, None),
        ("right", (0.07, 0.03), SECOND, None),
        ("left", (0.04, 0.08), None, "bar"),
        ("left", [2.0, 1.0, 1.0, 0.0], 0.08, None),
        ("right", [12.0, 13.0, 13.0, 0.0], 0.03, "bar"),
    ]
    assert isinstance(motion.segments[2], Grip)


def test_each_way_is_planned_among_arms_that_stand_as_they_then_do(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    context, _ = planned(monkeypatch)
    third = {"third": Stance(None, Grasp("jar", Pose(), 0.02))}
    gives, takes = Stance((2.0,), FIRST), Stance((12.0,), SECOND)
    assert context.asked == [
        ("left", third, FIRST, 3.0),
        ("right", third | {"left": gives}, None, 11.0),
        ("left", third | {"right": takes}, None, 1.0),
        ("right", third, SECOND, 13.0),
    ]


@pytest.mark.parametrize(
    ("arm", "held", "hit", "blockers", "before"),
    [
        ("left", "bar", ("bar", "cup"), ("cup",), 0), ("right", None, ("right_hand", "jar"), (), 1),
        ("left", None, ("left_hand", "cup"), ("cup",), 2), ("right", "bar", ("bar", "cup"), ("cup",), 3),
    ],
)  # fmt: skip
def test_a_body_in_the_way_of_a_last_stretch_is_named(
    arm: str, held: str | None, hit: tuple[str, str], blockers: tuple[str, ...], before: int,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    """What is in another hand is no body that could be taken away."""
    _, found = planned(monkeypatch, {(arm, held): hit}.items())
    assert found[:-1] == [Rejection("not yet")] * before
    assert found[-1] == Rejection.hits(hit[1], who=hit[0], blockers=blockers)
