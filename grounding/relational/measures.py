"""A body at many poses, measured in the frame of the region where it is wanted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from grounding.body_geometry import BodyGeometry
from grounding.relation_scene import Placed, Region, RelationScene
from grounding.separation import Obstacles, separations
from tamp.geometric.scene.pose import Array

SURROUNDINGS_M = 0.4
"""Surroundings farther from the region than this are left out, metres."""


WALL_RISE_M = 0.002
"""Parts of the support that rise so far above the region's plane are in the way, metres."""


class RegionFrame:
    """A situation in the region's frame, prepared once for many poses.

    Args:
        situation: What is to be looked at.
    """

    def __init__(self, situation: RelationScene) -> None:
        self.form, self.region = situation.body.form, situation.region
        self.T_world_region = situation.T_world_region
        self.T_region_world = inverse(self.T_world_region)
        self.faces = resting(self.form.unit)
        half, height = self.region.size[:2] / 2, min(float(self.region.size[2]), 1.0)
        self._room = np.array([[-half[0], -half[1], 0.0], [half[0], half[1], height]])
        self.obstacles = Obstacles(
            [*self._near(situation.others), *_walls(situation.support.form, situation.region)]
        )

    @cached_property
    def size(self) -> Array:
        """Return the logarithms of the body's extents, sorted, shape (3,)."""
        low, high = self.form.corners
        return np.sort(np.log(high - low))

    @property
    def rotations(self) -> Array:
        """Return the rotations that turn the body's faces down, shape (f, 3, 3)."""
        return self.faces.rotations

    @property
    def steadiness(self) -> Array:
        """Return the tilt that each face withstands, radians, shape (f,)."""
        return self.faces.steadiness

    def measure(self, poses: Array) -> Measures:
        """Measure poses T_region_body, shape (n, 4, 4)."""
        return Measures(self, poses)

    def _near(self, others: Sequence[Placed]) -> list[Placed]:
        if not others:
            return []
        matrices = self.T_region_world @ np.array([other.matrix for other in others])
        points = matrices[:, :3, 3]
        away = np.maximum(np.maximum(self._room[0] - points, points - self._room[1]), 0.0)
        reach = SURROUNDINGS_M + np.array([other.form.radius for other in others])
        near = (away * away).sum(axis=1) < reach * reach
        return [
            Placed(other.form, matrix)
            for other, matrix, is_near in zip(others, matrices, near, strict=True)
            if is_near
        ]


@lru_cache(maxsize=256)
def _walls(support: BodyGeometry, region: Region) -> tuple[Placed, ...]:
    """Return the support's parts that rise above the region's plane, in the region's frame."""
    matrix = inverse(region.matrix)
    boxes = support.piece_boxes
    tops = (
        boxes.mean(axis=1) @ matrix[2, :3]
        + np.ptp(boxes, axis=1) @ np.abs(matrix[2, :3]) / 2
        + matrix[2, 3]
    )
    return tuple(
        Placed(support.pieces[index], matrix) for index in np.flatnonzero(tops > WALL_RISE_M)
    )


@dataclass(frozen=True, eq=False)
class Measures:
    """The measures of poses in a region's frame; metres and radians, first axis n."""

    view: RegionFrame
    poses: Array

    def moved(self, positions: Array) -> Measures:
        """Move the body's origin to `positions`, shape (n, 3), the same rotations; what is known is
        not worked out again.
        """
        poses = self.poses.copy()
        poses[:, :3, 3] = positions
        moved = Measures(self.view, poses)
        moved.__dict__["turned"] = self.turned
        moved.__dict__["face"] = self.face
        return moved

    @cached_property
    def turned(self) -> tuple[Array, Array, Array]:
        """Rotate the body about its origin: least and largest coordinates and centre of mass, each
        (n, 3).
        """
        rotations, form = self.poses[:, :3, :3], self.view.form
        points = (form.vertices @ rotations.reshape(-1, 3).T).reshape(
            -1, len(rotations), 3
        )  # (v, n, 3)
        return points.min(axis=0), points.max(axis=0), rotations @ form.centre_of_mass

    @cached_property
    def low(self) -> Array:
        """Return the least coordinates, shape (n, 3)."""
        return self.turned[0] + self.poses[:, :3, 3]

    @cached_property
    def high(self) -> Array:
        """Return the largest coordinates, shape (n, 3)."""
        return self.turned[1] + self.poses[:, :3, 3]

    @cached_property
    def centre(self) -> Array:
        """Return the centre of mass, shape (n, 3)."""
        return self.turned[2] + self.poses[:, :3, 3]

    @cached_property
    def face(self) -> NDArray[np.intp]:
        """Return the face that is nearest to being down, shape (n,)."""
        downs = -self.view.rotations[:, 2]
        return np.argmax(-self.poses[:, 2, :3] @ downs.T, axis=1)

    @cached_property
    def tilt(self) -> Array:
        """Return the tilt: where up points in the turned frame of that face, x and y: two sines,
        shape (n, 2).
        """
        return np.einsum("nj,nkj->nk", self.poses[:, 2, :3], self.view.rotations[self.face])[:, :2]

    @cached_property
    def yaw(self) -> Array:
        """Return the yaw, the turn about the vertical beside the tilt, shape (n,)."""
        turned = self.poses[:, :3, :3] @ self.view.rotations[self.face].transpose(0, 2, 1)
        turned = turned @ upright(self.tilt).transpose(0, 2, 1)
        return np.arctan2(turned[:, 1, 0], turned[:, 0, 0])

    @cached_property
    def sides(self) -> Array:
        """Return the least room left between the body and the rectangle's sides, negative when it
        sticks out; x, y: (n, 2).
        """
        half = self.view.region.size[:2] / 2
        return half - np.maximum(np.abs(self.low[:, :2]), np.abs(self.high[:, :2]))

    @cached_property
    def balance(self) -> Array:
        """Return the least room between the centre of mass and the rectangle's sides, shape (n,
        2).
        """
        return self.view.region.size[:2] / 2 - np.abs(self.centre[:, :2])

    @cached_property
    def ceiling(self) -> Array:
        """Return the room above the body, at most a metre, shape (n,)."""
        return np.minimum(self.view.region.size[2] - self.high[:, 2], 1.0)

    @cached_property
    def apart(self) -> Array:
        """Return separations from the m bodies around and the support's walls, shape (n, m)."""
        return separations(self.view.form, self.poses, self.view.obstacles)

    @cached_property
    def nearest(self) -> Array:
        """Return the least separation, at most REACH, shape (n,)."""
        return self.apart.min(axis=1, initial=SURROUNDINGS_M)


def upright(tilt: Array) -> Array:
    """Compute the smallest rotations that turn a tilted up to up: shape (n, 2) of sines to (n, 3,
    3).
    """
    a, b = tilt[:, 0], tilt[:, 1]
    c = np.sqrt(np.maximum(1.0 - a * a - b * b, 0.0))
    k = 1.0 / (1.0 + c)
    result = np.empty((len(tilt), 3, 3))
    result[:, 0, 0], result[:, 0, 1], result[:, 0, 2] = 1 - a * a * k, -a * b * k, -a
    result[:, 1, 0], result[:, 1, 1], result[:, 1, 2] = result[:, 0, 1], 1 - b * b * k, -b
    result[:, 2, 0], result[:, 2, 1], result[:, 2, 2] = a, b, c
    return result


def turns(cosine: Array, sine: Array) -> Array:
    """Compute rotations about z, shape (n,) to (n, 3, 3)."""
    result = np.zeros((len(cosine), 3, 3))
    result[:, 0, 0] = result[:, 1, 1] = cosine
    result[:, 0, 1], result[:, 1, 0] = -sine, sine
    result[:, 2, 2] = 1.0
    return result


@dataclass(frozen=True, eq=False)
class Resting:
    """The faces that a form can rest on, whatever its size.

    Attributes:
        rotations: What turns each down, shape (f, 3, 3).
        steadiness: The tilt that each withstands, radians, shape (f,).
        descriptors: What distinguishes them: steadiness, height and width against the others',
            shape (f, 4).
    """

    rotations: Array
    steadiness: Array
    descriptors: Array

    def __len__(self) -> int:
        return len(self.steadiness)


@lru_cache(maxsize=1024)
def resting(form: BodyGeometry) -> Resting:
    """Return the stable faces of a form of scale 1."""
    if not form.faces:
        return Resting(np.zeros((0, 3, 3)), np.zeros(0), np.zeros((0, 4)))
    extent = np.array([face.extent for face in form.faces])
    width = np.array([np.ptp(face.outline, axis=0).min() for face in form.faces])
    angle = np.array([face.angle for face in form.faces])
    return Resting(
        np.stack([face.rotation for face in form.faces]),
        angle,
        np.stack(
            [
                angle,
                angle - angle.max(),
                np.log(extent / extent.min()),
                np.log(extent / np.maximum(width, 1e-3)),
            ],
            axis=1,
        ),
    )


def inverse(matrix: Array) -> Array:
    """Invert a rigid transform, shape (4, 4)."""
    result = np.eye(4)
    result[:3, :3] = matrix[:3, :3].T
    result[:3, 3] = -matrix[:3, :3].T @ matrix[:3, 3]
    return result
