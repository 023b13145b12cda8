"""What is measured of one relation: classifier, proposals, their times, what a lazy hand leaves."""

from __future__ import annotations

import time
from typing import NamedTuple

import numpy as np
from numpy.random import Generator as Random

from benchmarks.relations.geometry import Array, Batch, pick, situations, trouble
from benchmarks.relations.hand import put, scenes, shown
from benchmarks.relations.relations import RELATIONS
from grounding.relations.committee import Committee
from grounding.relations.generator import PoseGenerator
from grounding.relations.learner import cross_validated, trained
from grounding.relations.situation import joined
from grounding.relations.variety import unvaried

TEST = 200
"""Situations of each label on which a classifier is judged."""

SCENES = 30
"""Scenes in which one pose is proposed."""

CLEAR = 0.002
"""Metres of trouble that a proposal may have."""


class Case(NamedTuple):
    """One relation learned from so many labels of each kind, by a hand that varies less or more."""

    relation: str
    good: int
    bad: int
    seed: int
    lazy: str = ""


def measured(case: Case) -> dict[str, float | str]:
    """Learn a relation and judge it by true geometry on unseen bodies, heights, yaws, sizes."""
    rng = np.random.default_rng(case.seed)
    good = shown(case.relation, case.good, True, rng, lazy=case.lazy)
    bad = shown(case.relation, case.bad, False, rng, lazy=case.lazy) if case.bad else None
    parts = [situations(good), *([situations(bad)] if bad is not None else [])]
    every = joined(parts)
    holds = np.arange(len(every)) < case.good

    started = time.process_time()
    committee, generator = trained(every, holds, rng, case.relation != "leaning")
    training = time.process_time() - started
    proposals, proposing = holding(generator, case.relation, rng)
    names = ("object", "other", "third")
    return {
        "classifier": accuracy(committee, case.relation, rng),
        "proposals": proposals,
        "training_cpu_s": training,
        "proposal_ms": proposing,
        "warned": " ".join(key for key, _ in unvaried(every, holds, names)),
    }


def held_out(case: Case, shuffled: bool = False) -> float:
    """Cross-validate a relation, perhaps with labels at random."""
    rng = np.random.default_rng(case.seed)
    every = joined(
        [situations(shown(case.relation, count, kind, rng)) for count, kind in ((case.good, True), (case.bad, False))]
    )
    holds = np.arange(len(every)) < case.good
    if shuffled:
        holds = rng.permutation(holds)
    found = cross_validated(every, holds, [str(row) for row in range(len(every))], rng)
    return float("nan") if found is None else found.mean


def accuracy(committee: Committee, name: str, rng: Random) -> float:
    """The mean recall of both labels on unseen situations."""
    good, bad = (situations(shown(name, TEST, holds, rng, test=True)) for holds in (True, False))
    yes, no = committee.predict(good) >= 0.5, committee.predict(bad) >= 0.5
    return float((yes.mean() + 1 - no.mean()) / 2)


def steady(s: Batch, row: int) -> Array:
    """Ways in which argument 0 stands: down vectors in its frame."""
    z = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]])
    return z if s["cyl"][row, 0] else np.concatenate([np.eye(3), -np.eye(3)])


def holding(generator: PoseGenerator, name: str, rng: Random) -> tuple[float, float]:
    """The share of unseen scenes, where it can hold at all, in which the one proposed pose holds and is clear; and the
    median time of one, milliseconds of the processor.
    """
    s, oracle = scenes(name, SCENES, rng, test=True), RELATIONS[name].holds
    possible = np.zeros(SCENES, dtype=bool)
    for _ in range(40):
        tried = put(name, pick(s, slice(None)), rng)
        possible |= oracle(tried) & (trouble(tried) < CLEAR)

    held: list[bool] = []
    times: list[float] = []
    for row in np.flatnonzero(possible):
        one = pick(s, [row])
        seen, down = situations(one), steady(one, 0)
        started = time.process_time()
        R, p = generator.propose(seen, 1, rng, down)
        times.append(time.process_time() - started)
        one["R"][:, 0], one["p"][:, 0] = R[0], p[0]
        held.append(bool(oracle(one)[0] and trouble(one)[0] < CLEAR))
    return float(np.mean(held)), 1000 * float(np.median(times))
