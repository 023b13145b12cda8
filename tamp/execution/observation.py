"""Observation of what is on and inside what, by the bodies' geometry where they are seen; and the
scene as it is then.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from tamp.geometric.scene.pose import Array, Pose, pose_difference
from tamp.geometric.scene.scene import CONTACT_GAP, Scene
from tamp.simulation.engines import open_world
from tamp.simulation.world import FLOOR_NAME
from tamp.symbolic.pddl.structs import Fact
from tamp.verification.support_geometry import SupportContact, Supports

UNMOVED_DISTANCE_M = 0.0005
"""Metres, and 5 times as many radians, within which a body counts as where it was seen before."""

LIFT_TOLERANCE_M = 0.004
"""Metres by which a seen body is at most lifted or lowered, for the planner's air under
what rests.
"""

AWAY_POSE = Pose((500.0, 0.0, 0.0)).matrix
"""Where the body in the hand carries nobody."""


@dataclass(frozen=True)
class ObservedScene:
    """The scene as it is seen.

    Attributes:
        scene: Movable bodies where they are, with what they stand on; one in the hand keeps its old
            place.
        facts: ("on", body, surface or body) and ("inside", body, cavity), in PDDL's names.
        reasons: Why another such fact of a body and a place is not so.
    """

    scene: Scene
    facts: frozenset[Fact]
    reasons: Mapping[Fact, str]


class Observer:
    """Asks a second world without robot and without time; bodies that did not move are not asked
    again.

    Use it as a context manager.
    """

    def __init__(self, scene: Scene, engine: str | None = None) -> None:
        self._scene, self._engine = scene, engine
        self._world = open_world(scene, name=engine)
        self._supports = Supports(self._world)
        self._seen: dict[str, Array] = {}

    def __enter__(self) -> Observer:
        return self

    def __exit__(self, *_: object) -> None:
        self._world.close()

    def renew(self, scene: Scene) -> None:
        """Rebuild the observer when bodies were added or taken away."""
        if self._scene.bodies.keys() != scene.bodies.keys():
            self._world.close()
            self.__init__(scene, self._engine)

    def observe(self, poses: Mapping[str, Array], base: Array, held: str | None) -> ObservedScene:
        """Observe the truth about movable bodies at their T_world_body (4, 4), the base (3,) and
        the body in the hand.
        """
        placed = [name for name in self._scene.movable if name in poses and name != held]
        if held is not None:
            self._seen.pop(held, None)
            self._world.place(held, AWAY_POSE)
        self._place(poses, placed)
        bodies = dict(self._scene.bodies)
        facts: set[Fact] = set()
        reasons: dict[Fact, str] = {}
        for name in placed:
            stand = self._supports.stand(name)
            support = self._classify_support(name, stand, facts, reasons)
            pose = Pose.from_matrix(self._world.pose(name))
            bodies[name] = replace(bodies[name], pose=pose, support=support, carriers=())
        if held is not None:
            bodies[held] = replace(bodies[held], support=None, carriers=())
        x, y, yaw = (float(value) for value in base)
        robot = replace(self._scene.robot, base=(x, y, yaw))
        scene = replace(self._scene, bodies=MappingProxyType(bodies), robot=robot)
        return ObservedScene(scene, frozenset(facts), reasons)

    def _place(self, poses: Mapping[str, Array], placed: list[str]) -> None:
        """Put bodies where they are seen, the planner's air under those that rest: physics presses
        them together.
        """
        moved = []
        for name in placed:
            T = poses[name]
            before = self._seen.get(name)
            if (
                before is not None
                and max(pose_difference(before, T)[0], pose_difference(before, T)[1] / 5)
                < UNMOVED_DISTANCE_M
            ):
                continue
            self._seen[name] = T.copy()
            moved.append(name)
            self._world.place(name, _raised(T, CONTACT_GAP))
        for name in sorted(moved, key=lambda one: float(poses[one][2, 3])):
            stand = self._supports.stand(name)
            if stand.on:
                rise = float(np.clip(CONTACT_GAP - stand.gap, -LIFT_TOLERANCE_M, LIFT_TOLERANCE_M))
                self._world.place(name, _raised(self._world.pose(name), rise))

    def _classify_support(
        self, name: str, stand: SupportContact, facts: set[Fact], reasons: dict[Fact, str]
    ) -> str | None:
        """Add what is so about a body; what it stands on as the scene has it, None for the floor
        and for nothing.
        """
        support: str | None = None
        scene, supports = self._scene, self._supports
        asked = [("on", one.name, supports.on(name, one, stand)) for one in scene.surfaces.values()]
        asked += [
            ("inside", one.name, supports.inside(name, one, stand))
            for one in scene.cavities.values()
        ]
        for predicate, place, why in asked:
            fact = (predicate, name.lower(), place.lower())
            if why is None:
                facts.add(fact)
                support = support or place
            else:
                reasons[fact] = why
        below = sorted(stand.on - {FLOOR_NAME})
        facts |= {("on", name.lower(), body.lower()) for body in below}
        if support is None and stand.why is None:
            support = next((body for body in below if self._scene.bodies[body].movable), None)
        return support


def _raised(T: Array, height: float) -> Array:
    raised = T.copy()
    raised[2, 3] += height
    return raised
