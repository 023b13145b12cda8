"""Explanations of a relation in words: of those that fit equally well the most natural first."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from grounding.relations.catalogue import Measure, catalogue
from grounding.relations.committee import Committee

EQUAL = 2.5
"""Explanations whose evidence differs by fewer nats fit equally well."""

SHOWN = 3
"""Explanations that are told, the first included."""

ODD = {"share": 1.5, "flush": 1.0, "sticks": 1.0, "middle sticks": 1.0, "room": 0.7, "size": 2.0}
"""How unnatural measures sound, by the first words of their keys; heights of the middle, too."""


def explanations(committee: Committee, names: Sequence[str]) -> list[str]:
    """Return the explanations that fit equally well, the most natural one first.

    Args:
        committee: What was learned.
        names: Of the arguments.
    """
    scores, found = committee.scores, dict[str, float]()
    for member in range(len(scores)):
        if scores[0] - scores[member] > EQUAL:
            continue
        columns = [committee.used[row] for row in committee.conditions[member] if row >= 0]
        if not columns and len(scores) > 1:
            continue
        text = described(committee, member, names)
        oddity = sum(_oddity(catalogue(committee.arguments)[column]) for column in columns)
        found.setdefault(text, oddity + (scores[0] - scores[member]))
    return sorted(found, key=found.__getitem__)[:SHOWN]


def described(committee: Committee, member: int, names: Sequence[str]) -> str:
    """Return one conjunction in words."""
    listed, said, turned = catalogue(committee.arguments), list[str](), False
    for place, row in enumerate(committee.conditions[member]):
        if row < 0:
            continue
        one, zero = listed[committee.used[row]], committee.zero[committee.used[row]]
        turned = turned or one.kind == "turn"
        low, high = committee.low[member, place] + zero, committee.high[member, place] + zero
        said.append(_interval(one, float(low), float(high), names))
    if not turned:
        said.append("turned as you like")
    return "; ".join(said)


def _interval(one: Measure, low: float, high: float, names: Sequence[str]) -> str:
    words = one.words.format(*names)
    factor, unit = {"mm": (1000.0, " mm"), "deg": (180 / math.pi, " degrees"), "": (1.0, "")}[
        one.unit
    ]
    step = 1.0 if one.unit else 0.01
    numbers = [np.round(value * factor / step) * step + 0.0 for value in (low, high)]
    if one.least and (not math.isfinite(low) or numbers[0] <= 0):
        return f"{words}: at most {numbers[1]:g}{unit}"
    if not math.isfinite(high):
        return f"{words}: at least {numbers[0]:g}{unit}"
    return f"{words}: {numbers[0]:g} to {numbers[1]:g}{unit}"


def _oddity(one: Measure) -> float:
    extra = max((more for start, more in ODD.items() if one.key.startswith(start)), default=0.0)
    return one.cost + extra
