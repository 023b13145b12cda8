"""Candidate measures of a situation: what may be constant in a relation, with how finely a hand can
show it, and how much it has to prove.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from grounding.relations.measure_kernels import measure_rows
from grounding.relations.situation import Situations
from tamp.geometric.scene.pose import Array

TURN = 2 * math.pi


class Measure(NamedTuple):
    """A measure of situations.

    Attributes:
        key: Its name: "height: foot, top of 1".
        scale: What a hand cannot do better than, metres or radians.
        cost: Nats against it: 0 for what is relative, 5 for what is absolute.
        period: Of an angle, radians; 0 for none.
        kind: What prior it falls under: height, up, turn, place, gap, size, absolute.
        least: Whether it cannot be below zero.
        words: For a reader, with {0}, {1}, ... for the arguments.
        unit: "mm", "deg" or "" for a share.
    """

    key: str
    scale: float
    cost: float
    period: float
    kind: str
    least: bool
    words: str
    unit: str


def measure(situations: Situations) -> Array:
    """Measure situations, in the order of `catalogue`, shape (n, f)."""
    s = situations
    out = np.empty((len(s), len(catalogue(s.arguments))))
    measure_rows(s.corners, s.counts, s.half, s.inner, s.shape, s.R, s.p, s.support, out)
    return out


@lru_cache(maxsize=8)
def catalogue(arguments: int) -> tuple[Measure, ...]:
    """List the measures of situations of so many arguments."""
    k = arguments
    listed = [*_heights(k), *_ups(k), *_turns(k)]
    for j in range(1, k):
        listed += _pair(k, j)
    if k > 2:
        listed += _line()
    return tuple([*listed, *_furniture()])


def frame_names(k: int) -> list[tuple[str, float, str]]:
    """List the horizontal frames: name, cost, words for "seen from"."""
    frames = [("world", 2.0, "in the world"), ("furniture", 0.3, "seen from the front")]
    frames += [(f"yaw of {j}", 0.3, f"along {{{j}}}'s own sides") for j in range(1, k)]
    if k > 2:
        frames.append(("line", 0.0, "along the line from {1} to {2}"))
    return frames


def _mm(key: str, scale: float, cost: float, kind: str, words: str, least: bool = False) -> Measure:
    return Measure(key, scale, cost, 0.0, kind, least, words, "mm")


def _deg(
    key: str, scale: float, cost: float, kind: str, words: str, period: float = 0.0,
    least: bool = False,
) -> Measure:  # fmt: skip
    return Measure(key, scale, cost, period, kind, least, words, "deg")


def _heights(k: int) -> Iterator[Measure]:
    for here in ("foot", "middle", "top"):
        own = "" if here == "foot" else f" of its {here}"
        more = 0.5 if here == "middle" else 0.0
        words = f"height{own} above"
        yield _mm(f"height: {here}, surface", 0.004, more, "height", f"{words} the surface")
        yield _mm(f"height: {here}, world", 0.004, 5.0 + more, "height", f"{words} the ground")
        for j in range(1, k):
            for there, cost in (("foot", 0.0), ("middle", 0.5), ("top", 0.0), ("floor", 0.0)):
                key = f"height: {here}, {there} of {j}"
                said = f"{words} the {there} of {{{j}}}"
                yield _mm(key, 0.004, cost + more, "height", said)


def _ups(k: int) -> Iterator[Measure]:
    for i in range(k):
        cost = 0.0 if i == 0 else 1.0
        for axis in range(3):
            name, more = "xyz"[axis], 0.5 * (axis < 2)
            words = f"{{{i}}}'s {name} axis from upright"
            yield _deg(f"up: {name} of {i}", 0.12, cost + more, "up", words, least=True)
            words = f"{{{i}}}'s {name} axis from upright or upside down"
            yield _deg(f"up or down: {name} of {i}", 0.12, cost + 0.5, "up", words, least=True)
        words = f"tilt of {{{i}}}"
        yield _deg(f"tilt: {i}", 0.06, cost, "up", words, least=True)
        for what in ("longest", "shortest"):
            words = f"{{{i}}}'s {what} side from upright"
            yield _deg(f"up: {what} of {i}", 0.12, cost + 1.5, "up", words, least=True)


def _turns(k: int) -> Iterator[Measure]:
    references = [
        *(
            (name, cost, words.replace("seen from", "against"))
            for name, cost, words in frame_names(k)
        ),
        *((f"towards {j}", 0.0, f"towards {{{j}}}") for j in range(1, k)),
    ]
    ways = (
        (TURN, 0.0, ""),
        (TURN / 2, 0.5, ", either way round"),
        (TURN / 4, 1.0, ", by any side"),
    )
    for name, cost, said in references:
        for period, more, way in ways:
            key = f"turn {math.degrees(period):.0f}: {name}"
            yield _deg(key, 0.14, cost + more, "turn", f"turned {said}{way}", period)
        if name.startswith("towards"):
            yield _deg(f"tilted: {name}", 0.14, 0.5, "turn", f"tilted {said}", TURN)


def _pair(k: int, j: int) -> Iterator[Measure]:
    for name, cost, seen in frame_names(k):
        yield _deg(
            f"direction: {j} in {name}", 0.1, cost + 0.5, "place", f"direction from {{{j}}} {seen}",
            TURN,
        )  # fmt: skip
        for axis in "xy":
            yield from _offset(j, axis, name, cost, seen)
        if name == f"yaw of {j}":
            yield _mm(f"room within {j}", 0.005, 0.0, "gap", f"room to the sides inside {{{j}}}")
            words = f"its middle from the edge of {{{j}}}, inward"
            yield _mm(f"middle within {j}", 0.008, 0.0, "gap", words)

    yield _mm(f"distance: {j}", 0.015, 0.0, "place", f"distance from {{{j}}}", least=True)
    yield _mm(f"level gap: {j}", 0.01, 0.0, "gap", f"gap beside {{{j}}}")
    yield _mm(f"space gap: {j}", 0.006, 0.0, "gap", f"gap to {{{j}}}")
    words = f"height of {{{j}}} above the surface"
    yield _mm(f"height: foot of {j}, surface", 0.006, 1.0, "height", words)
    yield _deg(
        f"turn: {j} in furniture", 0.14, 2.0, "turn", f"turn of {{{j}}} on the furniture", TURN
    )
    words = f"size against {{{j}}} (logarithm)"
    yield Measure(f"size: {j}", 0.15, 2.0, 0.0, "size", False, words, "")


def _offset(j: int, axis: str, frame: str, cost: float, seen: str) -> Iterator[Measure]:
    right, left = ("right of", "left of") if axis == "x" else ("behind", "in front of")
    at = f"{axis} of {j} in {frame}"
    other = f"{{{j}}} {seen}"
    yield _mm(f"middle: {at}", 0.012, cost, "place", f"{right} the middle of {other}")
    yield _mm(f"gap above: {at}", 0.012, cost, "place", f"gap {right} {other}")
    yield _mm(f"gap below: {at}", 0.012, cost, "place", f"gap {left} {other}")
    words = f"{right} {{{j}}}'s {'right' if axis == 'x' else 'rear'} edge {seen}"
    yield _mm(f"flush above: {at}", 0.012, cost + 0.5, "place", words)
    words = f"{left} {{{j}}}'s {'left' if axis == 'x' else 'front'} edge {seen}"
    yield _mm(f"flush below: {at}", 0.012, cost + 0.5, "place", words)
    words = f"share of half the width of {{{j}}}, {right} its middle {seen}"
    yield Measure(f"share: {at}", 0.1, cost + 0.5, 0.0, "place", False, words, "")
    way = "sideways" if axis == "x" else "back or forth"
    words = f"from the middle of {other}, {way}"
    yield _mm(f"either side middle: {at}", 0.012, cost + 0.3, "place", words, least=True)
    yield _mm(f"either side gap: {at}", 0.012, cost + 0.3, "place", f"gap beside {other}, {way}")
    yield _mm(f"sticks out: {at}", 0.008, cost + 0.3, "place", f"sticks out of {other}, {way}")
    words = f"its middle sticks out of {other}, {way}"
    yield _mm(f"middle sticks out: {at}", 0.008, cost + 0.3, "place", words)


def _line() -> Iterator[Measure]:
    words = "share of the way from {1} to {2}"
    yield Measure("line: share", 0.05, 0.0, 0.0, "place", False, words, "")
    words = "share of the way from half way between {1} and {2}"
    yield Measure("line: from middle", 0.05, 0.2, 0.0, "place", True, words, "")
    yield _mm("line: beside", 0.012, 0.0, "place", "left of the line from {1} to {2}")
    words = "distance from the line between {1} and {2}"
    yield _mm("line: either side", 0.012, 0.2, "place", words, least=True)
    yield _mm("line: beyond either", 0.015, 0.3, "place", "beyond {1} or {2} along their line")
    yield _deg(
        "line: angle", 0.12, 0.3, "place", "angle between {1} and {2} seen from it", least=True
    )
    yield _mm("line: beyond 2", 0.015, 0.2, "place", "beyond {2} along the line from {1}")
    yield _mm("nearer: 1", 0.015, 0.8, "place", "farther from {1} than from {2}")
    for near, far in ((1, 2), (2, 1)):
        words = f"farther from {{{near}}} than {{{far}}} is"
        yield _mm(f"farther: {near}", 0.015, 1.0, "place", words)


def _furniture() -> Iterator[Measure]:
    for axis, sides, way in (("x", ("left", "right"), "right"), ("y", ("front", "rear"), "behind")):
        words = (
            f"{way} of the furniture's middle" if axis == "x" else "behind the furniture's middle"
        )
        yield _mm(f"furniture: {axis}", 0.012, 1.0, "absolute", words)
        words = f"its middle beyond either {'end' if axis == 'x' else 'long edge'} of the furniture"
        yield _mm(f"furniture: {axis} edges", 0.012, 1.0, "absolute", words)
        for side in sides:
            words = f"from the {side} edge of the furniture"
            yield _mm(f"furniture: {side} edge", 0.012, 0.8, "absolute", words)
        yield _mm(f"world: {axis}", 0.012, 5.0, "absolute", f"{axis} in the world")

    yield _mm(
        "furniture: any edge", 0.012, 0.8, "absolute", "from the nearest edge of the furniture"
    )
    yield _mm("furniture: end", 0.012, 0.9, "absolute", "from the nearer end of the furniture")
    words = "from the nearer long edge of the furniture"
    yield _mm("furniture: long edge", 0.012, 0.9, "absolute", words)
    words = "from both edges of the nearest corner of the furniture, at most"
    yield _mm("furniture: corner", 0.012, 0.8, "absolute", words)
    words = "distance from the furniture's middle"
    yield _mm("furniture: middle", 0.015, 0.8, "absolute", words, least=True)
