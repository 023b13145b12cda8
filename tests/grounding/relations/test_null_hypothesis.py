"""Chance: what comes about without a relation being meant."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.relations.geometry import situations
from benchmarks.relations.hand import shown
from benchmarks.relations.relations import RELATIONS
from grounding.relations.null_hypothesis import (
    FACES,
    about_z,
    chance,
    drop,
    floor_of,
    highest,
    lowest,
    scattered,
    spoilt,
)
from grounding.relations.situation import Situations, joined
from tests.grounding.relations.made import BOX, CRATE, HALF, THING, TOP, situation


def test_chance_varies_what_demonstrations_may_not() -> None:
    s = situations(shown("left_of_front", 10, True, np.random.default_rng(0), lazy="all"))
    made = chance(s, np.random.default_rng(1), 500)
    assert np.ptp(made.support[:, 0]) > 0.8 and np.ptp(made.support[:, 1]) > 4
    assert np.ptp(made.half[made.shape[:, 0]], axis=0).min() > 0.02
    assert len(joined([s, made])) == 510 and RELATIONS["left_of_front"].arguments == 2
    assert np.allclose(np.linalg.det(made.R), 1.0)


def test_heights_are_of_the_body_as_it_lies() -> None:
    s = situation((THING, 0.1, 0.0, 0.0), (CRATE, 0.0, 0.0, 0.0))
    assert (lowest(s)[0], highest(s)[0]) == pytest.approx((TOP, TOP + 0.1))
    s.R[0, 0] = about_z(0.3) @ FACES[2]  # on its side: 3 cm to each
    assert (lowest(s)[0], highest(s)[0]) == pytest.approx((TOP + 0.05 - 0.03, TOP + 0.05 + 0.03))
    assert floor_of(s, 1) == pytest.approx([TOP + 0.1 - 0.08])
    assert floor_of(s, 0) == pytest.approx(lowest(s))
    drop(s, np.array([0.9]))
    assert lowest(s) == pytest.approx([0.9]) and s.p[0, 0, :2] == pytest.approx([0.1, 0.0])
    assert lowest(s, 1) == pytest.approx([TOP])


def test_six_faces_are_six_sides_down() -> None:
    downs = {tuple(round(x) for x in face.T @ [0, 0, -1]) for face in FACES}
    assert len(downs) == 6 and np.linalg.det(FACES) == pytest.approx(np.ones(6))


def many(front: float = 0.0) -> Situations:
    return situation(
        (THING, 0.3, 0.1, 0.4), (BOX, -0.1, 0.0, 0.2), front=front, middle=(0.0, 0.0)
    ).rows(np.zeros(300, dtype=np.intp))


def test_what_lies_anywhere_is_on_the_furniture_as_that_is_turned() -> None:
    s = many(front=math.pi / 2)
    far = scattered(s, np.random.default_rng(0))
    assert lowest(far) == pytest.approx(np.full(300, TOP))
    assert np.abs(far.p[:, 0, 0]).max() <= 0.9 * 0.4 and np.abs(far.p[:, 0, 1]).max() <= 0.9 * 0.6
    assert np.abs(far.p[:, 0, 0]).max() > 0.85 * 0.4 and np.abs(far.p[:, 0, 1]).max() > 0.85 * 0.6
    assert (far.p[:, 1] == s.p[:, 1]).all() and (s.p[:, 0, :2] == [0.3, 0.1]).all()


def test_a_near_miss_has_one_thing_wrong_and_the_other_body_where_it_was() -> None:
    s = many()
    near = spoilt(s, np.random.default_rng(0))
    assert (near.p[:, 1] == s.p[:, 1]).all() and (near.R[:, 1] == s.R[:, 1]).all()
    moved = np.linalg.norm(near.p[:, 0, :2] - s.p[:, 0, :2], axis=1)
    turned = np.abs(near.R[:, 0] - s.R[:, 0]).max(axis=(1, 2)) > 1e-6
    assert not (turned & (moved > 1e-9)).any()
    assert 0.3 < turned.mean() < 0.5  # two of five
    across = np.allclose(near.p[:, 0, :2], [-0.5, -0.1]), moved > 0.25
    assert not across[0]
    mirrored = near.p[across[1], 0, :2]
    assert len(mirrored) and mirrored == pytest.approx(np.tile([-0.5, -0.1], (len(mirrored), 1)))
    assert lowest(near).min() == pytest.approx(TOP)


def test_chance_leaves_what_is_shown_as_it_was_and_stands_on_the_lifted_furniture() -> None:
    s = many().rows([0, 1])
    made = chance(s, np.random.default_rng(2), 300)
    assert len(made) == 300 and (s.p == many().p[:2]).all() and (s.half == HALF).all()
    top = made.support[:, 0]
    assert top.min() >= 0.2 and top.max() <= 1.2 and lowest(made, 1) == pytest.approx(top)
    assert (lowest(made) > top - 1e-9).all()
    size = made.half[made.shape[:, 1], 2] / HALF[BOX, 2]
    assert 0.7 <= size.min() < 0.75 and 1.35 < size.max() <= 1.4
