"""What a generator proposes, and in which charts it carries demonstrations over."""

from __future__ import annotations

import numpy as np

from benchmarks.relations.geometry import pick, situations, trouble
from benchmarks.relations.hand import put, scenes, shown
from benchmarks.relations.measure import steady
from benchmarks.relations.relations import RELATIONS
from grounding.relations.charts import MODES
from grounding.relations.generator import learned
from grounding.relations.learner import trained
from grounding.relations.situation import Situations, joined
from tamp.geometric.scene.pose import Array


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
