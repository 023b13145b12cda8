"""Questions: which scene tells most."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.relations.geometry import situations
from benchmarks.relations.hand import shown
from grounding.relations.asking import dispute, doubt, questions
from grounding.relations.committee import fit
from grounding.relations.evidence import gather
from grounding.relations.situation import joined
from tests.grounding.relations.made import BOX, THING, committee, situation


def test_questions_are_about_what_is_disputed() -> None:
    rng = np.random.default_rng(0)
    good, bad = (
        situations(shown("left_of_front", count, holds, rng))
        for count, holds in ((4, True), (3, False))
    )
    evidence = gather(good, bad, rng)
    committee = fit(evidence)
    sure = situations(shown("left_of_front", 30, False, rng, test=True))
    pool = joined([sure, situations(shown("left_of_front", 30, True, rng, test=True))])
    rows = questions(evidence, committee, pool, 5)
    assert len({*rows.tolist()}) == 5
    doubt = 1 - np.abs(2 * committee.predict(pool) - 1)
    assert doubt[rows].mean() > doubt.mean()


X, Y = "middle: x of 1 in furniture", "middle: y of 1 in furniture"


@pytest.mark.parametrize(
    ("x", "y", "disputed"),
    [(0.2, 0.2, 0.0), (-0.2, -0.2, 0.0), (0.2, -0.2, 0.75), (-0.2, 0.2, 0.75)],
)
def test_dispute_is_by_the_weights_of_those_who_say_yes(
    x: float, y: float, disputed: float
) -> None:
    """4 * 0.75 * 0.25."""
    two = committee({X: (0.0, 1.0)}, {Y: (0.0, 1.0)}, weights=[0.75, 0.25], soft=0.01)
    s = situation((THING, x, y, 0.0), (BOX, 0.0, 0.0, 0.0))
    assert dispute(two, s) == pytest.approx([disputed])


@pytest.mark.parametrize(("x", "doubted"), [(0.0, 1.0), (0.1, 1 - math.tanh(1.0)), (9.0, 0.0)])
def test_doubt_is_how_near_the_vote_is_to_a_half(x: float, doubted: float) -> None:
    one = committee({X: (0.0, 99.0)}, soft=0.1)
    s = situation((THING, x, 0.3, 0.0), (BOX, 0.0, 0.0, 0.0))
    assert doubt(one, s) == pytest.approx([doubted], abs=1e-6)
    mirrored = situation((THING, -x, 0.3, 0.0), (BOX, 0.0, 0.0, 0.0))
    assert doubt(one, mirrored) == pytest.approx([doubted], abs=1e-6)


def test_no_more_is_asked_than_there_is() -> None:
    rng = np.random.default_rng(0)
    good = situations(shown("left_of_front", 4, True, rng))
    evidence = gather(good, None, rng, count=200)
    rows = questions(evidence, fit(evidence), good, 9)
    assert sorted(rows.tolist()) == [0, 1, 2, 3]
