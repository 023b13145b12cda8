"""What a generator proposes, and in which charts it carries demonstrations over."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.relations.geometry import pick, situations, trouble
from benchmarks.relations.hand import put, scenes, shown
from benchmarks.relations.measure import steady
from benchmarks.relations.relations import RELATIONS
from grounding.relations.charts import MODES
from grounding.relations.generator import _spread, _turned_down, learned, level_of, onto
from grounding.relations.learner import trained
from grounding.relations.null_hypothesis import about_z
from grounding.relations.situation import Situations, joined
from tamp.geometric.scene.pose import Array
from tests.grounding.relations.made import BOX, CRATE, THING, TOP, situation


def test_several_proposals_differ_and_hold() -> None:
    rng = np.random.default_rng(0)
    good, bad = shown("next_to", 10, True, rng), shown("next_to", 10, False, rng)
    _, generator = trained(joined([situations(good), situations(bad)]), np.arange(20) < 10, rng)
    s = put("next_to", scenes("next_to", 6, rng, test=True), rng)
    faces: set[int] = set()
    for row in range(6):
        one = pick(s, [row])
        R, p = generator.propose(situations(one), 16, rng, steady(one, 0))
        many = pick(s, [row] * len(R))
        many["R"][:, 0], many["p"][:, 0] = R, p
        assert (
            len(R) == 16
            and (RELATIONS["next_to"].holds(many) & (trouble(many) < 0.002)).mean() > 0.8
        )
        apart = np.abs(p[:, None] - p).max(axis=2) + 10 * np.abs(R[:, None] - R).max(axis=(2, 3))
        assert (apart + np.eye(16)).min() > 1e-3
        faces |= {*np.abs(R[:, 2]).argmax(axis=1).tolist()}
    assert len(faces) > 1  # turned as you like: on other sides, too


class Pleased:
    """A committee to which everything holds."""

    def predict(self, situations: Situations) -> Array:
        return np.ones(len(situations))


def test_a_chart_that_carries_bodies_into_each_other_is_not_chosen() -> None:
    """Beside another one there is no room in it: shares of that agree, and are of no use."""
    s = situations(shown("next_to", 12, True, np.random.default_rng(0)))
    s.p[:, 0, :2] = s.p[:, 1, :2] + [0.3, 0.0]
    chosen = learned(Pleased(), s, np.random.default_rng(0))  # type: ignore[arg-type]
    modes = [MODES[code] for code in chosen.shown.codes[:, 2]]
    assert len(modes) == 5 and "room" not in modes


def test_the_level_is_what_it_stands_on_wherever_it_was_shown() -> None:
    beside = joined([situation((THING, x, 0.0, 0.0), (BOX, 0.0, 0.0, 0.0)) for x in (0.2, 0.3)])
    inside = joined([situation((THING, x, 0.0, 0.0), (CRATE, 0.0, 0.0, 0.0)) for x in (0.0, 0.1)])
    atop = beside.rows([0, 1])
    atop.p[:, 0] = [0.0, 0.0, TOP + 0.08 + 0.05]
    inside.p[:, 0, 2] = TOP + 0.02 + 0.05 + 0.001
    assert [level_of(one) for one in (beside, atop, inside)] == [0, 1, -1]
    for level, height in ((0, TOP), (1, TOP + 0.2), (-1, TOP + 0.02)):
        assert onto(inside, level) == pytest.approx([height, height])


def test_a_table_is_thought_of_before_a_low_body() -> None:
    """Two millimetres that nobody means decide nothing."""
    s = situation((THING, 0.2, 0.0, 0.0), (BOX, 0.0, 0.0, 0.0))
    s.p[0, 0, 2] = TOP + 0.05 + 0.0405  # half way up the box, a hair nearer its top
    assert level_of(s) == 0
    s.p[0, 0, 2] = TOP + 0.05 + 0.0415
    assert level_of(s) == 1


@pytest.mark.parametrize("down", [(0.0, 0.0, -1.0), (1.0, 0.0, 0.0), (0.0, 0.6, 0.8)])
def test_a_body_is_turned_so_that_this_side_is_down(down: tuple[float, float, float]) -> None:
    found = _turned_down(np.array([down] * 50), np.random.default_rng(0))
    assert found @ np.array(down) == pytest.approx(np.tile([0.0, 0.0, -1.0], (50, 1)))
    assert np.linalg.det(found) == pytest.approx(np.ones(50))
    assert found[:, :2, 1].std(axis=0).min() > 0.5  # at any yaw


def test_proposals_of_one_call_are_apart_in_place_or_yaw() -> None:
    yaws = [0.0, 0.0, 0.2, 0.0, 0.1, math.pi]
    p = np.array([[0, 0, 0], [0.009, 0, 0], [0, 0, 0], [0.011, 0, 0], [0, 0, 0], [0, 0, 0]])
    R = about_z(np.array(yaws))
    found, at = _spread(R, p, np.arange(6), 9)
    assert at[:, 0].tolist() == [0.0, 0.0, 0.011, 0.0]
    assert found == pytest.approx(R[[0, 2, 3, 5]])
    assert len(_spread(R, p, np.arange(6), 2)[0]) == 2
    assert _spread(R, p, np.array([4, 0]), 9)[0] == pytest.approx(R[[4]])
