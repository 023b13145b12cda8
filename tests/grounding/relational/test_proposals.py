"""Demonstrations drawn for another body: which ones, on which face, and how far they are moved."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from grounding.relational.coordinates import EncodedExample
from grounding.relational.proposals import FACE_LIKENESS, SHARE_JITTER, SIZE_LIKENESS, Transfer
from tamp.geometric.scene.pose import Array

COUNT = 20_000
SHARE, HEIGHT, YAW = (0.8, 0.3), 0.01, 0.5
SIZE = (-3.0, -2.5, -2.0)
"""Logarithms of extents."""


def coordinates(height: float = HEIGHT, share: tuple[float, float] = SHARE) -> list[float]:
    return [*share, height, 0.0, 0.0, np.cos(YAW), np.sin(YAW)]


def transfer(
    *demonstrations: tuple[list[float], tuple[float, ...]], steady: float = 0.1
) -> Transfer:
    """Demonstrations of coordinates and sizes, all on the same face."""
    shown = [
        EncodedExample(np.array(one), np.zeros(4), np.array(size)) for one, size in demonstrations
    ]
    return Transfer.of(SimpleNamespace(steadiness=steady), shown)


def view(*faces: tuple[float, list[float]], size: tuple[float, ...] = SIZE) -> SimpleNamespace:
    """A body of a size with faces of a steadiness and a descriptor."""
    faces = faces or ((0.5, [0.0] * 4),)
    descriptors = np.array([one for _, one in faces])
    steadiness = np.array([angle for angle, _ in faces])
    return SimpleNamespace(
        size=np.array(size), steadiness=steadiness, faces=SimpleNamespace(descriptors=descriptors)
    )


def shares(chosen: Array) -> Array:
    """How often each value occurs, in their order."""
    return np.unique(chosen, return_counts=True)[1] / len(chosen)


def near(found: float | Array, expected: float | Array) -> bool:
    """Whether shares of `COUNT` draws are what they should be, as far as chance lets them."""
    return bool(np.allclose(found, expected, atol=4 * np.sqrt(0.25 / COUNT)))


def test_a_body_of_a_similar_size_is_drawn_more_often(rng: np.random.Generator) -> None:
    far = (SIZE[0] + 0.4, SIZE[1], SIZE[2] - 0.3)  # 0.5 away
    model = transfer((coordinates(0.02), far), (coordinates(0.01), SIZE), (coordinates(0.03), SIZE))
    _, drawn = model.choose(view(), COUNT, rng)
    odds = np.array([1.0, np.exp(-SIZE_LIKENESS * 0.25), 1.0])
    assert near(shares(drawn[:, 2]), odds / odds.sum())
    _, drawn = model.choose(view(size=far), COUNT, rng)
    assert near(shares(drawn[:, 2]), odds[[1, 0, 1]] / odds[[1, 0, 1]].sum())


def test_a_body_that_no_demonstration_is_like_draws_the_nearest_one(
    rng: np.random.Generator,
) -> None:
    model = transfer((coordinates(0.02), (0.0, 0.0, 1.0)), (coordinates(0.01), (0.0, 0.0, 0.0)))
    _, drawn = model.choose(view(size=(50.0, 50.0, 51.0)), 100, rng)
    assert (drawn[:, 2] == 0.02).all()


def test_a_face_is_chosen_that_is_like_the_one_shown_and_steady(rng: np.random.Generator) -> None:
    model = transfer((coordinates(), SIZE))
    body = view((0.05, [0.0] * 4), (0.3, [0.3, 0.0, 0.0, 0.4]), (0.1, [0.0] * 4))
    faces, _ = model.choose(body, COUNT, rng)
    assert {*faces.tolist()} == {1, 2}  # the first one tips over sooner than any that was shown
    odds = np.array([np.exp(-FACE_LIKENESS * 0.25), 1.0])
    assert near(shares(faces), odds / odds.sum())


def test_where_no_face_is_as_steady_the_steadiest_is_taken(rng: np.random.Generator) -> None:
    model = transfer((coordinates(), SIZE), steady=0.4)
    body = view((0.2, [0.0] * 4), (0.3, [2.0] * 4), (0.1, [0.0] * 4))
    assert {*model.choose(body, 50, rng)[0].tolist()} == {1}


def test_places_are_mirrored_in_both_axes_at_once_and_moved(rng: np.random.Generator) -> None:
    _, drawn = transfer((coordinates(share=(0.4, -0.2)), SIZE)).choose(view(), COUNT, rng)
    kept = drawn[:, :2] * np.sign(drawn[:, :1] - drawn[:, 1:2])  # so that x is above y
    assert near((drawn[:, 0] > 0).mean(), 0.5)
    assert np.abs(drawn[:, :2].mean(axis=0)).max() < 0.02
    assert (drawn[:, 0] * drawn[:, 1]).mean() == pytest.approx(-0.08, abs=0.01)
    assert kept[:, 0].mean() > 0.3
    spread = drawn[:, 1].std()
    assert spread == pytest.approx(np.hypot(SHARE_JITTER, 0.2), rel=0.03)


def test_what_would_be_moved_out_is_reflected_at_the_border(rng: np.random.Generator) -> None:
    """At the border x = 1 - |move|: its mean is that of half a normal distribution below 1."""
    _, drawn = transfer((coordinates(share=(1.0, 0.0)), SIZE)).choose(view(), COUNT, rng)
    assert np.abs(drawn[:, :2]).max() <= 1.0
    assert np.abs(drawn[:, 0]).mean() == pytest.approx(
        1 - SHARE_JITTER * np.sqrt(2 / np.pi), abs=0.01
    )


def test_the_yaw_is_turned_about_the_one_shown(rng: np.random.Generator) -> None:
    """The mean direction of a normal spread of 0.5 rad has the length exp(-0.5^2 / 2)."""
    _, drawn = transfer((coordinates(), SIZE)).choose(view(), COUNT, rng)
    assert np.allclose(np.hypot(drawn[:, 5], drawn[:, 6]), 1.0)
    cosine, sine = drawn[:, 5:].mean(axis=0)
    assert np.arctan2(sine, cosine) == pytest.approx(YAW, abs=0.02)
    assert np.hypot(cosine, sine) == pytest.approx(np.exp(-0.125), abs=0.01)


def test_what_was_shown_stays_as_it_is(rng: np.random.Generator) -> None:
    model = transfer((coordinates(), SIZE))
    _, drawn = model.choose(view(), 10, rng)
    assert np.array_equal(model.coordinates, [coordinates()])
    assert (drawn[:, 2:5] == [HEIGHT, 0.0, 0.0]).all()


def test_the_same_seed_chooses_the_same() -> None:
    model = transfer((coordinates(0.01), SIZE), (coordinates(0.02), SIZE))
    one, other = (model.choose(view(), 20, np.random.default_rng(3)) for _ in range(2))
    assert np.array_equal(one[0], other[0]) and np.array_equal(one[1], other[1])


@pytest.mark.parametrize(
    "shapes", [((0, 7), (0, 4), (0, 3)), ((2, 6), (2, 4), (2, 3)), ((2, 7), (3, 4), (2, 3))]
)
def test_arrays_that_do_not_belong_together_are_refused(
    shapes: tuple[tuple[int, int], ...],
) -> None:
    with pytest.raises(ValueError, match="demonstrations of shapes"):
        Transfer(SimpleNamespace(steadiness=0.1), *(np.zeros(shape) for shape in shapes))
