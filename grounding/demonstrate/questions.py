"""Scenes to be asked about: those in which the explanations of the demonstrations differ most, with
bodies of those demonstrations at other heights and yaws, in other sizes.
"""

from __future__ import annotations

import numpy as np
from numpy.random import Generator as Random

from grounding.demonstrate.scene import Stage
from grounding.demonstrate.use import Uses
from grounding.registry import load_grounding
from grounding.relations.asking import questions
from grounding.relations.candidates import candidates
from grounding.relations.demonstration_file import demonstrations_of
from grounding.relations.evidence import gather
from grounding.relations.grounding import LearnedRelation
from grounding.relations.scenes import examples_of
from grounding.relations.situation import joined, situation_of
from grounding.runtime import Proposer
from tamp.errors import InputError

POOL_SCENES = 12
"""Scenes of which the questions are chosen."""

QUESTIONS_AT_ONCE = 3
"""Questions that are chosen at a time; then it is worth to learn again."""


def telling_stages(uses: Uses, rng: Random) -> list[Stage]:
    """Make scenes whose labels would tell most, the most telling first.

    Args:
        uses: The files of the relation, which has been learned.
        rng: The only source of randomness.

    Raises:
        InputError: It has not been learned, or its demonstrations cannot be read.
    """
    if not uses.weights.is_file():
        raise InputError(f"{uses.relation} has not been learned yet", remedy="Learn it first")
    learned = load_grounding(uses.weights)
    if isinstance(learned, Proposer):
        what = f"what was learned cannot tell yet where {uses.relation} holds"
        raise InputError(what, remedy="Show more of both labels, and learn again")
    if not isinstance(learned, LearnedRelation):
        raise InputError("nothing can be asked of these weights", file=uses.weights)

    shown = list(demonstrations_of(uses.relation, [uses.folder]))
    situations = joined([situation_of(one.scene, one.arguments) for one in shown])
    holds = np.array([one.holds for one in shown])
    if not holds.any():
        raise InputError(f"no demonstration says where {uses.relation} holds")
    other = situations.rows(np.flatnonzero(~holds)) if not holds.all() else None
    evidence = gather(situations.rows(np.flatnonzero(holds)), other, rng)

    pool = candidates(learned, examples_of(shown), POOL_SCENES, rng)
    if not pool:
        raise InputError("no scene to ask about was found", remedy="Go on with the next scene")
    found = joined([situation_of(one.scene, one.arguments) for one in pool])
    rows = questions(evidence, learned.committee, found, QUESTIONS_AT_ONCE)
    return [Stage(pool[row].bodies, pool[row].scene, pool[row].arguments) for row in rows.tolist()]
