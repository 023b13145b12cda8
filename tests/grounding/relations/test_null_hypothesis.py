"""Chance: what comes about without a relation being meant."""

from __future__ import annotations

import numpy as np

from benchmarks.relations.geometry import situations
from benchmarks.relations.hand import shown
from benchmarks.relations.relations import RELATIONS
from grounding.relations.null_hypothesis import chance
from grounding.relations.situation import joined


def test_chance_varies_what_demonstrations_may_not() -> None:
    s = situations(shown("left_of_front", 10, True, np.random.default_rng(0), lazy="all"))
    made = chance(s, np.random.default_rng(1), 500)
    assert np.ptp(made.support[:, 0]) > 0.8 and np.ptp(made.support[:, 1]) > 4
    assert np.ptp(made.half[made.shape[:, 0]], axis=0).min() > 0.02
    assert len(joined([s, made])) == 510 and RELATIONS["left_of_front"].arguments == 2
    assert np.allclose(np.linalg.det(made.R), 1.0)
