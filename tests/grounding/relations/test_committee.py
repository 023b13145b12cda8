"""Committees of conjunctions: how they vote, what they find, and on what they rank proposals."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.relations.geometry import local, situations
from benchmarks.relations.hand import scenes
from grounding.relations.learner import trained
from grounding.relations.situation import joined
from grounding.relations.words import explanations


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
