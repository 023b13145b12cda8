"""Bodies that a hand lets go: put down, dropped, turned; and what is wrong with where they are."""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Self

import numpy as np

from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import CONTACT_GAP, Body
from tamp.simulation.drop import Item
from tamp.simulation.engines import open_drops

SECONDS = 2.0
"""Simulated time of a drop."""

FINEST = 0.0005
"""Metres by which a body is lowered at least in a step."""

HIGHEST = 3.0
"""Metres that a body is raised at most to come out of others."""

FREE = 0.0002
"""Metres from other bodies at which a body counts as out of them."""

HANGS = 0.006
"""Metres of air under a body from which it counts as hanging; contacts of the judge's are nearer
than 10 mm, and a hand's demonstrations are to be better.
"""

OVERLAPS = 0.0015
"""Metres by which bodies may lie in each other."""

MOVES = 0.015
"""Metres that a body may creep when it is let go."""

TURNS = math.radians(10.0)
"""How far it may turn, radians."""

FARTHEST = 20.0
"""Metres that it is lowered at most."""

NEAR = 0.05
"""Metres around a body in which others are looked at first."""


@dataclass(frozen=True)
class Trouble:
    """Something that is wrong with where a body is: a kind ("overlaps", "hangs", "falls") and a
    sentence.
    """

    kind: str
    body: str
    text: str


class Workbench:
    """Puts bodies down and lets them go, one at a time among the others, which stand still. Use it
    as a context manager; threads take turns.
    """

    def __init__(self) -> None:
        self._drops = open_drops()
        self._items: dict[tuple[object, ...], Item] = {}
        self._lock = threading.Lock()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self._drops.__exit__(*error)

    def put_down(self, name: str, bodies: Mapping[str, Body]) -> Pose:
        """Move a body straight up until it is in no other, then straight down until it stands.

        Args:
            name: The body.
            bodies: All bodies where they are.

        Returns:
            T_world_body, CONTACT_GAP above what is below it.
        """
        with self._lock:
            self._set_up(name, bodies)
            return self._lowered(bodies[name])

    def drop(self, name: str, bodies: Mapping[str, Body]) -> Pose:
        """Let a body fall where it is, in physics; return T_world_body where it comes to rest."""
        with self._lock:
            self._set_up(name, bodies)
            start = self._raised(bodies[name].pose.matrix)
            rest = self._drops.drop(start, SECONDS)
            return self._lowered(bodies[name], rest)

    def troubles(self, bodies: Mapping[str, Body], names: tuple[str, ...]) -> Iterator[Trouble]:
        """Say what is wrong with where bodies are: one that lies in another, hangs in the air, or
        would fall.
        """
        for name in names:
            with self._lock:
                others = self._set_up(name, bodies)
                found = self._trouble(name, bodies, others)
            if found is not None:
                yield found

    def _trouble(self, name: str, bodies: Mapping[str, Body], others: list[str]) -> Trouble | None:
        matrix = bodies[name].pose.matrix
        contacts = self._drops.contacts(matrix, NEAR)
        deepest = min(contacts, key=lambda one: one.distance, default=None)
        if deepest is not None and deepest.distance < -OVERLAPS:
            other = "the floor" if deepest.obstacle < 0 else others[deepest.obstacle]
            depth = -deepest.distance * 1e3
            return Trouble("overlaps", name, f"{name} is {depth:.0f} mm inside {other}")

        below = matrix[2, 3] - self._descended(matrix)[2, 3]
        touching = any(one.distance < HANGS for one in contacts)
        if below > HANGS and not touching:
            below += CONTACT_GAP
            height = f"{below * 1e3:.0f} mm" if below < 0.1 else f"{below * 1e2:.0f} cm"
            return Trouble("hangs", name, f"{name} hangs {height} above what is below it")

        rest = self._drops.drop(self._raised(matrix), 1.0)
        cosine = (np.trace(matrix[:3, :3].T @ rest[:3, :3]) - 1) / 2
        turned = math.acos(float(np.clip(cosine, -1.0, 1.0)))
        slid = float(np.linalg.norm(rest[:3, 3] - matrix[:3, 3]))
        if turned > TURNS or slid > MOVES + max(below, 0.0):
            return Trouble("falls", name, f"{name} would not stay there: let go, it moves")
        return None

    def _set_up(self, name: str, bodies: Mapping[str, Body]) -> list[str]:
        others = [other for other in bodies if other != name]
        self._drops.set_up(
            self._item(bodies[name]),
            [(self._item(bodies[other]), bodies[other].pose.matrix) for other in others],
        )
        return others

    def _item(self, body: Body) -> Item:
        key = tuple(id(part) for part in body.parts)  # kept alive by the item
        if key not in self._items:
            self._items[key] = Item(body.parts, body.mass, body.friction)
        return self._items[key]

    def _lowered(self, body: Body, matrix: Array | None = None) -> Pose:
        low = self._descended(self._raised(body.pose.matrix if matrix is None else matrix))
        return Pose.from_matrix(low)

    def _clearance(self, matrix: Array, reach: float) -> float:
        """Return the distance to the nearest obstacle, or `reach` where all are farther, metres."""
        return min((one.distance for one in self._drops.contacts(matrix, reach)), default=reach)

    def _raised(self, matrix: Array) -> Array:
        """Move straight up until no other body is nearer than FREE."""
        start = _moved(matrix, 0.0)
        if self._clearance(start, CONTACT_GAP) >= FREE:
            return start
        step, low = 0.004, 0.0
        while low < HIGHEST and self._clearance(_moved(matrix, low + step), 0.002) < CONTACT_GAP:
            low += step
        high = low + step
        for _ in range(6):
            middle = (low + high) / 2
            if self._clearance(_moved(matrix, middle), 0.002) < FREE:
                low = middle
            else:
                high = middle
        return _moved(matrix, high + CONTACT_GAP - FREE)

    def _descended(self, matrix: Array) -> Array:
        """Move straight down until something is CONTACT_GAP below, at the latest the floor.

        A step is as long as the distance to the nearest body, and beside a wall FINEST: nothing is
        passed through, and no wall stops it.
        """
        down = 0.0
        while down < FARTHEST:
            distance = self._clearance(_moved(matrix, -down), 0.1)
            step = max(distance - FREE, FINEST)
            if step == FINEST and self._clearance(_moved(matrix, -down - step), 0.002) < FREE:
                break
            down += step

        free, blocked = down, down + FINEST
        for _ in range(5):
            middle = (free + blocked) / 2
            if self._clearance(_moved(matrix, -middle), 0.002) < FREE:
                blocked = middle
            else:
                free = middle

        return _moved(matrix, CONTACT_GAP - FREE - free)


def _moved(matrix: Array, up: float) -> Array:
    result = matrix.copy()
    result[2, 3] += up
    return result
