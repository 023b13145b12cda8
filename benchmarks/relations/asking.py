"""Accuracy by number of labels: chosen by the demonstrator, at random, or asked for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.random import Generator as Random

from benchmarks.relations.geometry import Batch, join, pick, situations
from benchmarks.relations.hand import put, scenes, shown, spoil
from benchmarks.relations.measure import accuracy
from benchmarks.relations.relations import RELATIONS
from grounding.relations.asking import questions
from grounding.relations.committee import fit
from grounding.relations.evidence import gather
from grounding.relations.variety import unvaried

DRAWN = 40
"""Demonstrations at random, of which one is taken that does what is asked for."""

WAYS = ("demonstrator", "random", "asked")
BEGINNINGS = {"varied": ((3, 2), "", (5, 10, 15, 20)), "one yaw": ((10, 10), "yaw", (20, 21, 24, 27))}


def curves(relations: Sequence[str], seeds: int) -> list[dict[str, str | float]]:
    """Begin with few labels, or with lazy ones, and go on in three ways."""
    rows: list[dict[str, str | float]] = []
    for beginning, ((good, bad), lazy, at) in BEGINNINGS.items():
        for way in WAYS:
            found = [_curve(name, seed, way, good, bad, lazy, at) for name in relations for seed in range(seeds)]
            mean = np.mean(found, axis=0)
            numbers = {f"{n} labels": round(float(one), 3) for n, one in zip(range(4), mean, strict=True)}
            rows.append({"beginning": beginning, "way": way, "at": " ".join(map(str, at)), **numbers})
    return rows


def told(name: str, seed: int) -> tuple[float, float, float]:
    """Begin with 20 labels at one yaw, and add one demonstration that does what the warnings about yaw ask for.

    Returns:
        Accuracy before and after, and how many warnings about yaw that one demonstration leaves.
    """
    rng = np.random.default_rng(seed)
    yes, no = shown(name, 10, True, rng, lazy="yaw"), shown(name, 10, False, rng, lazy="yaw")
    before = accuracy(fit(gather(situations(yes), situations(no), rng)), name, rng)
    more = [join(yes, shown(name, 1, True, rng)) for _ in range(DRAWN)]
    left = [_yaw_warnings(one) for one in more]
    best = int(np.argmin(left))
    after = accuracy(fit(gather(situations(more[best]), situations(no), rng)), name, rng)
    return before, after, left[best]


def _yaw_warnings(yes: Batch) -> int:
    s = situations(yes)
    found = unvaried(s, np.ones(len(s), dtype=bool), "abcdef"[: s.arguments])
    return sum(key.startswith("yaw") for key, _ in found)


def _curve(name: str, seed: int, way: str, good: int, bad: int, lazy: str, at: Sequence[int]) -> list[float]:
    rng = np.random.default_rng(seed)
    yes, no = shown(name, good, True, rng, lazy=lazy), shown(name, bad, False, rng, lazy=lazy)
    found: list[float] = []
    for count in at:
        while len(yes["p"]) + len(no["p"]) < count:
            yes, no = _more(name, way, yes, no, rng)
        evidence = gather(situations(yes), situations(no), rng)
        found.append(accuracy(fit(evidence), name, rng))
    return found


def _more(name: str, way: str, yes: Batch, no: Batch, rng: Random) -> tuple[Batch, Batch]:
    """Add one label: a demonstration of either kind, or the answer about a situation of a pool."""
    if way == "demonstrator":
        holds = len(yes["p"]) <= len(no["p"])
        one = shown(name, 1, holds, rng)
        return (join(yes, one), no) if holds else (yes, join(no, one))
    pool = _pool(name, rng)
    row = int(rng.integers(len(pool["p"])))
    if way == "asked":
        evidence = gather(situations(yes), situations(no), rng)
        row = int(questions(evidence, fit(evidence), situations(pool), 1)[0])
    one = pick(pool, [row])
    return (join(yes, one), no) if RELATIONS[name].holds(one)[0] else (yes, join(no, one))


def _pool(name: str, rng: Random) -> Batch:
    """Situations that a program can make without knowing the relation, and near ones."""
    s = scenes(name, 120, rng)
    near = spoil(put(name, pick(s, slice(60)), rng), rng, "near")
    return join(near, put(name, pick(s, slice(60, 90)), rng), spoil(pick(s, slice(90, None)), rng, "far"))
