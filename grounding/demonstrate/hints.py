"""Hints while demonstrations are made: what is the same in all of them, what is said both ways,
which label is missing.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from grounding.demonstrate.relation import Relation
from grounding.demonstrate.scene import viewer_yaw
from grounding.relations.demonstration_file import Demonstration
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body, Cylinder, Sphere

ENOUGH = 10
"""Demonstrations of each label with which a relation is usually learned well."""

SIMPLE = 5
"""Those in which it holds with which a simple one can be."""

FROM = 3
"""Demonstrations in which it holds from which on something counts as never varied."""

SAME_HEIGHT = 0.02
"""Metres by which heights may differ and still be one."""

SAME_SIZE = 0.004
"""Metres, of the edges of the box around a body."""

SAME_YAW = math.radians(8.0)
"""A hand that turns nothing keeps a yaw to this, radians."""

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


def hints(relation: Relation, demonstrations: Sequence[Demonstration]) -> list[Hint]:
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


def next_step(relation: Relation, demonstrations: Sequence[Demonstration]) -> str:
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


def _labels(relation: Relation, demonstrations: Sequence[Demonstration]) -> Iterator[Hint]:
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


def _variety(relation: Relation, holding: Sequence[Demonstration]) -> Iterator[Hint]:
    """Find what is the same in all demonstrations in which the relation holds."""
    count = len(holding)
    if all(len(one.arguments) == len(relation.arguments) for one in holding):
        heights = [_height(one) for one in holding]
        if np.ptp(heights) < SAME_HEIGHT:
            yield Hint(
                "variety",
                f"All {count} are at one height ({heights[0]:.2f} m): show it at another one",
            )
        if _one_angle([viewer_yaw(one.scene, one.arguments) for one in holding]):
            yield Hint(
                "variety", f"In all {count} the furniture is turned alike: show it turned elsewhere"
            )
        for number, argument in enumerate(relation.arguments):
            bodies = [one.scene.bodies.get(one.arguments[number]) for one in holding]
            if all(body is not None for body in bodies):
                shown = [body for body in bodies if body is not None]
                yield from _of_argument(argument.name, shown, holding)


def _of_argument(
    name: str, bodies: Sequence[Body], holding: Sequence[Demonstration]
) -> Iterator[Hint]:
    count = len(bodies)
    sizes = np.array([_size(body) for body in bodies])
    if np.ptp(sizes, axis=0).max() < SAME_SIZE:
        edges = " x ".join(f"{edge * 100:.0f}" for edge in sizes[0])
        yield Hint(
            "variety", f"In all {count} {name} has one size ({edges} cm): show it with another body"
        )
    if any(_is_round(body) for body in bodies):
        return
    yaws = [_yaw(body.pose) for body in bodies]
    seen = [
        yaw - viewer_yaw(one.scene, one.arguments) for yaw, one in zip(yaws, holding, strict=True)
    ]
    for angles, frame in ((yaws, "the world"), (seen, "the furniture")):
        if _one_angle(angles):
            text = f"In all {count} {name} is turned alike to {frame}: turn it (Q, E)"
            yield Hint("variety", f"{text}, unless you mean that")
            return


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
        and bool(np.abs(one[1] - other[1]).max(initial=0.0) < SAME_PLACE)
        and bool(np.abs(one[2] - other[2]).max(initial=0.0) < math.sin(SAME_TURN))
    )


def _height(one: Demonstration) -> float:
    """Return how high the lowest argument stands, metres."""
    lows: list[float] = []
    for name in one.arguments:
        body = one.scene.bodies.get(name)
        if body is not None and (body.movable or body.cavities):
            lows.append(float(bounds(body.parts, body.pose)[0][2]))
    return min(lows, default=0.0)


def _size(body: Body) -> list[float]:
    low, high = bounds(body.parts, Pose())
    return sorted((high - low).tolist())


def _is_round(body: Body) -> bool:
    """Check whether turning the body shows nothing: a cylinder that stands, a ball."""
    upright = abs(float(body.pose.rotation[2, 2])) > 0.99
    shapes = [part.shape for part in body.parts]
    return all(
        isinstance(shape, Sphere) or (isinstance(shape, Cylinder) and upright) for shape in shapes
    )


def _yaw(pose: Pose) -> float:
    """Return the yaw of the body's first axis that lies more than it stands, radians."""
    rotation = pose.rotation
    axis = int(np.argmax(np.abs(rotation[:2]).max(axis=0) > 0.7))
    return math.atan2(rotation[1, axis], rotation[0, axis])


def _one_angle(angles: Sequence[float]) -> bool:
    """Check whether all angles are within SAME_YAW of the first."""
    turns = np.array(angles) - angles[0]
    return bool(np.abs(np.angle(np.exp(1j * turns))).max() < SAME_YAW)


def _file(one: Demonstration) -> str:
    return one.source.partition(":")[0]
