"""Deviations have the kind that a person would give them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp.execution.deviation import DEVIATION_KINDS, Seen, deviations
from tamp.geometric.scene.pose import Array, Pose

HERE = Pose((1.0, 0.0, 0.5)).matrix
TOOL = Pose((0.0, 0.0, 1.0)).matrix


def at(x: float, roll: float = 0.0) -> Array:
    return Pose.from_xyz_rpy((x, 0.0, 0.5), (roll, 0.0, 0.0)).matrix


@pytest.mark.parametrize(
    ("poses", "held", "facts", "seen", "kinds"),
    [
        (
            {"a": HERE},
            None,
            [("on", "a", "s")],
            Seen({"a": HERE}, None, TOOL, frozenset({("on", "a", "s")})),
            [],
        ),
        ({"a": HERE}, None, [], Seen({"a": at(1.004)}, None, TOOL, frozenset()), []),
        ({"a": HERE}, None, [], Seen({"a": at(1.03)}, None, TOOL, frozenset()), ["displaced"]),
        ({"b": HERE}, None, [], Seen({"b": at(1.03)}, None, TOOL, frozenset()), ["misplaced"]),
        (
            {"a": HERE},
            None,
            [],
            Seen({"a": at(1.0, math.pi / 2)}, None, TOOL, frozenset()),
            ["toppled"],
        ),
        ({"a": HERE}, None, [], Seen({}, None, TOOL, frozenset()), ["gone"]),
        ({"a": HERE}, None, [], Seen({"a": HERE}, "a", TOOL, frozenset()), ["stuck"]),
        (
            {"a": HERE},
            None,
            [("on", "a", "s")],
            Seen({"a": HERE}, None, TOOL, frozenset()),
            ["fact"],
        ),
        ({}, ("a", np.eye(4)), [], Seen({"a": HERE}, None, TOOL, frozenset()), ["lost"]),
        ({}, ("a", np.eye(4)), [], Seen({"a": TOOL}, "a", TOOL, frozenset()), []),
        ({}, ("a", np.eye(4)), [], Seen({"a": HERE}, "a", TOOL, frozenset()), ["slipped"]),
        ({}, ("a", np.eye(4)), [], Seen({}, None, TOOL, frozenset()), ["gone"]),
    ],
)
def test_kinds(
    poses: dict[str, Array],
    held: tuple[str, Array] | None,
    facts: list[tuple[str, ...]],
    seen: Seen,
    kinds: list[str],
) -> None:
    found = list(deviations(poses, held, frozenset(facts), seen, "b"))
    assert [one.kind for one in found] == kinds
    assert set(kinds) <= DEVIATION_KINDS.keys()


def test_a_new_body_is_named() -> None:
    (found,) = deviations(
        {}, None, frozenset(), Seen({}, None, TOOL, frozenset()), None, frozenset({"box"})
    )
    assert found.kind == "new" and "box" in found.message
