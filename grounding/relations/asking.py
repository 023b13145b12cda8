"""Active learning: which scene to show next, and which question to ask."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from grounding.relations.catalogue import measure
from grounding.relations.committee import Committee, fit
from grounding.relations.evidence import Evidence, Settings
from grounding.relations.situation import Situations
from tamp.geometric.scene.classifier import LIKELY_PROBABILITY
from tamp.geometric.scene.pose import Array

OPEN = Settings(idle=0.0, contact=0.0, temper=3.0)
"""A committee that holds nothing against what was not varied: where it differs from the one that
votes, an answer tells most.
"""


def dispute(committee: Committee, situations: Situations) -> Array:
    """Return how much the members of a committee dispute each situation, 0 to 1, (n,)."""
    votes = committee.votes(committee.centred(measure(situations))) >= LIKELY_PROBABILITY
    yes = votes @ committee.weights
    return 4.0 * yes * (1.0 - yes)


def doubt(committee: Committee, situations: Situations) -> Array:
    """Return how near to a half the vote is, 0 to 1, (n,)."""
    return 1.0 - np.abs(2.0 * committee.predict(situations) - 1.0)


def questions(
    evidence: Evidence, committee: Committee, pool: Situations, count: int
) -> NDArray[np.intp]:
    """Choose situations to ask yes or no about: doubtful, disputed, and unlike each other.

    Args:
        evidence: Of the demonstrations so far.
        committee: Of them.
        pool: Of which to choose.
        count: How many.

    Returns:
        Rows of the pool, the most telling first.
    """
    liberal = fit(evidence, OPEN)
    apart = np.abs(committee.predict(pool) - liberal.predict(pool))
    value = doubt(committee, pool) + dispute(committee, pool) + dispute(liberal, pool) + apart

    values = committee.centred(measure(pool))[:, committee.used]
    scale = np.maximum(values.std(axis=0), 1e-9)
    chosen: list[int] = []
    for _ in range(min(count, len(pool))):
        row = int(np.argmax(value))
        chosen.append(row)
        away = (np.abs(values - values[row]) / scale).mean(axis=1)
        value = np.where(away < 0.3, value - 1.0, value)
        value[row] = -np.inf
    return np.array(chosen, dtype=np.intp)
