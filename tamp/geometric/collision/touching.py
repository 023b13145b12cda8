"""Bodies that touch each other at the start: moving them apart is no collision until they are clear
of each other.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from tamp.geometric.collision.fcl_bodies import FclBody, depth, gap
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Scene

if TYPE_CHECKING:
    from jaxtyping import Float

TOUCHING_GAP_M = 0.0005
"""Metres of air up to which two bodies count as touching."""

DEEPENING_M = 0.0002
"""Metres by which a body that moves away may get deeper into one that it touches: the arm's path is
not quite straight, and depths are not quite exact."""

SIDEWAYS_SHIFT_M = 0.02
"""How far a body that touches something is moved aside while it is lifted, metres,"""

SIDEWAYS_DIRECTIONS = 16
"""and in how many directions that is considered."""


class Touching:
    """The pairs that touch each other at the start of a scene.

    Args:
        scene: Its bodies at their first poses.
        absent: Bodies that are not there, but in the hand.
    """

    def __init__(self, scene: Scene, absent: Iterable[str] = ()) -> None:
        self._scene = scene
        self._there = [name for name in scene.bodies if name not in set(absent)]
        self._boxes = {name: bounds(body.parts, body.pose) for name, body in scene.bodies.items()}
        self._fcl: dict[str, FclBody] = {}
        self._touched: dict[str, Mapping[str, float]] = {}
        self._ways: dict[tuple[str, float], Array] = {}

    def touched(self, body: str, pose: Pose) -> Mapping[str, float]:
        """Return the bodies that a body at a pose touches, with how deep it is in each, metres;
        none but at its first pose.
        """
        if body not in self._there or pose != self._scene.bodies[body].pose:
            return {}
        if body not in self._touched:
            T = pose.matrix
            near = [other for other in self._there if other != body and self._close(body, other)]
            self._touched[body] = {
                other: self._depth(body, T, other)
                for other in near
                if self._gap(body, T, other) <= TOUCHING_GAP_M
            }
        return self._touched[body]

    def together(self, body: str, pose: Pose, other: str, other_pose: Pose) -> bool:
        """Check whether two bodies at these poses are a pair that touches at the start."""
        return other_pose == self._scene.bodies[other].pose and other in self.touched(body, pose)

    def way_out(self, body: str, pose: Pose, lift: float) -> Float[Array, " 3"]:
        """Return the lift-off direction of a body at a pose, (3,), metres: straight up, and away
        from what it touches beside it.
        """
        up = np.array([0.0, 0.0, lift])
        touched = self.touched(body, pose)
        if not touched:
            return up

        if (body, lift) not in self._ways:
            if all(
                self._gap(body, _moved(pose.matrix, up), other) > TOUCHING_GAP_M
                for other in touched
            ):
                return up

            turn = np.arange(SIDEWAYS_DIRECTIONS) * 2 * math.pi / SIDEWAYS_DIRECTIONS
            aside = SIDEWAYS_SHIFT_M * np.column_stack(
                [np.cos(turn), np.sin(turn), np.zeros(SIDEWAYS_DIRECTIONS)]
            )
            # Straight up is tried first: of equals the first one is taken.
            ways = [up, *(up + one for one in aside)]

            around = [
                other
                for other in self._there
                if other != body and self._close(body, other, lift + SIDEWAYS_SHIFT_M)
            ]
            room = [
                min(self._gap(body, _moved(pose.matrix, way), other) for other in around)
                for way in ways
            ]
            self._ways[body, lift] = ways[int(np.argmax(np.round(room, 4)))]

        return self._ways[body, lift]

    def separates(self, body: str, T_world_body: Iterable[Float[Array, "4 4"]], other: str) -> bool:
        """Check whether a body that is moved through poses (4, 4) leaves one that it touches, and
        stays away.
        """
        deepest = self.touched(body, self._scene.bodies[body].pose).get(other, 0.0) + DEEPENING_M
        clear = False
        for T in T_world_body:
            if self._gap(body, T, other) > TOUCHING_GAP_M:
                clear = True
            elif clear or self._depth(body, T, other) > deepest:
                return False
        return True

    def _close(self, body: str, other: str, reach: float = TOUCHING_GAP_M) -> bool:
        (low, high), (low_other, high_other) = self._boxes[body], self._boxes[other]
        return bool(np.all(low <= high_other + reach) and np.all(low_other <= high + reach))

    def _gap(self, body: str, T: Array, other: str) -> float:
        """Compute the distance of a body at T (4, 4) from another one, metres; 0 where they
        intersect.
        """
        return min(gap(a, b) for a, b in self._pairs(body, T, other))

    def _depth(self, body: str, T: Array, other: str) -> float:
        """Compute the penetration depth of a body at T (4, 4) in another one, metres."""
        return max(depth(a, b) for a, b in self._pairs(body, T, other))

    def _pairs(self, body: str, T: Array, other: str) -> Iterator[tuple[Any, Any]]:
        T_other = self._scene.bodies[other].pose.matrix
        first, second = self._shape(body), self._shape(other)
        for i in range(len(first.objects)):
            placed = first.place(i, T)
            yield from ((placed, second.place(k, T_other)) for k in range(len(second.objects)))

    def _shape(self, body: str) -> FclBody:
        if body not in self._fcl:
            self._fcl[body] = FclBody(self._scene.bodies[body].parts)
        return self._fcl[body]


def _moved(T: Array, offset: Array) -> Array:
    moved = T.copy()
    moved[:3, 3] += offset
    return moved
