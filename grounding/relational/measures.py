"""A body at many poses, measured in the frame of the region where it is wanted."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from grounding.form import Form
from grounding.separation import Obstacles, separations
from grounding.situation import Placed, Situation
from tamp.world.pose import Array

REACH = 0.4
"""Surroundings farther from the region than this are left out, metres."""


WALL = 0.002
"""Parts of the support that rise so far above the region's plane are in the way, metres."""


class View:
    """A situation in the region's frame, prepared once for many poses.

    Args:
        situation: What is to be looked at.
    """

    def __init__(self, situation: Situation) -> None:
        self.form, self.region = situation.body.form, situation.region
        self.T_world_region = situation.T_world_region
        self.T_region_world = np.linalg.inv(self.T_world_region)
        half, height = self.region.size[:2] / 2, min(float(self.region.size[2]), 1.0)
        room = np.array([[-half[0], -half[1], 0.0], [half[0], half[1], height]])
        placed = [Placed(other.form, self.T_region_world @ other.matrix) for other in situation.others]
        near = [other for other in placed if _distance(other.matrix[:3, 3], room) < REACH + other.form.radius]
        support = self.T_region_world @ situation.support.matrix
        walls = [Placed(piece, support) for piece in situation.support.form.pieces]
        walls = [wall for wall in walls if wall.box[1, 2] > WALL]
        self.obstacles = Obstacles([*near, *walls])

    @cached_property
    def rotations(self) -> Array:
        """What turns the body's faces down, shape (f, 3, 3)."""
        return np.stack([face.rotation for face in self.form.faces])

    @cached_property
    def steadiness(self) -> Array:
        """The tilt that each face withstands, radians, shape (f,)."""
        return np.array([face.angle for face in self.form.faces])

    def measure(self, poses: Array) -> Measures:
        """Poses T_region_body, shape (n, 4, 4), measured."""
        return Measures(self, poses)


@dataclass(frozen=True, eq=False)
class Measures:
    """What the poses have to do with the region; metres and radians, first axis n."""

    view: View
    poses: Array

    @cached_property
    def points(self) -> Array:
        """The hull's corners, shape (n, v, 3)."""
        form = self.view.form
        return form.vertices @ self.poses[:, :3, :3].transpose(0, 2, 1) + self.poses[:, None, :3, 3]

    @cached_property
    def low(self) -> Array:
        """The least coordinates, shape (n, 3)."""
        return self.points.min(axis=1)

    @cached_property
    def high(self) -> Array:
        """The largest coordinates, shape (n, 3)."""
        return self.points.max(axis=1)

    @cached_property
    def centre(self) -> Array:
        """The centre of mass, shape (n, 3)."""
        return self.poses[:, :3, :3] @ self.view.form.centre_of_mass + self.poses[:, :3, 3]

    @cached_property
    def face(self) -> NDArray[np.intp]:
        """The face that is nearest to being down, shape (n,)."""
        downs = -self.view.rotations[:, 2]
        return np.argmax(-self.poses[:, 2, :3] @ downs.T, axis=1)

    @cached_property
    def tilt(self) -> Array:
        """Where up points in the turned frame of that face, x and y: two sines, shape (n, 2)."""
        return np.einsum("nj,nkj->nk", self.poses[:, 2, :3], self.view.rotations[self.face])[:, :2]

    @cached_property
    def yaw(self) -> Array:
        """The turn about the vertical beside the tilt, shape (n,)."""
        turned = self.poses[:, :3, :3] @ self.view.rotations[self.face].transpose(0, 2, 1)
        turned = turned @ upright(self.tilt).transpose(0, 2, 1)
        return np.arctan2(turned[:, 1, 0], turned[:, 0, 0])

    @cached_property
    def sides(self) -> Array:
        """The least room left between the body and the rectangle's sides, negative when it sticks out; x, y: (n, 2)."""
        half = self.view.region.size[:2] / 2
        return half - np.maximum(np.abs(self.low[:, :2]), np.abs(self.high[:, :2]))

    @cached_property
    def balance(self) -> Array:
        """The same for the centre of mass, shape (n, 2)."""
        return self.view.region.size[:2] / 2 - np.abs(self.centre[:, :2])

    @cached_property
    def ceiling(self) -> Array:
        """Room above the body, at most a metre, shape (n,)."""
        return np.minimum(self.view.region.size[2] - self.high[:, 2], 1.0)

    @cached_property
    def apart(self) -> Array:
        """Separations from the m bodies around and the support's walls, shape (n, m)."""
        return separations(self.view.form, self.poses, self.view.obstacles)

    @cached_property
    def nearest(self) -> Array:
        """The least of them, at most REACH, shape (n,)."""
        return self.apart.min(axis=1, initial=REACH)


def _distance(point: Array, box: Array) -> float:
    """Of a point from a box, metres."""
    return float(np.linalg.norm(np.maximum(np.maximum(box[0] - point, point - box[1]), 0.0)))


def upright(tilt: Array) -> Array:
    """The smallest rotations that turn a tilted up to up: shape (n, 2) of sines to (n, 3, 3)."""
    a, b = tilt[:, 0], tilt[:, 1]
    c = np.sqrt(np.maximum(1.0 - a * a - b * b, 0.0))
    k = 1.0 / (1.0 + c)
    rows = [1 - a * a * k, -a * b * k, -a, -a * b * k, 1 - b * b * k, -b, a, b, c]
    return np.stack(rows, axis=1).reshape(-1, 3, 3)


def turns(yaw: Array) -> Array:
    """Rotations about z, shape (n,) to (n, 3, 3)."""
    c, s, o = np.cos(yaw), np.sin(yaw), np.zeros(len(yaw))
    return np.stack([c, -s, o, s, c, o, o, o, o + 1], axis=1).reshape(-1, 3, 3)


def face_descriptors(form: Form) -> Array:
    """What distinguishes the faces a body can rest on: steadiness, height and width against the others': (f, 4)."""
    faces = form.faces
    extent = np.array([face.extent for face in faces])
    width = np.array([np.ptp(face.outline, axis=0).min() for face in faces])
    angle = np.array([face.angle for face in faces])
    return np.stack(
        [angle, angle - angle.max(), np.log(extent / extent.min()), np.log(extent / np.maximum(width, 1e-3))], axis=1
    )
