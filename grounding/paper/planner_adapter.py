"""The paper's networks as the planner calls them: each moves a body from nearby to a pose that is
then laid.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.random import Generator as Random

from grounding.body_geometry import BodyGeometry
from grounding.random_poses import afloat
from grounding.relation_scene import relation_scene_of
from grounding.runtime import Grounding, laid
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Scene
from tamp.geometric.stability.placement import Placement
from tamp.geometric.stability.stable_poses import Face

TOGETHER = 4
"""Proposals from one start: a network takes as long for these as for one."""


class SnappingSampler(Grounding):
    """A network that moves a body from where it is, and was taught with bodies around their
    support.

    The body that the planner asks about is in the hand or elsewhere in the room, farther away than
    in any scene of the training data; from there the networks miss the support by decimetres, each
    time at the same place. So it is shown afloat around the support, each time elsewhere. And since
    the oracle by which the networks were taught (MCA) asks nothing about orientation, theirs is
    tens of degrees off: it is read as which of the stable faces is meant.
    """

    def propose(
        self, scene: Scene, arguments: Sequence[str], count: int, rng: Random
    ) -> list[Placement | Pose]:
        """Propose `count` placements of body `arguments[0]` on or in `arguments[1]`, unordered; a
        pose where it is far from the region, or the body rests on no face.
        """
        support = relation_scene_of(scene, arguments).support
        proposals: list[Placement | Pose] = []
        while len(proposals) < count:
            situation = relation_scene_of(scene, arguments, afloat(support, rng))
            proposed = self.model.propose(situation, min(TOGETHER, count - len(proposals)), rng)
            for pose in proposed:
                face = nearest_face(situation.body.form, pose)
                if face is None:
                    proposals.append(Pose.from_matrix(pose))
                    continue
                turned = snapped(situation.body.form, face, pose)
                proposals.append(laid(scene, arguments, face.rotation, turned))

        return proposals


def nearest_face(form: BodyGeometry, pose: Array) -> Face | None:
    """Return the stable face that is nearest to being down at T_world_body (4, 4), if there is
    any.
    """
    return max(form.faces, key=lambda face: float(face.rotation[2] @ pose[2, :3]), default=None)


def snapped(form: BodyGeometry, face: Face, pose: Array) -> Array:
    """Turn the pose about the body's middle onto a stable face, the lowest point as high as it was.

    Args:
        form: The body's.
        face: One of its faces.
        pose: T_world_body, shape (4, 4).
    """
    up = face.rotation[2]  # the world's up in the body's frame, were it on that face
    before = pose[2, :3]
    axis, cosine = np.cross(up, before), float(up @ before)
    cross = np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    turn = (
        np.eye(3) + cross + cross @ cross / max(1.0 + cosine, 1e-9)
    )  # Rodrigues: turn @ up = before
    result = pose.copy()
    result[:3, :3] = pose[:3, :3] @ turn
    middle = form.corners.mean(axis=0)
    result[:3, 3] = pose[:3, :3] @ middle + pose[:3, 3] - result[:3, :3] @ middle
    result[2, 3] += (
        (form.vertices @ pose[2, :3]).min() + pose[2, 3] - (form.vertices @ up).min() - result[2, 3]
    )
    return result
