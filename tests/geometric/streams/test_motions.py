"""Motions of whole actions by hand: which arrangement is asked, who is named, in which order segments come."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tamp.geometric.motion.result import Failure, MotionResult
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.streams import motions
from tamp.geometric.values import BaseConf, Grasp, Grip, Motion, Path, Reach
from tamp.stream import Call, Rejection, RejectionKind
from tamp.system.deadline import Deadline

HOME = np.zeros(7)
ROBOT = SimpleNamespace(turning_radius=None, opening=0.08)
GRASP = Grasp("mug", Pose((0.0, 0.0, 0.1)), 0.03)
HERE, THERE = Pose((1.0, 0.0, 0.5)), Pose((2.0, 0.0, 0.5))
REACH = Reach(np.full((2, 7), 0.5), np.array([np.full(7, 0.5), np.full(7, 0.4)]))
Plan = Callable[["Among", int], Array | Failure]


class Among:
    """An arrangement: whose bodies stand where, and what is in hand; edges are free but for some."""

    def __init__(self, world: World, poses: dict[str, Pose], held: Any, fixed: bool) -> None:
        self.world, self.poses, self.held, self.fixed = world, poses, held, fixed

    def edge_free(self, start: Array, end: Array) -> bool:
        return self.world.in_the_way.isdisjoint(self.poses)

    def hits(self, conf: Array) -> tuple[str, str] | None:
        return ("base", "wall") if self.world.wall[0] < conf[0] < self.world.wall[1] else None


class World:
    """In the place of a context: tells in which arrangements plans were asked for, at which effort.

    `answer` gives a path or the failure. `in_the_way` are the bodies that edges run into.
    """

    home, robot, steering, planner = HOME, ROBOT, "se2", "compiled"
    scene = SimpleNamespace(room=None)

    def __init__(self, answer: Plan, in_the_way: set[str] | None = None) -> None:
        self.answer, self.in_the_way = answer, in_the_way or set()
        self.asked: list[tuple[set[str], Any, int]] = []
        self.wall = (math.inf, math.inf)
        self.collisions = self
        self.passage = SimpleNamespace(narrow=lambda goal: None)
        self.carried: list[tuple[str, Any]] = []

    def arrangement(self, poses: dict[str, Pose], held: Any = None, fixed: bool = True) -> Among:
        return Among(self, dict(poses), held, fixed)

    def fixed_only(self, held: Grasp | None) -> Among:
        return Among(self, {}, held and held.body, True)

    def attachment(self, held: Grasp) -> str:
        return held.body

    def loaded(self, body: str, load: Any) -> World:
        self.carried.append((body, load))
        return self

    @staticmethod
    def conf(base: Any, arm: Array) -> Array:
        return np.array([*base, *arm])

    def plan(self, among: Among, effort: int) -> MotionResult:
        self.asked.append((set(among.poses), among.held, effort))
        found = self.answer(among, effort)
        return (
            MotionResult(None, found, 1)
            if isinstance(found, Failure)
            else MotionResult(found, None, 1)
        )


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> Callable[..., World]:
    """A world that answers both planners."""

    def make(answer: Plan, in_the_way: set[str] | None = None) -> World:
        world = World(answer, in_the_way)
        monkeypatch.setattr(
            motions, "plan_base", lambda among, *more, effort, **rest: world.plan(among, effort)
        )
        monkeypatch.setattr(
            motions, "plan_arm", lambda among, *more, effort, **rest: world.plan(among, effort)
        )
        return world

    return make


def call(*fluents: tuple[Any, ...]) -> Call:
    return Call(np.random.default_rng(0), Deadline(math.inf), fluents)


def at_base(x: float = 0.0) -> tuple[str, BaseConf]:
    return ("at-base", BaseConf(x, 0.0, 0.0))


GOAL = BaseConf(3.0, 0.0, 0.5)
WAY = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.5]])
ARM_WAY = np.array([HOME, np.full(7, 0.2), np.full(7, 0.4)])


def free(among: Among, effort: int) -> Array:
    return WAY


def first(tries: Iterator[Any], count: int = 20) -> list[Any]:
    return list(itertools.islice(tries, count))


def test_a_drive_with_an_empty_hand(made: Callable[..., World]) -> None:
    world = made(free)
    (found,) = first(
        motions.plan_base_motion(world, GOAL, call(at_base(), ("at-pose", "mug", HERE))), 1
    )
    (segment,) = found.segments
    assert segment.part == "base" and segment.points is WAY
    assert (segment.opening, segment.holding) == (ROBOT.opening, None)
    assert world.asked == [({"mug"}, None, 0)]
    assert world.carried == []


def test_a_drive_with_a_body_in_hand_carries_its_load_too(made: Callable[..., World]) -> None:
    world = made(free)
    riding = ("riding", "spoon", THERE, "mug", HERE)
    fluents = (at_base(), ("holding", "mug", GRASP), riding, ("at-pose", "can", HERE))
    (found,) = first(motions.plan_base_motion(world, GOAL, call(*fluents)), 1)
    (segment,) = found.segments
    assert (segment.opening, segment.holding) == (GRASP.opening, "mug")
    assert world.asked == [({"can"}, "mug", 0)]
    ((body, ((rider, T),)),) = world.carried
    assert (body, rider) == ("mug", "spoon") and np.allclose(T.position, (1.0, 0.0, 0.0))


def test_tries_grow_in_effort_and_come_to_an_end(made: Callable[..., World]) -> None:
    world = made(lambda among, effort: Failure.EXHAUSTED)
    found = first(motions.plan_base_motion(world, GOAL, call(at_base(), ("at-pose", "mug", HERE))))
    assert len(found) == motions.MAX_EFFORT + 1
    assert all(one.kind is RejectionKind.NO_MOTION for one in found)
    # at each effort the question itself, and that among the fixed bodies alone
    assert world.asked == [
        (bodies, None, effort)
        for effort in range(motions.MAX_EFFORT + 1)
        for bodies in ({"mug"}, set())
    ]


@pytest.mark.parametrize("failure", [Failure.START, Failure.GOAL, Failure.LIMITS])
def test_a_failure_that_no_effort_mends_is_the_last(
    failure: Failure, made: Callable[..., World]
) -> None:
    world = made(lambda among, effort: failure)
    (found,) = first(motions.plan_base_motion(world, GOAL, call(at_base())))
    assert found.reason == f"no motion even without the movable bodies: {failure.value}"


def test_each_further_question_of_an_effort_is_another_path(made: Callable[..., World]) -> None:
    answers = iter([WAY, WAY + 1, Failure.EXHAUSTED, WAY, WAY, Failure.START, WAY])
    world = made(lambda among, effort: next(answers) if among.poses else WAY)
    fluents = call(at_base(), ("at-pose", "mug", HERE))
    found = first(motions.plan_base_motion(world, GOAL, fluents))
    assert [isinstance(one, Motion) for one in found] == [True, True, False, True, True, False]


def test_bodies_in_the_way_are_those_that_a_way_among_the_fixed_runs_into(
    made: Callable[..., World],
) -> None:
    world = made(
        lambda among, effort: WAY if not among.poses else Failure.EXHAUSTED, {"box", "can"}
    )
    fluents = (at_base(), *(("at-pose", name, HERE) for name in ("box", "mug", "can")))
    told = first(motions.plan_base_motion(world, GOAL, call(*fluents)), 1)[0]
    assert told == Rejection(
        "way blocked by box and can", ("box", "can"), kind=RejectionKind.BLOCKED
    )


def test_where_nothing_is_in_the_way_nothing_is_blamed(made: Callable[..., World]) -> None:
    world = made(lambda among, effort: WAY if not among.poses else Failure.EXHAUSTED)
    told = first(
        motions.plan_base_motion(world, GOAL, call(at_base(), ("at-pose", "mug", HERE))), 1
    )
    assert told == [Rejection("no motion found", kind=RejectionKind.NO_MOTION)]


@pytest.mark.parametrize(("wall", "named"), [((1.0, 2.0), ("wall",)), ((5.0, 6.0), ())])
def test_what_is_straight_ahead_is_said(
    wall: tuple[float, float], named: tuple[str, ...], made: Callable[..., World]
) -> None:
    world = made(lambda among, effort: Failure.EXHAUSTED)
    world.wall = wall
    told = first(motions.plan_base_motion(world, GOAL, call(at_base())), 1)[0]
    assert told.bodies == named and told.blockers == ()
    assert ("(straight ahead: wall)" in told.reason) is bool(named)


def test_a_narrow_gap_is_looked_for_from_the_second_effort_on_when_the_base_moves(
    made: Callable[..., World],
) -> None:
    world = made(lambda among, effort: Failure.EXHAUSTED)
    gap = SimpleNamespace(text="the door is 0.4 m wide", bodies=("door",))
    world.passage.narrow = lambda goal: gap
    found = first(motions.plan_base_motion(world, GOAL, call(at_base())))
    assert ["door" in one.bodies for one in found] == [
        effort >= motions.DIAGNOSIS_EFFORT for effort in range(motions.MAX_EFFORT + 1)
    ]
    assert found[-1].reason.endswith("the door is 0.4 m wide")
    here = BaseConf(0.0, 0.0, 1.0)  # it only turns: no door is in question
    turned = first(motions.plan_base_motion(world, here, call(at_base())))
    assert not any("door" in one.bodies for one in turned)


def pick(world: World, *fluents: tuple[Any, ...], count: int = 1) -> list[Any]:
    base = BaseConf(0.0, 0.0, 0.0)
    return first(motions.plan_pick(world, "mug", HERE, GRASP, base, REACH, call(*fluents)), count)


AT = ("at-pose", "mug", HERE), ("at-pose", "can", THERE)


def test_a_pick_goes_to_the_body_closes_the_hand_and_goes_home_with_it(
    made: Callable[..., World],
) -> None:
    world = made(lambda among, effort: ARM_WAY)
    (found,) = pick(world, *AT)
    out, grip, back = found.segments
    assert isinstance(out, Path) and isinstance(grip, Grip) and isinstance(back, Path)
    assert np.array_equal(out.points, [*ARM_WAY, *REACH.approach])
    assert (out.part, out.opening, out.holding) == ("arm", ROBOT.opening, None)
    assert grip.opening == (ROBOT.opening, GRASP.opening)
    assert (grip.attach, grip.detach) == (GRASP, None)
    # from the lift's end the same way back: that end is not there twice
    assert np.array_equal(back.points, [*REACH.lift, *ARM_WAY[::-1][1:]])
    assert (back.part, back.opening, back.holding) == ("arm", GRASP.opening, "mug")


def test_one_path_serves_both_ways_where_it_is_free_with_the_body_in_place(
    made: Callable[..., World],
) -> None:
    world = made(lambda among, effort: ARM_WAY)
    pick(world, *AT)
    assert world.asked == [({"can"}, "mug", 0)]  # with the mug in hand, it stands nowhere


def test_else_the_way_there_is_planned_with_the_body_in_place(made: Callable[..., World]) -> None:
    other = ARM_WAY + 0.01
    world = made(lambda among, effort: ARM_WAY if among.held else other, {"mug"})
    (found,) = pick(world, *AT)
    assert world.asked == [({"can"}, "mug", 0), ({"can", "mug"}, None, 0)]
    assert np.array_equal(found.segments[0].points[: len(other)], other)
    assert np.array_equal(found.segments[2].points[len(REACH.lift) :], ARM_WAY[::-1][1:])


def test_why_there_is_no_way_with_the_body_is_passed_on(made: Callable[..., World]) -> None:
    world = made(lambda among, effort: Failure.EXHAUSTED if among.poses else ARM_WAY, {"can"})
    assert pick(world, *AT) == [
        Rejection("way blocked by can", ("can",), kind=RejectionKind.BLOCKED)
    ]


def test_why_there_is_no_way_there_is_passed_on(made: Callable[..., World]) -> None:
    world = made(lambda among, effort: Failure.START if "mug" in among.poses else ARM_WAY, {"mug"})
    told = pick(world, *AT)[0]
    assert isinstance(told, Rejection) and told.blockers == ("mug",)


def test_a_placement_is_a_pick_backwards(made: Callable[..., World]) -> None:
    world = made(lambda among, effort: ARM_WAY)
    base = BaseConf(0.0, 0.0, 0.0)
    arguments = world, "mug", HERE, GRASP, base, REACH, call(*AT)
    (picked,), (placed,) = (
        first(function(*arguments), 1) for function in (motions.plan_pick, motions.plan_place)
    )
    for there, back in zip(picked.segments, reversed(placed.segments), strict=True):
        if isinstance(there, Grip):
            assert isinstance(back, Grip)
            assert back.opening == (GRASP.opening, ROBOT.opening)
            assert (back.attach, back.detach) == (None, "mug")
        else:
            assert np.array_equal(back.points, there.points[::-1])
            assert (back.opening, back.holding) == (there.opening, there.holding)


def test_a_placement_that_cannot_be_reached_says_why(made: Callable[..., World]) -> None:
    world = made(lambda among, effort: Failure.GOAL)
    base = BaseConf(0.0, 0.0, 0.0)
    (told,) = first(motions.plan_place(world, "mug", HERE, GRASP, base, REACH, call(*AT)))
    assert isinstance(told, Rejection) and told.kind is RejectionKind.NO_MOTION


def test_what_rides_on_a_body_makes_it_a_loaded_pick(
    made: Callable[..., World], monkeypatch: pytest.MonkeyPatch
) -> None:
    heard: list[Any] = []
    monkeypatch.setattr(
        motions, "plan_loaded_pick", lambda *arguments: iter([heard.append(arguments[5])])
    )
    pick(made(free), *AT, ("riding", "spoon", THERE, "mug", HERE))
    ((rider, _),) = heard[0]
    assert rider == "spoon"
    assert pick(made(lambda among, effort: ARM_WAY), *AT) and len(heard) == 1
