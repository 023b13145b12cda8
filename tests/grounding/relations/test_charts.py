"""Charts: which coordinates are thought of, and in which of them demonstrations agree."""

from __future__ import annotations

import math

import numpy as np
import pytest

from grounding.relations.charts import (
    DEARER,
    FREE,
    HAND,
    MODES,
    MOST_AGREED,
    UNNATURAL,
    Carried,
    Chart,
    agreement,
    carried,
    charts,
)
from grounding.relations.situation import joined
from tamp.geometric.scene.pose import Array
from tests.grounding.relations.made import BOX, THING, about_z, situation

WORLD, FURNITURE, OTHER = range(3)
MIDDLE = MODES.index("middle")


@pytest.mark.parametrize(
    ("arguments", "count"),
    [
        (1, 5 * 3),  # on furniture, by one edge or none; yaw free, of furniture, of world
        (2, 5 + 4 * 5 * 5),  # five yaws; the other one in four frames and five ways
        (3, 8 + (2 * 5 * 5 + 1) * 8),  # two others, and the line between them
    ],
)
def test_every_chart_is_listed_once(arguments: int, count: int) -> None:
    listed = charts(arguments)
    assert len(listed) == len({*listed}) == count
    along = [one for one in listed if MODES[one.mode] == "line"]
    assert bool(along) is (arguments == 3) and all(one.origin == 1 for one in along)
    edges = {MODES[one.mode] for one in listed if one.origin == 0}
    assert edges == {"anywhere"} | ({*MODES[7:]} if arguments == 1 else set())


def test_demonstrations_are_measured_in_each_chart() -> None:
    """To the right of the other one and behind it, as that one is turned or as the world is."""
    shown = joined([situation((THING, 0.2, 0.1, 0.3), (BOX, 0.0, 0.0, math.pi / 2))])
    listed = [Chart(1, frame, MIDDLE, frame) for frame in (WORLD, OTHER)]
    found = carried(shown, listed)
    assert found.codes.tolist() == [[1, WORLD, MIDDLE, WORLD], [1, OTHER, MIDDLE, OTHER]]
    assert found.place[:, 0] == pytest.approx(np.array([[0.2, 0.1], [0.1, -0.2]]))
    assert found.yaw[:, 0] == pytest.approx([0.0, math.pi / 2])
    assert found.R[0] == pytest.approx(about_z(0.3))
    assert found.chosen(np.array([1])).codes.tolist() == [[1, OTHER, MIDDLE, OTHER]]


def agreed(code: tuple[int, int, int, int], place: Array, yaws: list[float]) -> float:
    """Nats of one chart, where chance spreads places over a metre each way."""
    count = len(yaws)
    codes, nothing = np.array([code]), np.zeros((1, count, 2))
    R = np.array([about_z(yaw) for yaw in yaws])
    shown = Carried(codes, place[None], nothing, np.zeros((1, count)), R)
    base = Carried(codes, np.tile([[1.0, 1.0], [-1.0, -1.0]], (1, 3, 1)), nothing, shown.yaw, R)
    return float(agreement(shown, base)[0])


SAME, APART = np.tile([0.1, 0.2], (4, 1)), np.array([[1.0, 1], [-1, -1], [1, 1], [-1, -1]])
ANY = [0.0, 0.5 * math.pi, 0.25 * math.pi, 0.75 * math.pi]
"""Yaws that are spread over a quarter turn, a half turn and a whole one alike."""


@pytest.mark.parametrize(
    ("code", "expected"),
    [
        ((1, FURNITURE, MIDDLE, FREE), 2 * MOST_AGREED),
        ((1, WORLD, MIDDLE, FREE), 2 * MOST_AGREED - UNNATURAL),
        ((1, FREE, MIDDLE, FREE), MOST_AGREED),
        ((0, FURNITURE, MIDDLE, FREE), 0.0),
    ],
)
def test_one_place_counts_so_much_along_each_axis_that_has_one(
    code: tuple[int, int, int, int], expected: float
) -> None:
    assert agreed(code, SAME, ANY) == pytest.approx(expected)
    assert agreed(code, APART, ANY) == pytest.approx(0.0 if code[1] else -UNNATURAL)


def test_a_yaw_that_is_the_same_counts_by_how_often_it_may_be_the_same() -> None:
    furniture, world, free = ((0, FURNITURE, MIDDLE, turn) for turn in (FURNITURE, WORLD, FREE))
    assert agreed(furniture, APART, [0.4] * 4) == pytest.approx(MOST_AGREED)
    assert agreed(world, APART, [0.4] * 4) == pytest.approx(MOST_AGREED - UNNATURAL)
    assert agreed(free, APART, [0.4] * 4) == 0.0
    half, quarter = (
        math.log(period / math.sqrt(12.0) / HAND) - dearer
        for period, dearer in zip((math.pi, math.pi / 2), DEARER[1:], strict=True)
    )
    assert agreed(furniture, APART, [0.4, 0.4 + math.pi] * 2) == pytest.approx(half)
    turned = [0.4 + turns * math.pi / 2 for turns in range(4)]
    assert agreed(furniture, APART, turned) == pytest.approx(quarter)
    assert 0.0 < quarter < half < MOST_AGREED
