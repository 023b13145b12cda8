"""Evidence: intervals of what was shown, how far they reach beyond it, and what is looked at."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from grounding.relations.catalogue import Measure
from grounding.relations.evidence import Bounds, Evidence, Settings, centred, gather
from grounding.relations.situation import joined
from tamp.geometric.scene.pose import Array
from tests.grounding.relations.made import BOX, CRATE, HALF, THING, situation

SCALE = 0.01


def of(good: Array, bad: Array = (), key: str = "m", least: bool = False) -> Evidence:
    """Evidence of measures that are all alike."""
    good = np.asarray(good, float)
    count = good.shape[1]
    one = Measure(key, SCALE, 0.0, 0.0, "place", least, "", "mm")
    bad = np.asarray(bad, float).reshape(-1, count)
    nothing = np.zeros(count)
    return Evidence(
        (one,) * count, good, bad, good, nothing, nothing, np.ones(count, bool), False
    )  # fmt: skip


def bounds(e: Evidence, widen: float) -> Bounds:
    return Bounds.of(e, Settings(widen=widen))


def test_an_interval_is_what_was_shown_the_resolution_and_mean_spacings() -> None:
    found = bounds(of([[0.5], [0.7], [0.6]]), 2.0)  # 0.1 apart
    assert (found.least[0], found.most[0]) == (0.5, 0.7)
    assert (found.low[0], found.high[0]) == pytest.approx((0.5 - 0.21, 0.7 + 0.21))
    assert found.soft[0] == pytest.approx(0.105)
    inside = found.within(np.array([[0.3], [0.28], [0.9], [0.92]]))
    assert inside[:, 0].tolist() == [True, False, True, False]


def test_one_demonstration_alone_has_its_resolution() -> None:
    found = bounds(of([[0.5]]), 2.0)
    assert (found.low[0], found.high[0]) == pytest.approx((0.49, 0.51))
    assert found.missed.tolist() == [0.0]


def test_what_cannot_be_below_zero_and_came_near_it_has_no_lower_bound() -> None:
    near, far = ([[0.019], [0.3]], [[0.021], [0.3]])
    assert bounds(of(near, least=True), 0.0).low[0] == -np.inf
    assert bounds(of(far, least=True), 0.0).low[0] == pytest.approx(0.011)
    assert bounds(of(near), 0.0).low[0] == pytest.approx(0.009)


@pytest.mark.parametrize("key", ["room within 1", "middle within 1"])
def test_more_room_is_never_worse(key: str) -> None:
    assert bounds(of([[0.1], [0.2]], key=key), 0.0).high[0] == np.inf
    assert bounds(of([[0.1], [0.2]], key="middle: x"), 0.0).high[0] == pytest.approx(0.21)


def test_what_would_be_missed_if_it_were_left_out_is_counted_at_both_ends() -> None:
    good = [[0.1, 0.1, 0.1], [0.5, 0.105, 0.5], [0.5, 0.5, 0.505], [0.505, 0.9, 0.505]]
    assert bounds(of(good), 0.0).missed.tolist() == [1.0, 1.0, 1.0]
    assert bounds(of([[0.1], [0.5], [0.9]]), 0.0).missed.tolist() == [2.0]


def tightened(bad: Array, columns: list[int], good: Array) -> tuple[list[float], list[float]]:
    e, s = of(good, bad), Settings(widen=2.0, far=1.5)
    low, high = Bounds.of(e, s).tightened(e, s, columns)
    return low.tolist(), high.tolist()


GOOD = [[0.5, 0.5], [0.6, 0.6], [0.7, 0.7]]


@pytest.mark.parametrize(
    ("bad", "low", "high"),
    [
        (0.8, 0.29, 0.75),  # half way
        (0.704, 0.29, 0.91),  # as good as a positive: no bound rejects it
        (1.9, 0.29, 0.7 + 1.5 * 0.21),  # far away: wider than without it, not half way
        (0.4, 0.45, 0.91),
        (-0.9, 0.5 - 1.5 * 0.21, 0.91),
    ],
)
def test_a_bound_is_half_way_to_a_negative_and_not_too_far(
    bad: float, low: float, high: float
) -> None:
    assert tightened([[bad, 0.6]], [0], GOOD) == (pytest.approx([low]), pytest.approx([high]))


def test_a_negative_that_another_condition_rejects_moves_no_bound() -> None:
    kept = (pytest.approx([0.29, 0.29]), pytest.approx([0.91, 0.91]))
    assert tightened([[0.8, 2.0]], [0, 1], GOOD)[1][0] == pytest.approx(0.91)
    assert tightened([[2.0, 2.0]], [0, 1], GOOD) == kept
    assert tightened([[0.8, 0.6]], [0, 1], GOOD)[1] == pytest.approx([0.75, 0.91])


def test_angles_are_within_half_a_period_of_their_zero_and_lengths_as_they_are() -> None:
    values = np.array([[3.0, 3.0, 3.0], [-3.0, -3.0, -3.0]])
    found = centred(values, np.array([0.0, 2 * math.pi, math.pi]), np.array([9.0, math.pi, 0.0]))
    assert found[0] == pytest.approx([3.0, 3.0 - math.pi, 3.0 - math.pi])
    assert found[1] == pytest.approx([-3.0, math.pi - 3.0, math.pi - 3.0])


def gathered(
    *yaws: float, other: int = BOX, wide: float = 1.0, shapes: tuple[int, ...] = (THING, BOX)
) -> tuple[Evidence, dict[str, int]]:
    """Evidence of situations of which the first has these shapes so much wider, and its columns."""
    shown = joined([situation((THING, 0.1, 0.0, yaw), (other, -0.2, 0.1, 0.2)) for yaw in yaws])
    grown = replace(shown, half=shown.half.copy())
    grown.half[list(shapes)] *= wide
    e = gather(grown, None, np.random.default_rng(0), count=20)
    return e, {one.key: column for column, one in enumerate(e.measures)}


def test_angles_are_told_from_the_middle_of_the_demonstrations() -> None:
    e, at = gathered(math.pi - 0.1, 0.1 - math.pi)
    column = at["turn 360: furniture"]
    assert abs(e.zero[column]) == pytest.approx(math.pi)
    assert sorted(e.good[:, column]) == pytest.approx([-0.1, 0.1])
    assert e.bad.shape == (0, len(e.measures)) and e.base.shape == (20, len(e.measures))
    assert e.zero[at["distance: 1"]] == 0.0


@pytest.mark.parametrize(("other", "hollow"), [(BOX, False), (CRATE, True)])
def test_the_floor_of_what_has_none_is_not_asked_for(other: int, hollow: bool) -> None:
    e, at = gathered(0.0, 1.0, other=other)
    assert bool(e.allowed[at["height: foot, floor of 1"]]) is hollow
    assert e.allowed[[column for key, column in at.items() if "floor of" not in key]].all()


def test_an_argument_that_had_one_size_is_known() -> None:
    assert HALF.min() > 0.0
    assert gathered(0.0, 1.0)[0].one_size
    assert gathered(0.0, 1.0, wide=1.03)[0].one_size  # as good as one
    assert not gathered(0.0, 1.0, wide=1.5)[0].one_size
    assert gathered(0.0, 1.0, wide=1.5, shapes=(THING,))[0].one_size  # the other one's
