"""Streams told of an arm: whose context they get, how the others stand, and what is in their way."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tamp.geometric.scene.pose import Pose
from tamp.geometric.streams import by_arms
from tamp.geometric.streams.by_arms import CARRIED_CLEARANCE_M, by_arm, carried, of_arm
from tamp.geometric.values import BaseConf, Grasp, Grip, Motion, Reach, Stance
from tamp.geometric.values import Path as Polyline
from tamp.stream import Call, Rejection
from tamp.system.deadline import Deadline


def call(*fluents: tuple[Any, ...]) -> Call:
    return Call(np.random.default_rng(0), Deadline(math.inf), fluents)


def grasp(width: float) -> Grasp:
    return Grasp("cup", Pose(), width)


def test_the_others_stand_with_what_they_hold() -> None:
    first, second = grasp(0.05), grasp(0.06)
    shown = call(
        ("holding", "left", "cup", first), ("holding", "right", "jar", second),
        ("at-pose", "pan", Pose()),
    )  # fmt: skip
    assert carried(shown, "left") == {"right": Stance(None, second)}
    assert carried(shown, "right") == {"left": Stance(None, first)}
    assert carried(shown, "left", "right") == {}
    assert set(carried(shown)) == {"left", "right"}
    assert carried(call()) == {}


class Contexts:
    """Hands out a name for the context of an arm."""

    def of_arm(self, arm: str) -> str:
        return f"context of {arm}"


def test_a_stream_of_one_arm_is_served_with_that_arms_context() -> None:
    seen: list[Any] = []

    def stream(context: str, *inputs: str, call: Call) -> str:
        seen.append((context, inputs, call))
        return "found"

    made = call()
    assert by_arm(stream)(Contexts(), "left", "cup", "p1", call=made) == "found"  # type: ignore[arg-type]
    assert seen == [("context of left", ("cup", "p1"), made)]


def test_every_segment_says_whose_it_is() -> None:
    path, grip = Polyline("base", np.zeros((2, 3)), 0.08), Grip((0.08, 0.05))
    motion = of_arm(Motion((path, grip)), "left")
    assert [segment.arm for segment in motion.segments] == ["left", "left"]
    assert motion.segments[1].opening == (0.08, 0.05)
    assert path.arm is None and grip.arm is None  # values never change


class Room:
    """A context, its collision layer and an arrangement in one: what is hit on the way in and out."""

    def __init__(self, hits: dict[bool, tuple[str, str]]) -> None:
        self._hits = hits
        self.others: dict[str, Stance] = {}
        self.asked: list[tuple[bool, int, float]] = []

    @property
    def collisions(self) -> Room:
        return self

    def of_arm(self, arm: str, others: dict[str, Stance]) -> Room:
        self.others = others
        return self

    def attachment(self, grasp: Grasp) -> str:
        return grasp.body

    def conf(self, base: tuple[float, float, float], joints: Any) -> Any:
        return np.array([*base, *joints])

    def arrangement(self, poses: Any, attached: str | None, *, fixed: bool) -> Any:
        assert poses == {} and not fixed  # bodies at rest were tested before
        loaded = attached is not None

        def path_hits(confs: Any, *, padding: float) -> tuple[str, str] | None:
            self.asked.append((loaded, len(confs), padding))
            return self._hits.get(loaded)

        return SimpleNamespace(path_hits=path_hits)


REACH = Reach(np.zeros((4, 7)), np.zeros((3, 7)))


def planned(room: Room, monkeypatch: pytest.MonkeyPatch, shown: Call) -> list[Any]:
    found = [Rejection("too far"), Motion((Grip((0.08, 0.05)),))]
    monkeypatch.setattr(by_arms, "plan_pick", lambda *_: iter(found))
    arguments = "left", "cup", Pose(), grasp(0.05), BaseConf(0.0, 0.0, 0.0), REACH, shown
    return list(by_arms.plan_pick_by(room, *arguments))  # type: ignore[arg-type]


def test_a_free_reach_is_planned_among_what_the_others_hold(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    room, other = Room({}), grasp(0.06)
    own = ("holding", "left", "cup", grasp(0.05))
    refused, motion = planned(room, monkeypatch, call(own, ("holding", "right", "jar", other)))
    assert refused == Rejection("too far")
    assert motion.segments[0].arm == "left"
    assert room.others == {"right": Stance(None, other)}
    # The way in with an empty hand, the way out with the body in it.
    assert room.asked == [(False, 4, CARRIED_CLEARANCE_M), (True, 3, CARRIED_CLEARANCE_M)]


@pytest.mark.parametrize("loaded", [False, True], ids=["on the way in", "on the way out"])
def test_a_reach_that_meets_what_another_arm_holds_is_not_planned(
    loaded: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    (refused,) = planned(Room({loaded: ("left_hand", "jar")}), monkeypatch, call())
    assert refused == Rejection.hits("jar", who="left_hand")
