"""A beam search for the conjunctions that make demonstrations the least of a coincidence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from grounding.relations.evidence import RIGHT, UNTOUCHED, ZERO, Bounds, Evidence, Settings
from tamp.geometric.scene.pose import Array

OFFSET_PRICES_NATS = {
    "middle": (1.5, False),
    "either side middle": (1.5, False),
    "gap above": (3.0, True),
    "gap below": (3.0, True),
    "either side gap": (3.0, True),
    "flush above": (2.0, False),
    "flush below": (2.0, False),
    "sticks out": (2.0, False),
    "middle sticks out": (2.0, False),
}
"""Nats against an offset that is not zero, or against a gap (signed) that is none."""

ENOUGH_NEGATIVES = 4
"""Negatives from which on it counts what they vary."""


@dataclass(frozen=True, eq=False)
class Found:
    """The best conjunctions: columns of the catalogue, weights of sum 1, evidence in nats."""

    members: list[tuple[int, ...]]
    weights: Array
    scores: Array


@dataclass(frozen=True, eq=False)
class _Partial:
    """A conjunction on the way: which situations are left, and what its conditions cost."""

    base: NDArray[np.bool_]
    bad: NDArray[np.bool_]
    paid: float


def conjunctions(e: Evidence, s: Settings, bounds: Bounds) -> Found:
    """Search for conjunctions; a condition pays by what chance and the negatives do not give."""
    in_base, in_bad = bounds.within(e.base), bounds.within(e.bad)
    price = prices(e, s, bounds) + (s.small if len(e.bad) else s.small_alone)
    base_columns, bad_columns = in_base.astype(np.float32), in_bad.astype(np.float32)
    worth = min(len(e.good), s.cap) / (1 + len(e.bad) / s.fade)

    whole = _Partial(np.ones(len(in_base), bool), np.ones(len(in_bad), bool), 0.0)
    beam: dict[frozenset[int], _Partial] = {frozenset(): whole}
    found: dict[frozenset[int], float] = {frozenset(): 0.0}
    for _ in range(s.depth):
        options: dict[frozenset[int], tuple[float, _Partial, int]] = {}
        for members, one in beam.items():
            left = one.base.astype(np.float32) @ base_columns / len(in_base)
            wrong = one.bad.astype(np.float32) @ bad_columns
            score = worth * np.log((1 + s.floor) / (left + s.floor))
            score += RIGHT * (len(in_bad) - wrong) - one.paid - price
            for column in np.argsort(-score)[: s.beam].tolist():
                if column not in members and score[column] > found[members]:
                    options[members | {column}] = (float(score[column]), one, column)
        if not options:
            break

        best = sorted(options.items(), key=lambda item: -item[1][0])[: s.beam]
        beam = {
            key: _Partial(
                one.base & in_base[:, column], one.bad & in_bad[:, column], one.paid + price[column]
            )
            for key, (_, one, column) in best
        }
        found |= {key: score for key, (score, _, _) in best}

    ranked = sorted(found.items(), key=lambda item: -item[1])[: s.members]
    scores = np.array([score for _, score in ranked])
    weights = np.exp((scores - scores[0]) / s.temper)
    return Found([tuple(sorted(key)) for key, _ in ranked], weights / weights.sum(), scores)


def prices(e: Evidence, s: Settings, bounds: Bounds) -> Array:
    """Return the nats that each condition costs beside what all cost, (f,)."""
    in_bad = bounds.within(e.bad)
    kinds = np.array([one.kind for one in e.measures])
    price = np.array([one.cost for one in e.measures]) + RIGHT * bounds.missed
    if len(e.bad) > ENOUGH_NEGATIVES:
        price += s.idle * (in_bad.mean(axis=0) > 0.85)  # nobody varied it: no evidence
    price += s.idle * ((kinds == "turn") & (e.good.std(axis=0) < UNTOUCHED))
    middle = np.sort(e.good, axis=0)[len(e.good) // 2]
    # With one size a height that is not zero is that size's, and so is a size against another.
    twice = 2.0 if e.one_size else 1.0
    price += twice * s.contact * ((kinds == "height") & (np.abs(middle) > ZERO))
    price += s.idle * (e.one_size & (kinds == "size"))
    into = np.array([one.key.startswith(("space gap", "level gap")) for one in e.measures])
    price += s.contact * (into & (middle < -2 * ZERO))  # how deep, nobody means
    price += _unnatural(e, middle)
    return np.where(e.allowed, price, np.inf)


def _unnatural(e: Evidence, middle: Array) -> Array:
    """Return the nats against offsets that have to be explained: zero needs no explanation, nor
    has a gap.
    """
    price = np.zeros(len(e.measures))
    for column, one in enumerate(e.measures):
        kind = one.key.partition(": ")[0]
        if kind not in OFFSET_PRICES_NATS:
            continue
        nats, signed = OFFSET_PRICES_NATS[kind]
        off = -middle[column] if signed else abs(middle[column])
        price[column] = nats * (off > 2 * one.scale)
    return price
