"""Free places in a world as it is at a moment of its physics."""

from __future__ import annotations

from dataclasses import replace
from types import MappingProxyType

import numpy as np

from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import CONTACT_GAP, Body
from tamp.simulation.actuation import MotorSimulation
from tamp.simulation.engines import open_world
from tamp.simulation.shapes import body_points
from tamp.verification.support_geometry import Supports

CLEARANCE_M = 0.005
"""Metres of air to other bodies that a free place has."""


class FreeSpace:
    """A copy of the world without time and robot, in which places are tried. Use it as a context
    manager.
    """

    def __init__(self, world: MotorSimulation, engine: str | None = None) -> None:
        self._scene, self._engine = world.scene, engine
        self._copy = open_world(world.scene, name=engine)
        touched = {second for first, second in world.touches() if first in world.robot_links}
        for name in world.scene.movable:
            self._copy.place(name, _lifted(world.pose(name)))
        self.untouched = [
            name for name in world.scene.movable if name not in touched and name != world.bound
        ]
        self._supports = Supports(self._copy)

    def __enter__(self) -> FreeSpace:
        return self

    def __exit__(self, *_: object) -> None:
        self._copy.close()

    def fits(self, name: str, T_world_body: Array) -> bool:
        """Check whether a body stands there on the same as before, apart from all others."""
        before = self._copy.pose(name)
        on = self._supports.stand(name).on
        self._copy.place(name, _lifted(T_world_body))
        stand = self._supports.stand(name)
        fine = bool(on) and stand.why is None and stand.on == on and self._apart(name, on)
        self._copy.place(name, before)
        return fine

    def free(self, body: Body) -> bool:
        """Check whether a new body would be apart from all others, but for what is under it."""
        lifted = replace(body, pose=replace(body.pose, position=_up(body.pose.position)))
        scene = replace(
            self._scene, bodies=MappingProxyType({**self._scene.bodies, body.name: lifted})
        )
        with open_world(scene, name=self._engine) as world:
            for name in self._scene.movable:
                world.place(name, self._copy.pose(name))
            stand = Supports(world).stand(body.name)
            others = [name for name in self._scene.bodies if name not in stand.on]
            clear = all(
                world.body_distance(body.name, name, CLEARANCE_M) >= CLEARANCE_M for name in others
            )
            under = (one for one in stand.on if one in world.solids)
            return (
                stand.why is None
                and clear
                and all(world.body_distance(body.name, one) > 0 for one in under)
            )

    def lowest(self, word: str, T_world_body: Array) -> float | None:
        """Compute the height of the lowest point of the body of a PDDL name at a pose, less the
        planner's air; metres.
        """
        name = next((one for one in self._scene.bodies if one.lower() == word), None)
        if name is None:
            return None
        points = (
            body_points(self._scene.bodies[name].parts) @ T_world_body[:3, :3].T
            + T_world_body[:3, 3]
        )
        return float(np.min(points[:, 2])) - CONTACT_GAP

    def _apart(self, name: str, on: frozenset[str]) -> bool:
        return all(
            self._copy.body_distance(name, other, CLEARANCE_M)
            >= (0.0 if other in on else CLEARANCE_M)
            for other in self._scene.bodies
            if other != name
        )


def _lifted(T: Array) -> Array:
    lifted = T.copy()
    lifted[2, 3] += CONTACT_GAP
    return lifted


def _up(position: tuple[float, float, float]) -> tuple[float, float, float]:
    return position[0], position[1], position[2] + CONTACT_GAP
