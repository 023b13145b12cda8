"""Hints while demonstrations are made: what is the same in all of them, what is said both ways,
which label is missing.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from grounding.demonstrate.relation import DemonstratedRelation
from grounding.demonstrate.viewer import viewer_yaw
from grounding.relations.demonstration_file import Demonstration
from grounding.relations.situation import joined, situation_of
from grounding.relations.variety import unvaried
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body, Cylinder, Sphere

ENOUGH = 10
"""Demonstrations of each label with which a relation is usually learned well."""

SIMPLE = 5
"""Those in which it holds with which a simple one can be."""

FROM = 3
"""Demonstrations in which it holds from which on something counts as never varied."""

SAME_PLACE = 0.004
"""Metres by which a body may be moved and still be in the same situation."""

SAME_TURN = math.radians(2.0)
"""Radians by which it may be turned and still be in the same situation."""


@dataclass(frozen=True)
class Hint:
    """Something to do next, or that is wrong.

    Attributes:
        kind: "next", "variety", "contradiction", "labels".
        text: A sentence or two.
        files: The demonstrations that it is about.
    """

    kind: str
    text: str
    files: tuple[str, ...] = ()


def hints(relation: DemonstratedRelation, demonstrations: Sequence[Demonstration]) -> list[Hint]:
    """Say what demonstrations lack: the contradictions first, then the labels, then variety."""
    found = [*contradictions(demonstrations), *_labels(relation, demonstrations)]
    holding = [one for one in demonstrations if one.holds]
    if len(holding) >= FROM:
        found += _variety(relation, holding)
    return found


def contradictions(demonstrations: Sequence[Demonstration]) -> Iterator[Hint]:
    """Find pairs that are the same situation with opposite labels."""
    keyed = [(one, _situation(one)) for one in demonstrations]
    for (first, one), (second, other) in combinations(keyed, 2):
        if first.holds != second.holds and _alike(one, other):
            files = (_file(first), _file(second))
            text = f"{files[0]} and {files[1]} show the same and say the opposite: delete one"
            yield Hint("contradiction", text, files)


def contradicted(shown: Demonstration, others: Sequence[Demonstration]) -> list[str]:
    """Say which demonstrations show the same as one that is not kept yet, and say the opposite."""
    situation = _situation(shown)
    return [
        f"{_file(other)} shows the same and says the opposite"
        for other in others
        if other.holds != shown.holds and _alike(situation, _situation(other))
    ]


def next_step(relation: DemonstratedRelation, demonstrations: Sequence[Demonstration]) -> str:
    """Say what to do next, in a sentence or two, to somebody who has never seen the page."""
    holding = sum(one.holds for one in demonstrations)
    other = len(demonstrations) - holding
    if holding == 0:
        return f"Move the bodies so that {relation.name} holds, then press H."
    if other == 0:
        return (
            f"Now show where {relation.name} does not hold, and press N. "
            "A near miss teaches most: almost so, but not quite."
        )
    if holding < SIMPLE or other < SIMPLE:
        more = "holds (H)" if holding <= other else "does not hold (N)"
        return f"Go on: other scenes, other ways. Next one where it {more}."
    if holding < ENOUGH or other < ENOUGH:
        return (
            f"You can learn it now, or go on to {ENOUGH} of each label: it gets more certain. "
            "Show the limits: the farthest that still holds, the nearest that does not."
        )
    return "That is usually enough: press Learn."


def _labels(
    relation: DemonstratedRelation, demonstrations: Sequence[Demonstration]
) -> Iterator[Hint]:
    holding = sum(one.holds for one in demonstrations)
    other = len(demonstrations) - holding
    if holding >= FROM and other == 0:
        text = (
            f"No demonstration says where {relation.name} does not hold: "
            "what it is not cannot be learned"
        )
        yield Hint("labels", text)
    if other >= FROM and holding == 0:
        yield Hint("labels", f"No demonstration says where {relation.name} holds")


def _variety(relation: DemonstratedRelation, holding: Sequence[Demonstration]) -> Iterator[Hint]:
    """Find what is the same in all demonstrations in which the relation holds."""
    names = [one.name for one in relation.arguments]
    if any(len(one.arguments) != len(names) for one in holding):
        return
    situations = joined([situation_of(one.scene, one.arguments) for one in holding])
    for key, text in unvaried(situations, np.ones(len(holding), dtype=bool), names):
        turned = key.removeprefix("yaw of ")
        if turned.isdecimal() and any(_is_round(one, int(turned)) for one in holding):
            continue
        yield Hint("variety", text)


def _situation(one: Demonstration) -> tuple[tuple[str, ...], Array, Array]:
    """Describe all that may matter: places and box sizes of the arguments (metres), rotations."""
    shown = [one.scene.bodies[name] for name in one.arguments if name in one.scene.bodies]
    yaw = viewer_yaw(one.scene, one.arguments)
    lengths: list[float] = []
    turns = [math.cos(yaw), math.sin(yaw)]
    for body in shown:
        lengths += [*_size(body), *body.pose.position]
        turns += body.pose.rotation.ravel().tolist()
    places = tuple(name for name in one.arguments if name not in one.scene.bodies)
    return (str(len(shown)), *places), np.array(lengths), np.array(turns)


def _alike(
    one: tuple[tuple[str, ...], Array, Array], other: tuple[tuple[str, ...], Array, Array]
) -> bool:
    return (
        one[0] == other[0]
        and one[1].shape == other[1].shape
        and bool(np.abs(one[1] - other[1]).max(initial=0.0) < SAME_PLACE)
        and bool(np.abs(one[2] - other[2]).max(initial=0.0) < math.sin(SAME_TURN))
    )


def _size(body: Body) -> list[float]:
    low, high = bounds(body.parts, Pose())
    return sorted((high - low).tolist())


def _is_round(one: Demonstration, number: int) -> bool:
    """Check whether turning an argument shows nothing: a cylinder that stands, a ball."""
    body = one.scene.bodies.get(one.arguments[number])
    if body is None:
        return True
    upright = abs(float(body.pose.rotation[2, 2])) > 0.99
    shapes = [part.shape for part in body.parts]
    return all(
        isinstance(shape, Sphere) or (isinstance(shape, Cylinder) and upright) for shape in shapes
    )


def _file(one: Demonstration) -> str:
    return one.source.partition(":")[0]
