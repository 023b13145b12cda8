"""Questions: which scene tells most."""

from __future__ import annotations

import numpy as np

from benchmarks.relations.geometry import situations
from benchmarks.relations.hand import shown
from grounding.relations.asking import questions
from grounding.relations.committee import fit
from grounding.relations.evidence import gather
from grounding.relations.situation import joined


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
