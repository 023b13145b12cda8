"""What is in the robot's hands: what is bound, or between both fingers while they press."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tamp.execution import hands
from tamp.execution.hands import in_hand, in_hands, in_other_hands
from tamp.simulation.actuation import Hand


class World:
    """Two arms of two fingers each, "l1" and "l2", "r1" and "r2"; the left one is in use."""

    def __init__(
        self, touching: str = "", left: Hand | None = None, right: Hand | None = None
    ) -> None:
        self.arms = [
            SimpleNamespace(
                arm=name, finger_links=[SimpleNamespace(name=f"{name[0]}{k}") for k in "12"]
            )
            for name in ("left", "right")
        ]
        self.hands = [left or Hand(0.08), right or Hand(0.08)]
        self.scene = SimpleNamespace(movable=("cup", "jar"))
        self.used = 0
        self._pairs = [tuple(pair.split("-")) for pair in touching.split()]

    def touches(self) -> dict[Any, float]:
        return dict.fromkeys(self._pairs, 1.0)

    def tool(self) -> Any:
        return np.eye(4) * (1 + self.used)  # tells whose


PRESSING = Hand(0.08, squeezing=True)


@pytest.mark.parametrize(
    ("touching", "hand", "held"),
    [
        ("l1-cup l2-cup", PRESSING, "cup"), ("l1-cup", PRESSING, None), ("l1-cup l2-jar", PRESSING, None),
        ("l1-cup l1-jar l2-jar", PRESSING, "jar"), ("l1-cup r2-cup", PRESSING, None),
        ("l1-cup l2-cup", Hand(0.08), None), ("l1-table l2-table", PRESSING, None), ("", PRESSING, None),
        ("cup-l1 l2-cup", PRESSING, None), ("", Hand(0.08, bound="jar"), "jar"),
        ("l1-cup l2-cup", Hand(0.08, squeezing=True, bound="jar"), "jar"),
    ],
)  # fmt: skip
def test_both_fingers_touch_what_is_held_or_it_is_bound(
    touching: str, hand: Hand, held: str | None
) -> None:
    """Links come first in a pair; what cannot be moved is not held; open fingers hold nothing."""
    assert in_hand(World(touching, hand), 0) == held  # type: ignore[arg-type]


def test_each_hand_by_its_arm() -> None:
    world = World("r1-cup r2-cup", Hand(0.08, bound="jar"), PRESSING)
    assert in_hands(world) == {"left": "jar", "right": "cup"}  # type: ignore[arg-type]
    assert in_hands(World()) == {"left": None, "right": None}  # type: ignore[arg-type]


def test_what_other_hands_should_hold_is_looked_at_by_their_own_tools(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Not the hand in use, nor one that should be empty; whoever asks finds the hand in use as it was."""
    asked: list[Any] = []

    def noted(poses: Any, held: Any, facts: Any, seen: Any, active: Any) -> Any:
        asked.append((held, seen.held, float(seen.tool[0, 0]), dict(seen.poses)))
        yield "one"
        assert world.used == 0
        yield "two"

    monkeypatch.setattr(hands, "deviations", noted)
    world = World("r1-cup r2-cup", Hand(0.08, bound="jar"), PRESSING)
    poses = {"cup": np.eye(4)}
    cup, jar = ("cup", np.eye(4)), ("jar", np.eye(4))
    expected: Any = SimpleNamespace(in_hands={"right": cup, "left": jar})
    found = in_other_hands(world, expected, poses)  # type: ignore[arg-type]
    assert next(found) == "one"
    assert world.used == 0
    assert list(found) == ["two"]
    assert [entry[:3] for entry in asked] == [(cup, "cup", 2.0)]
    assert asked[0][3].keys() == {"cup"}

    nothing: Any = SimpleNamespace(in_hands={"left": jar, "right": None})
    assert list(in_other_hands(world, nothing, poses)) == []  # type: ignore[arg-type]


def test_a_body_that_was_lost_from_another_hand_is_told() -> None:
    expected: Any = SimpleNamespace(in_hands={"right": ("cup", np.eye(4))})
    (lost,) = in_other_hands(World("r1-cup", right=PRESSING), expected, {"cup": np.eye(4)})  # type: ignore[arg-type]
    assert (lost.kind, lost.body) == ("lost", "cup")
