"""Extents, volumes and surface points of convex shapes. The simulation's own: shared with nothing
that plans.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Hull, Part, Scene, Shape, Sphere

_LARGEST_SINGLE_M = 100.0
CIRCLE_POINTS = 48
"""Points on a circle where a round shape is described by points."""


def half_extents(shape: Shape) -> tuple[Array, Array]:
    """Return the bounding box of a shape in its own frame: centre (3,) and half edge lengths (3,),
    metres.
    """
    if isinstance(shape, Box):
        return np.zeros(3), np.array(shape.size) / 2
    if isinstance(shape, Cylinder):
        return np.zeros(3), np.array([shape.radius, shape.radius, shape.height / 2])
    if isinstance(shape, Sphere):
        return np.zeros(3), np.full(3, shape.radius)
    low, high = shape.vertices.min(axis=0), shape.vertices.max(axis=0)
    return (low + high) / 2, (high - low) / 2


def points(shape: Shape) -> Array:
    """Return points on the shape's surface that reach its extents, in its own frame, shape (n, 3),
    metres.

    The vertices of a box or hull; the two rims of a cylinder; rings of a sphere.
    """
    if isinstance(shape, Box):
        signs = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
        return signs * np.array(shape.size) / 2
    turn = np.linspace(0.0, 2 * np.pi, CIRCLE_POINTS, endpoint=False)
    circle = np.stack([np.cos(turn), np.sin(turn), np.zeros(CIRCLE_POINTS)], axis=1)
    if isinstance(shape, Cylinder):
        return np.concatenate(
            [circle * shape.radius + [0.0, 0.0, z * shape.height / 2] for z in (-1.0, 1.0)]
        )
    if isinstance(shape, Sphere):
        tilts = np.linspace(-np.pi / 2, np.pi / 2, 17)
        rings = [circle * np.cos(tilt) + [0.0, 0.0, np.sin(tilt)] for tilt in tilts]
        return np.concatenate(rings) * shape.radius
    return np.asarray(shape.vertices, dtype=float)


def body_points(parts: Iterable[Part]) -> Array:
    """Return `points` of all parts in the body's frame, shape (n, 3), metres."""
    return np.concatenate([part.pose.apply(points(part.shape)) for part in parts])


def centre_of_mass(parts: Iterable[Part]) -> Array:
    """Compute the centre of mass of a body of uniform density in its own frame, shape (3,), metres.
    Overlapping parts count twice.
    """
    total, moment = 0.0, np.zeros(3)
    for part in parts:
        volume, centre = _volume_and_centre(part.shape)
        total += volume
        moment += volume * part.pose.apply(centre[None])[0]
    return moment / total


def mass_centre(body: Body) -> Array:
    """Return a body's centre of mass in its own frame, shape (3,), metres: its file's, or that of a
    uniform density.
    """
    if body.center_of_mass is None:
        return centre_of_mass(body.parts)
    return np.array(body.center_of_mass, dtype=float)


def floor_under(scene: Scene) -> tuple[Array, Array]:
    """Return centre (3,) and half edge lengths (3,) of a floor that reaches 50 m beyond the room
    and all bodies.
    """
    room = scene.room
    spots = [(x, y) for x in room.x for y in room.y]
    spots += [body.pose.position[:2] for body in scene.bodies.values()]
    low, high = np.min(spots, axis=0), np.max(spots, axis=0)
    return np.array([*(low + high) / 2, -0.5]), np.array([*(high - low) / 2 + 50.0, 0.5])


def link_frame(state: Sequence[Any]) -> tuple[float, ...]:
    """Return position (m) and quaternion (xyzw) of a link's frame from pybullet's state of the
    link.

    pybullet tells the frame of a link in single precision, that of its centre of mass in double:
    far from the world's origin (0.06 mm at 1 km) the frame is taken from the latter.
    """
    if max(abs(state[4][0]), abs(state[4][1])) < _LARGEST_SINGLE_M:
        return (*state[4], *state[5])
    frame = Pose(state[0], state[1]) @ Pose(state[2], state[3]).inverse()
    return (*frame.position, *frame.quaternion)


def obj(shape: Shape) -> str:
    """Write a hull as the text of an OBJ file."""
    if not isinstance(shape, Hull):
        raise TypeError(f"not a hull: {shape}")
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in shape.vertices]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in shape.faces]
    return "\n".join(lines) + "\n"


def _volume_and_centre(shape: Shape) -> tuple[float, Array]:
    if isinstance(shape, Box):
        return float(np.prod(shape.size)), np.zeros(3)
    if isinstance(shape, Cylinder):
        return float(np.pi * shape.radius**2 * shape.height), np.zeros(3)
    if isinstance(shape, Sphere):
        return float(4 / 3 * np.pi * shape.radius**3), np.zeros(3)
    inside = shape.vertices.mean(axis=0)
    # (m, 3 corners, 3): a tetrahedron over each face
    corners = shape.vertices[shape.faces] - inside
    normals = np.cross(corners[:, 1], corners[:, 2])
    volumes = np.abs(np.einsum("ij,ij->i", corners[:, 0], normals)) / 6
    volume = float(volumes.sum())
    return volume, inside + (volumes[:, None] * corners.sum(axis=1) / 4).sum(axis=0) / volume


def inertia(parts: Iterable[Part], mass: float) -> Array:
    """Compute the inertia of a body of uniform density about its centre of mass, in its own frame,
    shape (3, 3), kg m2. Overlapping parts count twice.
    """
    total, moment, second = 0.0, np.zeros(3), np.zeros((3, 3))
    for part in parts:
        volume, centre = _volume_and_centre(part.shape)
        turn, at = part.pose.rotation, part.pose.apply(centre[None])[0]
        total += volume
        moment += volume * at
        second += turn @ _second_moment(part.shape) @ turn.T + volume * np.outer(at, at)
    second = second / total - np.outer(moment, moment) / total**2
    return mass * (np.trace(second) * np.eye(3) - second)


def _second_moment(shape: Shape) -> Array:
    """Integrate the outer products of places less the centre over a shape, (3, 3), m5."""
    volume, centre = _volume_and_centre(shape)
    if isinstance(shape, Box):
        return volume * np.diag(np.square(shape.size)) / 12
    if isinstance(shape, Cylinder):
        across = shape.radius**2 / 4
        return volume * np.diag([across, across, shape.height**2 / 12])
    if isinstance(shape, Sphere):
        return volume * np.eye(3) * shape.radius**2 / 5
    corners = shape.vertices[shape.faces] - shape.vertices.mean(axis=0)
    normals = np.cross(corners[:, 1], corners[:, 2])
    volumes = np.abs(np.einsum("ij,ij->i", corners[:, 0], normals)) / 6
    sums = corners.sum(axis=1)
    about = np.einsum("m,mci,mcj->ij", volumes, corners, corners)
    about += np.einsum("m,mi,mj->ij", volumes, sums, sums)
    away = centre - shape.vertices.mean(axis=0)
    return about / 20 - volume * np.outer(away, away)
