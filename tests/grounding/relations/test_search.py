"""The conjunctions that are the least of a coincidence, and what speaks against a condition."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from grounding.relations.catalogue import Measure
from grounding.relations.evidence import RIGHT, UNTOUCHED, ZERO, Bounds, Evidence, Settings
from grounding.relations.search import ENOUGH_NEGATIVES, OFFSET_PRICES_NATS, conjunctions, prices
from tamp.geometric.scene.pose import Array

SCALE = 0.01
SETTINGS = Settings(widen=0.0)
"""An interval is what was shown and `SCALE` more on both sides."""

BASE = np.linspace(0.0, 1.0, 101)
"""What chance gives of each measure, every other one in an order of its own."""


def named(key: str, kind: str = "place", cost: float = 0.0) -> Measure:
    return Measure(key, SCALE, cost, 0.0, kind, False, "", "mm")


def evidence(good: Array, bad: Array, *measures: Measure, one_size: bool = False) -> Evidence:
    """Of measures that are each as the others by chance, and of no other's."""
    good, bad = np.asarray(good, float), np.asarray(bad, float)
    count = good.shape[1]
    rng = np.random.default_rng(0)
    base = np.stack([BASE, *(rng.permutation(BASE) for _ in range(count - 1))], axis=1)
    listed = measures or tuple(named(f"m{n}") for n in range(count))
    nothing = np.zeros(count)
    return Evidence(
        listed, good, bad.reshape(-1, count), base, nothing, nothing, np.ones(count, bool), one_size
    )


def found(e: Evidence, s: Settings = SETTINGS) -> dict[tuple[int, ...], float]:
    """The conjunctions with their evidence, the best first."""
    got = conjunctions(e, s, Bounds.of(e, s))
    assert len(got.members) == len(got.scores) == len(got.weights) == len({*got.members})
    return dict(zip(got.members, got.scores.tolist(), strict=True))


def price(measure: Measure, good: Array, bad: Array = (), one_size: bool = False) -> float:
    """What a condition on this measure alone costs."""
    e = evidence(np.array(good)[:, None], bad, measure, one_size=one_size)
    return float(prices(e, SETTINGS, Bounds.of(e, SETTINGS))[0])


def test_what_all_share_and_chance_does_not_give_is_the_relation() -> None:
    good = np.array([[0.3, 0.0], [0.3, 1.0], [0.31, 0.2], [0.32, 0.7]])
    ranked = list(found(evidence(good, [])))
    assert ranked[0] == (0,)
    assert (1,) not in ranked


def test_its_evidence_is_the_share_of_chance_and_the_negatives_that_it_rejects() -> None:
    """Of 101 chances 0.29 to 0.33 are within: 5; two of the three negatives are not."""
    good, bad = [[0.3], [0.3], [0.31], [0.32]], [[0.5], [0.1], [0.3]]
    s = SETTINGS
    worth = 4 / (1 + 3 / s.fade)
    expected = worth * np.log((1 + s.floor) / (5 / 101 + s.floor)) + 2 * RIGHT - s.small
    assert found(evidence(good, bad))[0,] == pytest.approx(expected)
    alone = 4 * np.log((1 + s.floor) / (5 / 101 + s.floor)) - s.small_alone
    assert found(evidence(good, []))[0,] == pytest.approx(alone)
    capped = found(evidence(np.repeat(good, 3, axis=0), []))[0,] + s.small_alone
    assert capped == pytest.approx((alone + s.small_alone) * s.cap / 4)


def test_without_anything_in_common_there_is_no_condition() -> None:
    got = conjunctions(e := evidence([[0.0], [1.0]], []), SETTINGS, Bounds.of(e, SETTINGS))
    assert got.members == [()] and got.weights.tolist() == [1.0] and got.scores.tolist() == [0.0]


def test_two_conditions_where_each_rejects_what_the_other_does_not() -> None:
    good = np.array([[0.3, 0.6], [0.3, 0.6], [0.31, 0.62], [0.32, 0.61]])
    bad = np.array([[0.3, 0.1], [0.3, 0.2], [0.31, 0.9], [0.8, 0.6], [0.9, 0.6], [0.1, 0.61]])
    e, s = evidence(good, bad), SETTINGS
    ranked = found(e)
    assert next(iter(ranked)) == (0, 1)
    by_chance = (np.abs(e.base - [0.31, 0.61]) < 0.0201).all(axis=1).mean()
    worth = 4 / (1 + 6 / s.fade) * np.log((1 + s.floor) / (by_chance + s.floor))
    assert ranked[0, 1] == pytest.approx(worth + 6 * RIGHT - 2 * s.small)
    assert max(ranked[0,], ranked[1,]) < ranked[0, 1]
    assert (0, 1) not in found(evidence(good, bad), replace(SETTINGS, depth=1))


def test_a_condition_that_repeats_another_does_not_pay() -> None:
    good, bad = np.full((5, 1), 0.3), np.linspace(0.5, 0.9, 4)[:, None]
    e = evidence(good, bad)
    twice = replace(
        e, measures=(*e.measures, *e.measures), good=np.tile(good, 2), bad=np.tile(bad, 2),
        base=np.tile(e.base, 2), period=np.zeros(2), zero=np.zeros(2), allowed=np.ones(2, bool),
    )  # fmt: skip
    ranked = found(twice)
    assert {*ranked} == {(), (0,), (1,)} and ranked[0,] == ranked[1,]


def test_votes_are_by_evidence() -> None:
    good = np.array([[0.3, 0.6, 0.4], [0.3, 0.7, 0.45], [0.31, 0.65, 0.42], [0.32, 0.7, 0.4]])
    e = evidence(good, [])
    got = conjunctions(e, SETTINGS, Bounds.of(e, SETTINGS))
    assert len(got.members) > 3 and (np.diff(got.scores) <= 0).all()
    assert got.weights.sum() == pytest.approx(1.0)
    ratio = np.exp((got.scores[0] - got.scores[2]) / SETTINGS.temper)
    assert got.weights[0] / got.weights[2] == pytest.approx(ratio)
    few = conjunctions(e, replace(SETTINGS, members=2), Bounds.of(e, SETTINGS))
    assert few.members == got.members[:2]


def test_what_may_not_be_asked_is_not_asked() -> None:
    e = evidence([[0.3], [0.3], [0.31], [0.32]], [])
    assert {*found(replace(e, allowed=np.array([False])))} == {()}


def test_a_condition_costs_what_its_measure_has_to_prove() -> None:
    assert price(named("m"), [0.3, 0.31, 0.32]) == 0.0
    assert price(named("m", cost=5.0), [0.3, 0.31, 0.32]) == 5.0
    assert price(named("m"), [0.3, 0.31, 0.9]) == RIGHT  # one that it would miss when left out
    assert price(named("m"), [0.0, 0.31, 0.9]) == 2 * RIGHT


def test_what_no_negative_varied_is_no_evidence() -> None:
    good = [0.3, 0.31, 0.32]
    assert price(named("m"), good, [0.3] * (ENOUGH_NEGATIVES + 1)) == SETTINGS.idle
    assert price(named("m"), good, [0.3] * ENOUGH_NEGATIVES) == 0.0
    assert price(named("m"), good, [0.3] * 8 + [0.9] * 2) == 0.0


def test_a_yaw_that_no_hand_touched_is_no_evidence() -> None:
    still, moving = [0.0, UNTOUCHED, 0.0, UNTOUCHED], [0.0, 3 * UNTOUCHED, 0.0, 3 * UNTOUCHED]
    assert price(named("m", "turn"), still) == SETTINGS.idle
    assert price(named("m", "turn"), moving) == 0.0
    assert price(named("m"), still) == 0.0


@pytest.mark.parametrize("sign", [1, -1])
def test_a_height_that_is_not_zero_needs_an_explanation(sign: int) -> None:
    height, up = named("foot", "height"), np.full(3, sign * 1.5 * ZERO)
    assert price(height, up) == SETTINGS.contact
    assert price(height, up, one_size=True) == 2 * SETTINGS.contact
    assert price(height, up / 2) == price(named("m"), up) == 0.0


def test_with_one_size_a_size_says_nothing() -> None:
    size, same = named("size of 0", "size"), np.full(3, 0.2)
    assert price(size, same, one_size=True) == SETTINGS.idle
    assert price(size, same) == 0.0 and price(named("m"), same, one_size=True) == 0.0


@pytest.mark.parametrize("key", ["space gap to 1", "level gap to 1"])
def test_nobody_means_how_deep_one_body_is_in_another(key: str) -> None:
    assert price(named(key), np.full(3, -3 * ZERO)) == SETTINGS.contact
    assert price(named(key), np.full(3, -ZERO)) == price(named(key), np.full(3, 3 * ZERO)) == 0.0


@pytest.mark.parametrize("kind", OFFSET_PRICES_NATS)
def test_an_offset_has_to_be_explained_a_gap_only_where_it_is_none(kind: str) -> None:
    nats, gap = OFFSET_PRICES_NATS[kind]
    offset = named(f"{kind}: x of the world")
    assert gap is ("gap" in kind)
    assert price(offset, np.full(3, -0.03)) == nats
    assert price(offset, np.full(3, 0.03)) == (0.0 if gap else nats)
    assert price(offset, np.full(3, -1.5 * SCALE)) == 0.0
    assert price(named(f"{kind} of something"), np.full(3, -0.03)) == 0.0


def test_the_middle_demonstration_counts() -> None:
    offset = named("middle: x")
    assert price(offset, [0.0, 0.0, 0.03, 0.04, 0.04]) == OFFSET_PRICES_NATS["middle"][0]
    assert price(offset, [0.0, 0.0, 0.01, 0.04, 0.04]) == 0.0
