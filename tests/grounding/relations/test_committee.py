"""Committees of conjunctions: how they vote, what they find, and on what they rank proposals."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.relations.geometry import local, situations
from benchmarks.relations.hand import scenes
from grounding.relations.catalogue import catalogue
from grounding.relations.committee import TYPICAL, fit
from grounding.relations.evidence import Evidence, gather
from grounding.relations.learner import trained
from grounding.relations.situation import joined
from grounding.relations.words import explanations
from tests.grounding.relations.made import BOX, THING, committee, situation


def test_a_relation_of_distances_among_three_is_told_as_one() -> None:
    """Farther from one than another is: no distance by itself says so."""
    rng = np.random.default_rng(2)
    every = joined([situations(scenes("between", 200, rng)) for _ in range(2)])
    apart = np.linalg.norm(np.diff(every.p[:, [0, 1, 2], :2], axis=1), axis=2)
    holds = apart[:, 0] > apart[:, 1]
    rows = np.concatenate([np.flatnonzero(holds)[:15], np.flatnonzero(~holds)[:15]])
    committee, _ = trained(every.rows(rows), holds[rows], rng)
    rest = np.setdiff1d(np.arange(len(every)), rows)
    said = committee.predict(every.rows(rest)) >= 0.5
    assert len(rest) > 100 and (said == holds[rest]).mean() > 0.9
    assert any("farther from" in text for text in explanations(committee, ("a", "b", "c")))


@pytest.mark.parametrize(
    ("what", "said"),
    [("middle", "distance from the furniture's middle"), ("corner", "corner of the furniture")],
)
def test_a_place_on_the_furniture_is_told_by_its_middle_and_its_corners(
    what: str, said: str
) -> None:
    """In the middle of a table, or at any corner of it: neither side's edge by itself says so."""
    rng = np.random.default_rng(4)
    batch = scenes("upright", 3000, rng)
    at, half = np.abs(local(batch, 0)), batch["half"]
    holds = np.hypot(*at.T) < 0.2 if what == "middle" else (half - at).max(axis=1) < 0.2
    every = situations(batch)
    rows = np.concatenate([np.flatnonzero(holds)[:12], np.flatnonzero(~holds)[:12]])
    committee, _ = trained(every.rows(rows), holds[rows], rng)

    rest = np.setdiff1d(np.arange(len(every)), rows)
    yes, truth = committee.predict(every.rows(rest)) >= 0.5, holds[rest]
    assert truth.sum() > 20
    assert (yes[truth].mean() + 1 - yes[~truth].mean()) / 2 > 0.85
    assert any(said in text for text in explanations(committee, ("a",)))


X, Y = "middle: x of 1 in furniture", "middle: y of 1 in furniture"
COLUMNS = {one.key: column for column, one in enumerate(catalogue(2))}


def values(**by_axis: float) -> np.ndarray:
    """Measures of one situation, zero but for the offsets along these axes."""
    found = np.zeros((1, len(COLUMNS)))
    for axis, value in by_axis.items():
        found[0, COLUMNS[X if axis == "x" else Y]] = value
    return found


def vote(steps: float) -> float:
    """What a member says of a measure so many steps inside its nearer bound."""
    return 1.0 / (1.0 + math.exp(-2.0 * steps))


def test_a_vote_is_by_the_condition_that_is_worst_off() -> None:
    one = committee({X: (0.1, 0.3), Y: (0.0, 0.2)}, {X: (0.1, 0.3)}, {}, soft=0.05)
    votes = one.votes(values(x=0.2, y=0.15))[0]
    assert votes == pytest.approx([vote(1.0), vote(2.0), 0.5])
    assert one.votes(values(x=0.1, y=0.3))[0] == pytest.approx([vote(-2.0), vote(0.0), 0.5])
    assert one.votes(values(x=1e6))[0, :2] == pytest.approx([0.0, 0.0], abs=1e-9)


def test_members_vote_by_their_weights() -> None:
    both = committee({X: (0.0, 0.4)}, {Y: (0.0, 0.4)}, weights=[0.75, 0.25], soft=0.1)
    situations = situation((THING, 0.2, -0.1, 0.0), (BOX, 0.0, 0.0, 0.0))
    assert both.predict(situations) == pytest.approx([0.75 * vote(2.0) + 0.25 * vote(-1.0)])


def test_angles_are_told_from_their_middle() -> None:
    turn = "turn 360: furniture"
    one = committee({turn: (-0.2, 0.2)}, zero={turn: math.pi}, soft=0.1)
    about = situation((THING, 0.2, 0.0, 0.1 - math.pi), (BOX, 0.0, 0.0, 0.0))
    assert one.predict(about) == pytest.approx([vote(1.0)])
    ahead = situation((THING, 0.2, 0.0, 0.1), (BOX, 0.0, 0.0, 0.0))
    assert one.predict(ahead)[0] < 1e-6


def test_the_margin_is_how_deep_inside_and_each_bound_that_is_missed_counts() -> None:
    one = committee({X: (0.0, 2.0), Y: (0.0, 2.0)})
    assert one.margin(values(x=1.0, y=0.5), 0.4) == pytest.approx([0.5])
    assert one.margin(values(x=-1.0, y=-0.5), 0.4) == pytest.approx([2 * (-1.0 - 0.5) - 1.0])
    wide = committee({X: (0.0, 20.0)})
    assert wide.margin(values(x=4.0), 0.4) == pytest.approx([2.0 + math.log(2.0)])
    few = committee({X: (0.0, 2.0)}, {Y: (9.0, 99.0)}, weights=[0.995, 0.005])
    assert few.margin(values(x=1.0), 0.4) == pytest.approx([0.995])


def test_being_like_the_demonstrations_counts_up_to_four_deviations() -> None:
    one = committee({X: (0.0, 2.0)}, typical=[Y])
    here, off, far = (one.margin(values(x=1.0, y=y), 0.5)[0] for y in (0.0, -2.0, 9.0))
    assert (here, off, far) == pytest.approx((1.0, 0.0, -1.0))
    less = committee({X: (0.0, 2.0)}, typical=[Y], side=[1])
    worse, better, best = (less.margin(values(x=1.0, y=y), 0.5)[0] for y in (2.0, -0.5, -7.0))
    assert (worse, better, best) == pytest.approx((0.0, 1.25, 1.5))


def shown(count: int) -> Evidence:
    """Evidence of things to the right of a box, seen from the front, each 2 mm farther than the one
    before and 5 mm behind it; both turned anyhow.
    """
    rng = np.random.default_rng(0)
    parts = [
        situation((THING, 0.2 + 0.002 * n, 0.005, 2.5 * n), (BOX, 0.0, 0.0, 1.1 * n))
        for n in range(count)
    ]
    return gather(joined(parts), None, rng, count=400)


def test_what_is_fitted_holds_of_what_was_shown_and_ranks_by_what_is_alike() -> None:
    e = shown(6)
    one = fit(e)
    assert one.weights.sum() == pytest.approx(1.0) and one.arguments == 2
    assert (np.diff(one.scores) <= 0).all()
    assert ((one.votes(e.good) @ one.weights) > 0.5).all()
    typical = [*one.typical]
    assert len(typical) <= TYPICAL + 2 and len({*typical}) == len(typical)
    median = dict(zip(typical, one.median, strict=True))
    assert median[COLUMNS[X]] == pytest.approx(0.205)
    assert median[COLUMNS[Y]] == 0.0  # nobody means 5 mm
