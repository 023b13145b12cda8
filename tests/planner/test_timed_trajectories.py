"""Motions of a plan in time: how long each takes, in which circumstances, and what is timed twice."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Box
from tamp.geometric.values import Grasp, Grip, Motion, Path
from tamp.planner.timed_trajectories import (
    GRIP_DURATION_S,
    LOADED_SPEED_SHARE,
    PlanTimer,
    Segment,
    TimingCache,
    Trajectory,
    trajectories,
)
from tamp.symbolic.algorithms.result import PlanAction
from tests.geometric.making import body, scene, table

ROBOT = ROBOTS["panda_mobile"]()
HOME = np.array(ROBOT.home)
CUP, SPOON = (
    body(name, Box((0.06, 0.06, 0.1)), (x, 0.0, 0.55)) for name, x in (("Cup", 0.0), ("spoon", 0.3))
)
GRASP = Grasp("Cup", Pose((0.0, 0.0, 0.1)), 0.06)
RIDES = (("spoon", Pose((0.0, 0.0, 0.05))),)


class Place:
    """A context whose tool is 0.5 m ahead of the base and 0.8 m high, however the arm is; keeps among
    which bodies, and with what in the hand, a motion was looked at.
    """

    def __init__(
        self, steering: str = "se2", free: bool = True, holding: Grasp | None = None
    ) -> None:
        self.scene, self.robot, self.steering, self.holding = (
            scene(table(), CUP, SPOON),
            ROBOT,
            steering,
            holding,
        )
        self.home, self.free = HOME, free
        self.kinematics = SimpleNamespace(tool_plainly=self._tool)
        self.collisions = SimpleNamespace(arrangement=self._arrangement)
        self.among: list[tuple[dict[str, Pose], Any]] = []
        self.carried: list[tuple[str, Any]] = []

    def conf(self, base: Sequence[float], arm: Array) -> Array:
        return np.array([*base, *arm])

    def attachment(self, grasp: Grasp) -> Grasp:
        return grasp

    def loaded(self, name: str, load: Any) -> Place:
        self.carried.append((name, load))
        return self

    def _tool(self, conf: Array) -> Array:
        return Pose((conf[0] + 0.5, conf[1], 0.8)).matrix

    def _arrangement(self, poses: dict[str, Pose], attachment: Any) -> Any:
        self.among.append((dict(poses), attachment))
        return SimpleNamespace(edge_free=lambda a, b: self.free)


def drive(*rows: tuple[float, float, float], holding: str | None = None) -> Path:
    return Path("base", np.array(rows, dtype=float), 0.08, holding)


def reach(*rows: Array) -> Path:
    return Path("arm", np.array(rows), 0.04, "Cup", None)


def segments(place: Place, *items: Path | Grip, cache: TimingCache | None = None) -> list[Segment]:
    (found,) = trajectories(
        place, [PlanAction("do", ("m",))], {"m": Motion(items)}, cache  # type: ignore[arg-type]
    )  # fmt: skip
    return list(found.segments)


def shortest(way: float, fastest: float, harshest: float) -> float:
    """Seconds from rest to rest, by a ramp up and a ramp down."""
    if way > fastest**2 / harshest:
        return way / fastest + fastest / harshest
    return 2 * math.sqrt(way / harshest)


FASTEST, HARSHEST = ROBOT.velocity[0], ROBOT.acceleration[0]


@pytest.mark.parametrize("way", [0.1, 2.0])
def test_a_straight_way_takes_as_long_as_the_limits_ask_for(way: float) -> None:
    (found,) = segments(Place(), drive((0, 0, 0), (way, 0, 0)))
    assert found.times[-1] == pytest.approx(shortest(way, FASTEST, HARSHEST), rel=1e-3)
    assert found.positions[[0, -1]] == pytest.approx(np.array([[0, 0, 0], [way, 0, 0]]))
    assert (found.part, found.opening, found.times[0]) == ("base", 0.08, 0.0)


def test_each_joint_has_its_own_limits() -> None:
    for joint in (0, 6):
        there = HOME.copy()
        there[joint] += 0.5
        (found,) = segments(Place(), reach(HOME, there))
        limits = ROBOT.velocity[3 + joint], ROBOT.acceleration[3 + joint]
        assert found.times[-1] == pytest.approx(shortest(0.5, *limits), rel=1e-3)
        assert found.part == "arm" and found.holding == "Cup"


def test_with_others_on_it_a_body_is_carried_half_as_fast() -> None:
    path = drive((0, 0, 0), (1.0, 0, 0), holding="Cup")
    alone = segments(Place(), Grip((0.08, 0.06), GRASP), path)[1]
    place = Place()
    loaded = segments(place, Grip((0.08, 0.06), GRASP, load=RIDES), path)[1]
    assert LOADED_SPEED_SHARE == 0.5
    assert loaded.times[-1] == pytest.approx(2.0 * alone.times[-1], rel=1e-3)
    assert place.carried == [("Cup", RIDES)]
    (poses, attached) = place.among[-1]
    assert {*poses} == set() and attached is GRASP


@pytest.mark.parametrize(
    ("opening", "seconds"),
    [
        ((0.08, 0.06), GRIP_DURATION_S),
        ((0.08, 0.0), 0.08 / (2 * ROBOT.finger_speed)),
        ((0.05, 0.05), GRIP_DURATION_S),
    ],
)
def test_fingers_take_half_a_second_or_what_their_speed_asks_for(
    opening: tuple[float, float], seconds: float
) -> None:
    (found,) = segments(Place(), Grip(opening, GRASP))
    assert found.times.tolist() == [0.0, pytest.approx(seconds)]
    assert found.positions.tolist() == [[opening[0]], [opening[1]]]
    assert (found.part, found.opening, found.attach) == ("gripper", opening[1], GRASP)


def test_a_body_is_where_it_was_put_down_with_what_rode_on_it() -> None:
    place = Place()
    segments(
        place,
        drive((0, 0, 0), (1.0, 0, 0)),
        Grip((0.08, 0.06), GRASP, load=RIDES),
        drive((1.0, 0, 0), (1.0, 2.0, 0), holding="Cup"),
        Grip((0.06, 0.08), detach="Cup"),
        drive((1.0, 2.0, 0), (0, 0, 0)),
    )
    before, meanwhile, after = place.among
    assert before[0] == {"Cup": CUP.pose, "spoon": SPOON.pose} and before[1] is None
    assert meanwhile == ({}, GRASP)
    assert after[1] is None
    assert after[0]["Cup"].position == pytest.approx((1.5, 2.0, 0.9))
    assert after[0]["spoon"].position == pytest.approx((1.5, 2.0, 0.95))


def test_what_is_in_the_hand_at_the_start_is_carried_from_there() -> None:
    place = Place(holding=GRASP)
    segments(place, drive((0, 0, 0), (1.0, 0, 0)), Grip((0.06, 0.08), detach="Cup"))
    assert place.among == [({"spoon": SPOON.pose}, GRASP)]
    opening = segments(place, Grip((0.06, 0.08), detach="Cup"))[0]
    assert opening.detach == "Cup" and opening.attach is None


def test_whole_turns_are_not_lost_between_drives() -> None:
    first, second = segments(
        Place(),
        drive((0, 0, 0), (0, 0, 3.5)),
        drive((0, 0, 3.5 - math.tau), (0, 0, 4.0 - math.tau)),
    )
    assert first.positions[-1, 2] == 3.5
    assert second.positions[[0, -1], 2] == pytest.approx([3.5, 4.0])


CORNER = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0))


@pytest.mark.parametrize(
    ("steering", "free", "rounded"),
    [
        ("se2", True, True),
        ("se2", False, False),
        ("differential", True, False),
        ("reeds-shepp", True, False),
    ],
)
def test_a_corner_is_rounded_where_that_is_free_and_the_base_may_slide(
    steering: str, free: bool, rounded: bool
) -> None:
    (found,) = segments(Place(steering, free), drive(*CORNER))
    nearest = np.abs(found.positions - CORNER[1]).max(axis=1).min()
    assert bool(nearest > 1e-3) is rounded
    assert found.positions[-1] == pytest.approx(CORNER[2])


def test_an_arms_corners_are_rounded_however_the_base_drives() -> None:
    rows = HOME + np.array([[0.0] * 7, [0.5] + [0.0] * 6, [0.5, 0.5] + [0.0] * 5])
    (found,) = segments(Place("differential"), reach(*rows))
    assert np.abs(found.positions - rows[1]).max(axis=1).min() > 1e-3


def test_a_path_is_timed_once_in_the_same_circumstances() -> None:
    cache: TimingCache = {}
    there, back = drive((0, 0, 0), (1.0, 0, 0)), drive((1.0, 0, 0), (0, 0, 0))
    start, first = drive((0, -2, 0), (0, 0, 0)), Place()
    one = segments(first, start, there, back, there, cache=cache)
    assert one[1] is one[3] and len(first.among) == 3
    other = Place()
    again = segments(other, start, there, cache=cache)
    assert again[1] is one[1] and other.among == []

    held = segments(other, start, Grip((0.08, 0.06), GRASP), there, cache=cache)
    assert held[2] is not one[1] and len(other.among) == 1
    lower = replace(GRASP, T_tool_body=Pose((0.0, 0.0, 0.12)))
    otherwise = segments(other, start, Grip((0.08, 0.06), lower), there, cache=cache)
    assert otherwise[2] is not held[2] and len(other.among) == 2
    assert segments(Place(), there, cache=cache)[0] is not one[1]  # from where the robot starts


def test_each_action_has_the_motions_among_its_arguments() -> None:
    values = {"m": Motion((drive((0, 0, 0), (1.0, 0, 0)),)), "p": Pose(), "n": Motion(())}
    actions = [PlanAction("move", ("cup", "p", "m")), PlanAction("wait", ("p", "n", "gone"))]
    found = trajectories(Place(), actions, values)  # type: ignore[arg-type]
    assert [len(one.segments) for one in found] == [1, 0]
    assert found[1] == Trajectory(()) or found[1].duration == 0.0


class Two(Place):
    """The same with two arms, of which each is a context of its own."""

    def __init__(self) -> None:
        super().__init__()
        self.others: list[tuple[str, dict[str, Any]]] = []

    def of_arm(self, name: str, others: Any = None) -> Two:
        if others is not None:
            self.others.append((name, dict(others)))
        return self


def test_while_one_arm_moves_the_other_one_stays_where_it_got_to() -> None:
    place = Two()
    up = HOME + 0.2
    timer = PlanTimer(place, {})  # type: ignore[arg-type]
    left, right = (Path("arm", np.array([HOME, up]), 0.08, arm=name) for name in ("left", "right"))
    timer.segments(Motion((left, Grip((0.08, 0.06), GRASP, arm="left"), right)))
    assert place.others[0] == ("left", {})
    name, others = place.others[-1]
    assert name == "right" and {*others} == {"left"}
    assert others["left"].joints == pytest.approx(tuple(up)) and others["left"].grasp is GRASP
    timer.segments(Motion((Path("arm", np.array([up, HOME]), 0.08, arm="left"),)))
    name, others = place.others[-1]
    assert name == "left" and {*others} == {"right"} and others["right"].grasp is None
