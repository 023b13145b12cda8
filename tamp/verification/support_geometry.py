"""Support contacts of bodies: their undersides and what is below, found by ray casts in the physics
engine.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from tamp.geometric.robot.states import rest_row
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Cavity, Surface
from tamp.simulation.shapes import body_points, mass_centre
from tamp.simulation.world import World

SUPPORT_GAP_M = 0.010
"""Metres of air below a body that still count as resting: it will drop onto what is there."""
SUPPORT_PENETRATION_M = 0.001
"""Metres by which a body may stand in what it rests on."""
SUPPORT_GAP_SPREAD_M = 0.0015
"""Metres by which the gaps of points that carry may differ."""
CENTRE_TOLERANCE_M = 0.002
"""Metres by which the centre of mass may be out of the felt points that carry (they are a grid)."""
GRID_LINES = 30
EMPTY_PLACE_X_M = 300.0
"""Metres along x to where nothing is."""


@dataclass(frozen=True, eq=False)
class SupportContact:
    """The stand of a body on what carries it.

    Attributes:
        on: Names of the bodies that carry it, "floor" included; empty when nothing is within
            SUPPORT_GAP_M below it.
        gap: Metres of air above the nearest, infinite when there is nothing.
        lean: Metres by which the centre of mass is out of what carries it; negative inside.
        carrying: Points of the world's plan at which it is carried, (n, 2), metres.
    """

    on: frozenset[str]
    gap: float
    lean: float
    carrying: Array = field(default_factory=lambda: np.zeros((0, 2)))

    @property
    def stable(self) -> bool:
        """Tell whether it stays where it is."""
        return self.why is None

    @property
    def why(self) -> str | None:
        """Say why it does not; None when it does."""
        if not self.on:
            return f"nothing is within {1000 * SUPPORT_GAP_M:.0f} mm below it"
        if self.lean > CENTRE_TOLERANCE_M:
            return f"its centre of mass is {1000 * self.lean:.1f} mm beyond what carries it"
        return None


class Supports:
    """Asks a world of bodies how each stands. Bodies `absent` (in hands) carry nobody."""

    def __init__(self, world: World) -> None:
        self._world = world
        bodies = world.scene.bodies
        self._points = {name: body_points(body.parts) for name, body in bodies.items()}
        self._centres = {name: mass_centre(body) for name, body in bodies.items()}
        self._sizes = {
            name: float(np.linalg.norm(points, axis=1).max())
            for name, points in self._points.items()
        }
        self._stands: dict[tuple[tuple[str, bytes], ...], SupportContact] = {}
        self._undersides: dict[tuple[str, bytes], Array] = {}

    def stand(self, body: str, absent: frozenset[str] = frozenset()) -> SupportContact:
        """Find how a body stands where it is; the robot does not count."""
        key = self._surroundings(body, absent)
        if key not in self._stands:
            self._stands[key] = self._observe(body, absent)
        return self._stands[key]

    def _surroundings(self, body: str, absent: frozenset[str]) -> tuple[tuple[str, bytes], ...]:
        """Make a key of what a body's stand depends on: its pose and those of bodies around."""
        names = [name for name in self._points if name not in absent or name == body]
        poses = {name: self._world.pose(name) for name in names}
        centres = np.array([poses[name][:3, 3] for name in names])
        sizes = (
            np.array([self._sizes[name] for name in names]) + self._sizes[body] + 2 * SUPPORT_GAP_M
        )
        within = np.linalg.norm(centres - poses[body][:3, 3], axis=1) <= sizes
        near = [name for name, is_near in zip(names, within.tolist(), strict=True) if is_near]
        return tuple((name, poses[name].tobytes()) for name in (body, *near))

    def _observe(self, body: str, absent: frozenset[str]) -> SupportContact:
        T_world_body = self._world.pose(body)
        robot = self._world.robot
        if robot is not None:
            self._world.set_state(rest_row(robot, (EMPTY_PLACE_X_M, EMPTY_PLACE_X_M, 0.0)))
        elsewhere = {name: self._world.pose(name) for name in sorted(absent)}
        for name in elsewhere:
            self._world.place(name, _shifted(np.eye(4), 2 * EMPTY_PLACE_X_M))

        underside = self._underside(body, T_world_body[:3, :3]) + T_world_body[:3, 3]
        try:
            up, down = (
                np.array([0.0, 0.0, 2 * SUPPORT_PENETRATION_M + SUPPORT_GAP_SPREAD_M]),
                np.array([0.0, 0.0, SUPPORT_GAP_M + SUPPORT_GAP_SPREAD_M]),
            )
            hits = self._world.rays(underside + up, underside - down)
        finally:
            self._world.place(body, T_world_body)
            for name, T_world_absent in elsewhere.items():
                self._world.place(name, T_world_absent)

        length = 2 * SUPPORT_PENETRATION_M + 2 * SUPPORT_GAP_SPREAD_M + SUPPORT_GAP_M
        gaps = np.array(
            [
                fraction * length - 2 * SUPPORT_PENETRATION_M - SUPPORT_GAP_SPREAD_M
                if name
                else np.inf
                for name, fraction in hits
            ]
        )
        # What is met higher up is beside the body and not below it: a ray down its flank begins in
        # a neighbour.
        gaps[gaps < -SUPPORT_PENETRATION_M - SUPPORT_GAP_SPREAD_M] = np.inf

        least = float(gaps.min())
        if least > SUPPORT_GAP_M:
            return SupportContact(frozenset(), np.inf, np.inf)

        carrying = gaps <= least + SUPPORT_GAP_SPREAD_M
        on = frozenset(
            name for (name, _), carries in zip(hits, carrying, strict=True) if carries and name
        )
        centre = (T_world_body[:3, :3] @ self._centres[body] + T_world_body[:3, 3])[:2]
        points = underside[carrying][:, :2]
        return SupportContact(on, least, outside(centre, points), points)

    def why_overloaded(self, body: str, stands: Mapping[str, SupportContact]) -> str | None:
        """Say how a body that stands tips under what stands on it, and on that; None when it does
        not. What rests on several bodies is no one's load. `stands` are those of all movable
        bodies but one in the hand.
        """
        load, waiting = {body}, [body]
        while waiting:
            under = waiting.pop()
            for other, stand in stands.items():
                if other not in load and stand.on == {under}:
                    load.add(other)
                    waiting.append(other)
        if len(load) == 1:
            return None

        masses = np.array([self._world.scene.bodies[name].mass for name in load])
        centres = np.array(
            [(self._world.pose(name) @ np.append(self._centres[name], 1.0))[:2] for name in load]
        )
        centre = masses @ centres / max(float(masses.sum()), 1e-9)
        beyond = outside(centre, stands[body].carrying)
        if beyond <= CENTRE_TOLERANCE_M:
            return None
        others = " and ".join(sorted(load - {body}))
        return f"under {others} it tips: their centre of mass is {1000 * beyond:.1f} mm beyond"

    def on(self, body: str, surface: Surface, stand: SupportContact) -> str | None:
        """Say why a body that stands so does not stand on a surface; None when it does."""
        T_surface_world = np.linalg.inv(self._world.pose(surface.body) @ surface.pose.matrix)
        T_surface_body = T_surface_world @ self._world.pose(body)
        points = self._points[body] @ T_surface_body[:3, :3].T + T_surface_body[:3, 3]
        gap = float(points[:, 2].min())
        if not -SUPPORT_PENETRATION_M - 1e-5 <= gap <= SUPPORT_GAP_M + 1e-5:
            return f"its lowest point is {1000 * gap:.1f} mm above the surface"
        centre = T_surface_body[:3, :3] @ self._centres[body] + T_surface_body[:3, 3]
        beyond = float((np.abs(centre[:2]) - np.array(surface.size) / 2).max())
        if beyond > 1e-4:
            return f"its centre of mass is {1000 * beyond:.1f} mm beyond the surface's edge"
        if surface.body not in stand.on:
            return "it rests on " + (", ".join(sorted(stand.on)) or "nothing")
        return stand.why

    def inside(self, body: str, cavity: Cavity, stand: SupportContact) -> str | None:
        """Say why a body that stands so is not inside a cavity; None when it is."""
        T_cavity_world = np.linalg.inv(self._world.pose(cavity.body) @ cavity.pose.matrix)
        T_cavity_body = T_cavity_world @ self._world.pose(body)
        points = self._points[body] @ T_cavity_body[:3, :3].T + T_cavity_body[:3, 3]
        half_x, half_y, height = cavity.size[0] / 2, cavity.size[1] / 2, cavity.size[2]
        low, high = np.array([-half_x, -half_y, 0.0]), np.array([half_x, half_y, height])
        sticks_out = float(np.maximum(low - points.min(axis=0), points.max(axis=0) - high).max())
        if sticks_out > SUPPORT_PENETRATION_M:
            return f"it protrudes by {1000 * sticks_out:.1f} mm"
        return stand.why

    def _underside(self, body: str, rotation: Array) -> Array:
        """Sample the surface seen from below, relative to the frame's origin, in world directions.

        Leaves the body elsewhere: the caller puts it back.
        """
        world = self._world
        away = np.eye(4)
        away[:3, :3] = rotation
        away = _shifted(away, EMPTY_PLACE_X_M)
        world.place(body, away)

        key = (body, rotation.round(9).tobytes())
        if key not in self._undersides:
            points = self._points[body] @ rotation.T
            low, high = points.min(axis=0), points.max(axis=0)
            steps = [np.linspace(low[axis], high[axis], GRID_LINES + 2)[1:-1] for axis in (0, 1)]
            grid = np.stack(np.meshgrid(*steps), axis=-1).reshape(-1, 2)
            middle = (low + high)[:2] / 2
            shrunk = middle + (points[:, :2] - middle) * 0.995  # rays along an edge may miss it
            plan = np.unique(np.concatenate([grid, shrunk]).round(6), axis=0)
            starts = np.column_stack([plan, np.full(len(plan), low[2] - 0.01)]) + away[:3, 3]
            ends = np.column_stack([plan, np.full(len(plan), high[2] + 0.01)]) + away[:3, 3]
            hits = world.rays(starts, ends)
            fractions = np.array([fraction for _, fraction in hits])
            seen = np.array([name == body for name, _ in hits])
            underside = starts + fractions[:, None] * (ends - starts) - away[:3, 3]
            self._undersides[key] = underside[seen]
        return self._undersides[key]


def outside(point: Array, points: Array) -> float:
    """Measure by how far a point (2,) is outside the convex hull of points (n, 2), m; inside <= 0.

    The largest distance by which a line through the hull's edge separates them, over the directions
    of all degrees.
    """
    turn = np.linspace(0.0, 2 * np.pi, 360, endpoint=False)
    directions = np.stack([np.cos(turn), np.sin(turn)])
    return float((point @ directions - (points @ directions).max(axis=0)).max())


def _shifted(T: Array, x: float) -> Array:
    shifted = T.copy()
    shifted[:3, 3] = [x, 0.0, 0.0]
    return shifted
