"""Lack of variety in demonstrations: what was the same in all of them, and what mends it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchmarks.relations.asking import told
from benchmarks.relations.geometry import about_z, situations
from benchmarks.relations.hand import shown
from grounding.relations.demonstration_file import Demonstration, demonstrations_of
from grounding.relations.situation import Situations, joined, situation_of
from grounding.relations.variety import contradiction, missing, unvaried
from tests.grounding.relations.made import BOX, THING, situation
from tests.grounding.relations.shown import write_demos


@pytest.mark.parametrize(
    ("fixed", "key", "words"),
    [
        ({"height": 0.7}, "height", "all surfaces were 0.7 m high"),
        ({"yaw": 0.4}, "yaw", "all furniture was turned the same way"),
        ({"cup": 0.04}, "size of 0", "cup was always 8 x 8 x 8 cm large"),
    ],
)
def test_what_is_not_varied_is_warned_of(
    fixed: dict[str, float], key: str, words: str, tmp_path: Path
) -> None:
    found = list(demonstrations_of("left_of", [write_demos(tmp_path, good=6, bad=6, **fixed)]))
    every = joined([situation_of(one.scene, one.arguments) for one in found])
    holds = np.array([one.holds for one in found])
    warned = dict(unvaried(every, holds, ("cup", "plate")))
    assert words in warned[key] and "size of 1" not in warned
    assert not missing(holds)


def test_varied_demonstrations_are_not_warned_of(demos: list[Demonstration]) -> None:
    every = joined([situation_of(one.scene, one.arguments) for one in demos])
    assert unvaried(every, np.array([one.holds for one in demos]), ("cup", "plate")) == []


def test_a_body_that_is_never_turned_on_the_furniture_is_warned_of() -> None:
    """Left of it and left on the furniture are the same then, however the furniture is turned."""
    rng = np.random.default_rng(0)
    s, holds = situations(shown("left_of_front", 10, True, rng)), np.ones(10, dtype=bool)
    assert unvaried(s, holds, ("a", "b")) == []
    s.R[:, 1] = about_z(s.support[:, 1] + 0.3)
    ((key, text),) = unvaried(s, holds, ("a", "b"))
    assert key == "yaw of 1 on it"
    assert text == "b was always turned the same way on the furniture: turn it"


@pytest.mark.slow
def test_one_demonstration_that_does_what_is_asked_for_mends_one_yaw() -> None:
    found = np.array(
        [told(name, seed) for name in ("left_of_front", "aligned") for seed in (0, 2, 3)]
    )
    before, after, left = found.mean(axis=0)
    assert before < 0.7 and after > 0.9 and left == 0, found


def test_what_was_always_in_one_place_of_the_furniture_is_warned_of() -> None:
    rng = np.random.default_rng(1)
    s = situations(shown("next_to", 10, True, rng))
    keys = [key for key, _ in unvaried(s, np.ones(10, dtype=bool), ("a", "b"))]
    assert "place of 1" not in keys
    s.p[:, 1, :2] = s.support[:, 2:4]
    found = dict(unvaried(s, np.ones(10, dtype=bool), ("a", "b")))
    assert found["place of 1"].startswith("b was always in the same place of the furniture")


def things(*at: tuple[float, float, float]) -> Situations:
    return joined([situation((THING, *one), (BOX, 0.0, 0.0, 0.0)) for one in at])


def test_one_situation_with_both_labels_is_a_contradiction() -> None:
    apart = things((0.2, 0.0, 0.0), (0.3, 0.0, 0.0), (0.2, 0.0, 0.0), (0.2001, 0.0002, 0.0))
    holds = [True, False, False, False]
    assert contradiction(apart, np.array(holds)) == (0, 2)
    assert contradiction(apart, np.array([True, False, True, False])) is None
    assert contradiction(apart.rows([0, 3]), np.array([True, False])) is None
    larger = replace(apart, half=apart.half * np.where(np.arange(16) >= 8, 1.5, 1.0)[:, None])
    assert contradiction(larger.rows([0, 2]), np.array([True, False])) is None


@pytest.mark.parametrize(
    ("yes", "no", "said"),
    [
        (10, 0, ["nothing shows where it does not hold: show about 10, best near misses"]),
        (10, 4, ["only 4 show where it does not hold: show about 10, best near misses"]),
        (4, 5, ["only 4 show where it holds: show about 10"]),
        (5, 5, []),
    ],
)
def test_labels_of_both_kinds_are_asked_for(yes: int, no: int, said: list[str]) -> None:
    assert missing(np.arange(yes + no) < yes) == said


def test_one_demonstration_alone_is_not_told_to_vary() -> None:
    assert unvaried(things((0.2, 0.0, 0.0)), np.array([True]), ("a", "b")) == []
