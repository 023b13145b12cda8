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
from grounding.runtime import Grounding
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Scene

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
    ) -> list[Pose]:
        """Propose `count` world poses of body `arguments[0]` on or in `arguments[1]`, unordered."""
        support = relation_scene_of(scene, arguments).support
        poses: list[Pose] = []
        while len(poses) < count:
            situation = relation_scene_of(scene, arguments, afloat(support, rng))
            proposed = self.model.propose(situation, min(TOGETHER, count - len(poses)), rng)
            poses += [Pose.from_matrix(snapped(situation.body.form, pose)) for pose in proposed]
        return poses


def snapped(form: BodyGeometry, pose: Array) -> Array:
    """Turn the pose about the body's middle onto the nearest stable face, the lowest point as high
    as it was.

    Args:
        form: The body's; one without stable faces is left as it is.
        pose: T_world_body, shape (4, 4).
    """
    if not form.faces:
        return pose

    # the world's up in the body's frame, were it on that face
    ups = np.array([face.rotation[2] for face in form.faces])
    up = ups[np.argmax(ups @ pose[2, :3])]
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
