"""Detection of deviations: what is seen beside what the plan expects."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from tamp.geometric.scene.pose import Array, pose_difference
from tamp.symbolic.pddl.structs import Fact

MAX_DISPLACEMENT_M = 0.01
"""Metres by which a body may stand elsewhere than expected, or be elsewhere in the hand."""

MAX_TURN_RAD = math.radians(12.0)
"""Radians by which it may be turned."""

TOLD_DISPLACEMENT_M = 0.005
"""Metres: a body that nobody handles and that moved less is not worth a line,"""

TOLD_TURN_RAD = 0.09
"""nor one that turned less, radians."""

TOPPLED_TILT_RAD = math.radians(30.0)
"""A body that is tilted by more than this against what was expected has fallen over."""

DEVIATION_KINDS = {
    "lost": "the hand should hold a body and does not",
    "slipped": "a body is elsewhere in the hand",
    "stuck": "the hand holds a body that it should not",
    "toppled": "a body has fallen over",
    "misplaced": "a body that was just put down is not where it should be",
    "displaced": "a body that the action does not touch has moved",
    "gone": "a body is not there any more",
    "new": "there is a body that the plan does not know",
    "fact": "a relation that should hold does not",
}
"""The kinds of deviations."""


@dataclass(frozen=True)
class Deviation:
    """One thing that is not as expected: its kind of KINDS, the body, a sentence, metres and
    radians.
    """

    kind: str
    body: str
    message: str
    moved: float = 0.0
    turned: float = 0.0


@dataclass(frozen=True, eq=False)
class Seen:
    """An observation: T_world_body (4, 4) of all bodies that can move, the body in the hand, the
    tool (4, 4), facts.
    """

    poses: Mapping[str, Array]
    held: str | None
    tool: Array
    facts: frozenset[Fact]


def deviations(
    poses: Mapping[str, Array],
    held: tuple[str, Array] | None,
    facts: frozenset[Fact],
    seen: Seen,
    active: str | None,
    new: frozenset[str] = frozenset(),
) -> Iterator[Deviation]:
    """Yield the deviations of what is seen from what is expected.

    Args:
        poses: T_world_body expected of bodies that stand.
        held: The body expected in the hand and its T_tool_body.
        facts: Expected of bodies and places.
        seen: What is so.
        active: The body that the last action handled.
        new: Bodies that the plan does not know.
    """
    for name in sorted(new):
        yield Deviation("new", name, f"{name} was not there when the plan was made")

    told: set[str] = set()
    for name, T in ({**poses, held[0]: None} if held else dict(poses)).items():
        if name not in seen.poses:
            told.add(name)
            yield Deviation("gone", name, f"{name} is gone")
        elif T is None and held is not None:
            yield from _in_hand(name, held[1], seen)
        elif T is not None and name == seen.held:
            yield Deviation("stuck", name, f"{name} is still in the hand")
        elif T is not None:
            moved, turned = pose_difference(T, seen.poses[name])
            if moved > MAX_DISPLACEMENT_M or turned > MAX_TURN_RAD:
                told.add(name)
                yield _elsewhere(name, T, seen.poses[name], name == active)

    if held is not None:
        told.add(held[0])
    for fact in sorted(facts - seen.facts):
        if not {name.lower() for name in told} & {*fact[1:]}:
            yield Deviation(
                "fact", fact[1] if fact[1:] else "", f"({' '.join(fact)}) does not hold"
            )


def _in_hand(name: str, T_tool_body: Array, seen: Seen) -> Iterator[Deviation]:
    if seen.held != name:
        yield Deviation("lost", name, f"{name} is not in the hand")
        return
    moved, turned = pose_difference(T_tool_body, np.linalg.inv(seen.tool) @ seen.poses[name])
    if moved > MAX_DISPLACEMENT_M or turned > MAX_TURN_RAD:
        yield Deviation(
            "slipped",
            name,
            f"{name} is {_off(moved, turned)} from where the hand held it",
            moved,
            turned,
        )


def _elsewhere(name: str, T_expected: Array, T_seen: Array, active: bool) -> Deviation:
    moved, turned = pose_difference(T_expected, T_seen)
    up = float(
        np.clip(
            (T_expected[:3, :3].T @ [0.0, 0.0, 1.0]) @ (T_seen[:3, :3].T @ [0.0, 0.0, 1.0]),
            -1.0,
            1.0,
        )
    )
    if math.acos(up) > TOPPLED_TILT_RAD:
        return Deviation(
            "toppled", name, f"{name} has fallen over, {1000 * moved:.0f} mm away", moved, turned
        )
    kind = "misplaced" if active else "displaced"
    return Deviation(
        kind, name, f"{name} is {_off(moved, turned)} from where it should be", moved, turned
    )


def _off(moved: float, turned: float) -> str:
    return f"{1000 * moved:.0f} mm, {math.degrees(turned):.0f}°"
