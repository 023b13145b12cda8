"""A learned relation in words."""

from __future__ import annotations

import math

import pytest

from grounding.relations.learner import Learned
from grounding.relations.words import EQUAL, SHOWN, described, explanations
from tests.grounding.relations.made import committee


def test_what_was_learned_is_said_in_words(learned: Learned) -> None:
    said = explanations(learned.committee, ("cup", "plate"))
    assert any("gap left of plate seen from the front" in one for one in said)
    assert all(one.endswith("turned as you like") for one in said) and 1 <= len(said) <= 3
    assert learned.held_out is not None and learned.held_out.mean > 0.85 and not learned.cannot_tell


LEFT = "gap below: x of 1 in furniture"
TURN = "turn 360: furniture"


@pytest.mark.parametrize(
    ("key", "interval", "said"),
    [
        (LEFT, (0.0104, 0.0996), "gap left of plate seen from the front: 10 to 100 mm"),
        ("distance: 1", (-0.01, 0.2), "distance from plate: at most 200 mm"),
        ("distance: 1", (-math.inf, 0.2), "distance from plate: at most 200 mm"),
        ("distance: 1", (0.1, 0.2), "distance from plate: 100 to 200 mm"),
        (LEFT, (-0.01, 0.2), "gap left of plate seen from the front: -10 to 200 mm"),
        ("room within 1", (0.01, math.inf), "room to the sides inside plate: at least 10 mm"),
        ("tilt: 0", (-0.1, math.pi / 6), "tilt of cup: at most 30 degrees"),
        ("size: 1", (-0.104, 0.25), "size against plate (logarithm): -0.1 to 0.25"),
    ],
)
def test_an_interval_is_told_in_whole_units(
    key: str, interval: tuple[float, float], said: str
) -> None:
    one = committee({key: interval})
    assert described(one, 0, ("cup", "plate")) == f"{said}; turned as you like"


def test_a_yaw_is_told_with_its_middle_and_then_it_is_not_turned_as_you_like() -> None:
    one = committee({TURN: (-0.1, 0.1), LEFT: (0.0, 0.1)}, zero={TURN: math.pi / 2})
    assert described(one, 0, ("cup", "plate")) == (
        "turned against the front: 84 to 96 degrees; "
        "gap left of plate seen from the front: 0 to 100 mm"
    )


def test_of_those_that_fit_equally_well_the_natural_one_is_first() -> None:
    share, gap = "share: x of 1 in furniture", {LEFT: (0.0, 0.1)}
    scores = [10.0, 9.0, 10.0 - 0.99 * EQUAL, 10.0 - 1.01 * EQUAL]
    far = ({"distance: 1": (0.0, 0.1)}, {"tilt: 0": (0.0, 0.1)})
    found = explanations(committee({share: (0.0, 1.0)}, gap, *far, scores=scores), ("a", "b"))
    assert [text.split(":")[0] for text in found] == [
        "gap left of b seen from the front",
        "share of half the width of b, right of its middle seen from the front",
        "distance from b",
    ]
    assert len(found) == SHOWN
    two = explanations(committee({share: (0.0, 1.0)}, far[1], scores=[10.0, scores[-1]]), "ab")
    assert len(two) == 1 and two[0].startswith("share")


def test_that_nothing_is_asked_is_told_only_where_there_is_nothing_else() -> None:
    assert explanations(committee({}), ("a", "b")) == ["turned as you like"]
    two = committee({}, {LEFT: (0.0, 0.1)}, scores=[1.0, 1.0])
    assert len(explanations(two, ("a", "b"))) == 1
    same = committee({LEFT: (0.0, 0.1)}, {LEFT: (0.0, 0.1)}, scores=[1.0, 0.5])
    assert len(explanations(same, ("a", "b"))) == 1
