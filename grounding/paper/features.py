"""The paper's features of a body (section III-B): its bounding boxes, or the code of its point
cloud.

A situation is seen with argument 0 at the origin (`first_arg`): its position is subtracted from
every body's, nothing is turned or scaled. Positions are centres of object-aligned boxes, or
centroids of clouds; metres.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Protocol
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from grounding.paper.clouds import cloud
from grounding.paper.kernels import describe_boxes, move
from grounding.paper.rotations import quaternions, rotations
from grounding.relation_scene import Placed, RelationScene
from tamp.geometric.scene.pose import Array

BB = 19
"""Numbers a body: centre 3, corners of the box along the world's axes 6, quaternion xyzw 4, own
box's corners 6.
"""

PC = 135
"""Numbers a body: centroid 3, quaternion xyzw 4, code of its cloud 128."""

CODE = 128
"""Numbers of a cloud's code."""

UNTURNED = np.array([0.0, 0.0, 0.0, 1.0])
"""The identity's quaternion xyzw."""

Encoder = Callable[[Array], NDArray[Any]]
"""From the posed, centred cloud, shape (points, 3) in metres, to its code, shape (CODE,)."""


@dataclass(frozen=True, eq=False)
class FeatureObservation:
    """A situation as the networks see it.

    Attributes:
        arguments: Features of argument 0 and 1, shape (2, f).
        others: Features of the surroundings, shape (k, f).
        origin: The position of argument 0 in the world, which has been subtracted, shape (3,).
        centre: The position of argument 1 in its own frame, shape (3,).
        extents: Half the edges of argument 1's own box, shape (3,).
        start: The rotation from which a generator's quaternion turns argument 1, shape (3, 3): its
            own where turns are residual, none where they are absolute.
    """

    arguments: Array
    others: Array
    origin: Array
    centre: Array
    extents: Array
    start: Array = field(default_factory=lambda: np.eye(3))


class Features(Protocol):
    """One of the two kinds."""

    size: int

    def observe(self, situation: RelationScene, surroundings: bool = True) -> FeatureObservation:
        """Compute the features of a situation as it is; without its surroundings for a network that
        does not see them.
        """
        ...

    def at(self, seen: FeatureObservation, situation: RelationScene, poses: Array) -> Array:
        """Compute the features that argument 1 would have at T_world_body, shape (n, 4, 4); returns
        (n, f).
        """
        ...


class BoxFeatures:
    """BB. The box along the world's axes is that of the posed object-aligned box, in data as in
    completed proposals.

    Args:
        residual: Whether argument 1 is shown as its box along the world's axes, turned by nothing,
            and a generator turns it from where it was. The paper's boxes are turned absolutely.
    """

    size = BB

    def __init__(self, residual: bool = False) -> None:
        self.residual = residual

    def observe(self, situation: RelationScene, surroundings: bool = True) -> FeatureObservation:
        """See Features."""
        support, body = situation.support, situation.body
        others = situation.others if surroundings else ()
        corners = np.array(
            [situation.region.box, body.form.corners, *(other.form.corners for other in others)]
        )
        matrices = np.array([support.matrix, body.matrix, *(other.matrix for other in others)])
        centres = _moved(matrices, (corners[:, 0] + corners[:, 1]) / 2)
        features = box_features(centres - centres[0], quaternions(matrices[:, :3, :3]), corners)
        low, high = body.form.corners
        middle, half = (low + high) / 2, (high - low) / 2
        start = np.eye(3)
        if self.residual:
            start = body.matrix[:3, :3]
            features[1] = unturned(features[1:2, :3], start[None], half)[0]
        return FeatureObservation(features[:2], features[2:], centres[0], middle, half, start)

    def at(self, seen: FeatureObservation, situation: RelationScene, poses: Array) -> Array:
        """See Features."""
        centres = _moved(poses, seen.centre) - seen.origin
        if self.residual:
            return unturned(centres, poses[:, :3, :3], seen.extents)
        corners = np.broadcast_to(situation.body.form.corners, (len(poses), 2, 3))
        return box_features(centres, quaternions(poses[:, :3, :3]), corners)


class CloudFeatures:
    """PC.

    Args:
        encoder: What makes codes of clouds.
        residual: As in the published data: every quaternion is the identity, since what a body is
            turned like is in its code, a position is the middle of the posed cloud's extent, and a
            generator turns argument 1 from where it was. Else quaternions are true, positions
            centroids, turns absolute.
        about_middle: Whether a code is of the cloud about the middle of its extent, which is where
            its position is, and not about its centroid as published.
    """

    size = PC

    def __init__(self, encoder: Encoder, residual: bool = True, about_middle: bool = False) -> None:
        self._encode, self._residual, self._about_middle = encoder, residual, about_middle
        self._clouds: WeakKeyDictionary[Placed, Array] = WeakKeyDictionary()

    def observe(self, situation: RelationScene, surroundings: bool = True) -> FeatureObservation:
        """See Features."""
        placed = (situation.support, situation.body, *(situation.others if surroundings else ()))
        features = np.stack([self._features(item) for item in placed])
        origin = features[0, :3].copy()
        features[:, :3] -= origin
        low, high = situation.body.form.corners
        matrix, start = situation.body.matrix, np.eye(3)
        centre = cloud(situation.body.form).mean(axis=0)
        if self._residual:
            start = matrix[:3, :3]
            centre = start.T @ (features[1, :3] + origin - matrix[:3, 3])
        return FeatureObservation(
            features[:2], features[2:], origin, centre, (high - low) / 2, start
        )

    def at(self, seen: FeatureObservation, situation: RelationScene, poses: Array) -> Array:
        """See Features. Each pose's cloud is encoded, unless argument 1 is turned as it was."""
        features = np.empty((len(poses), PC))
        for row, pose in zip(features, poses, strict=True):
            same = np.array_equal(pose[:3, :3], situation.body.matrix[:3, :3])
            row[:] = self._described(
                Placed(situation.body.form, pose), seen.arguments[1, 7:] if same else None
            )
        features[:, :3] -= seen.origin
        return features

    def _features(self, item: Placed) -> Array:
        """Compute a body's features, once while it stays where it is."""
        if item not in self._clouds:
            self._clouds[item] = self._described(item)
        return self._clouds[item]

    def _described(self, item: Placed, code: Array | None = None) -> Array:
        rotation, position = item.matrix[:3, :3], item.matrix[:3, 3]
        points = cloud(item.form) @ rotation.T
        centroid, middle = points.mean(axis=0), (points.min(axis=0) + points.max(axis=0)) / 2
        if code is None:
            code = self._encode(points - (middle if self._about_middle else centroid))
        if self._residual:
            return np.concatenate([middle + position, UNTURNED, code])
        return np.concatenate([centroid + position, quaternions(rotation[None])[0], code])


def box_features(centres: Array, turns: Array, corners: Array) -> Array:
    """Compute the bounding box features BB, shape (n, 19), of positions (n, 3), quaternions (n, 4)
    and own boxes, low and high corner (n, 2, 3).
    """
    features = np.empty((len(centres), BB), centres.dtype)
    describe_boxes(centres, turns, rotations(turns), corners, features)
    return features


def completed(seen: FeatureObservation, positions: Array, turns: Array) -> Array:
    """Complete argument 1's features when a generator put it at positions (n, 3) and unit
    quaternions (n, 4); shape (n, f).

    Its own box or its code stay as they were seen: a code is not computed again, although its cloud
    has turned.
    """
    argument = seen.arguments[1]
    if len(argument) == BB:
        return box_features(
            positions, turns, np.broadcast_to(argument[13:].reshape(2, 3), (len(positions), 2, 3))
        )
    code = np.broadcast_to(argument[7:], (len(positions), CODE))
    return np.concatenate([positions, turns, code], axis=1, dtype=positions.dtype)


def poses_of(seen: FeatureObservation, positions: Array, turns: Array) -> Array:
    """Compute T_world_body, shape (n, 4, 4), of argument 1 at positions (n, 3), as features have
    them, turned by (n, 4) from its start.
    """
    poses = np.zeros((len(positions), 4, 4))
    poses[:, 3, 3] = 1.0
    poses[:, :3, :3] = rotations(turns) @ seen.start
    poses[:, :3, 3] = seen.origin + positions - poses[:, :3, :3] @ seen.centre
    return poses


def unturned(centres: Array, turned: Array, half: Array) -> Array:
    """Compute BB, shape (n, 19), of boxes of half edges (3,) turned by (n, 3, 3), each shown as its
    box along the world's axes with the identity's quaternion.
    """
    reach = np.abs(turned) @ half
    corners = np.stack([-reach, reach], axis=1)
    return box_features(centres, np.tile(UNTURNED, (len(centres), 1)), corners)


def _moved(matrices: Array, points: Array) -> Array:
    """Transform one point of each frame to the outer frame; shape (n, 3)."""
    moved = np.empty((len(matrices), 3))
    move(matrices, points.reshape(-1, 3), moved)
    return moved
