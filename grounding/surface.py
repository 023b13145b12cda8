"""The reference samplers for `on` and `inside` as an engineer would write them, without
training.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.random import Generator as Random

from grounding.relation_scene import RelationScene
from grounding.separation import Obstacles, separations
from tamp.geometric.samplers.placements import KEEP_FACE, position_inside
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import CONTACT_GAP
from tamp.geometric.stability.placement import SNAP_HEIGHT_M, resting_pose
from tamp.geometric.stability.stable_poses import SNAP_TILT_RAD, WIDTH_SLACK_M, Face

DEPTH = 0.001
"""Bodies may lie this deep in each other, metres."""


class SurfaceModel:
    """Draws as the planner's hand-made sampler does (`tamp.geometric.samplers.placements`), and
    judges by geometry.
    """

    def propose(self, situation: RelationScene, count: int, rng: Random) -> Array:
        """Propose `count` poses, in no order: a stable face down, flush, whole inside the region
        where it fits; bodies around are not looked at. None when no stable
        face fits under the ceiling.
        """
        region = situation.region
        faces = [
            face for face in _faces(situation) if face.extent + 2 * CONTACT_GAP <= region.size[2]
        ]
        if not faces or count < 1:
            return np.zeros((0, 4, 4))
        poses: list[Array] = []
        for _ in range(count):
            face = faces[0] if rng.random() < KEEP_FACE else faces[int(rng.integers(len(faces)))]
            yaw = rng.uniform(-math.pi, math.pi)
            x, y = position_inside(face, yaw, region.size.tolist(), rng)
            poses.append(resting_pose(face, yaw, x, y).matrix)
        return situation.T_world_region @ np.stack(poses)

    def classify(self, situation: RelationScene, poses: Array) -> Array:
        """Return 1 or 0, shape (n,): near the floor of the region with a stable face down, above it
        (`on`: the centre of mass; `inside`: the whole body), in none of the bodies around.
        """
        region, form = situation.region, situation.body.form
        inner = np.linalg.inv(situation.T_world_region) @ poses
        points = form.vertices @ inner[:, :3, :3].transpose(0, 2, 1) + inner[:, None, :3, 3]
        low, high = points.min(axis=1), points.max(axis=1)
        half = region.size[:2] / 2
        if region.hollow:
            above = (low[:, :2] >= -half - WIDTH_SLACK_M) & (high[:, :2] <= half + WIDTH_SLACK_M)
        else:
            above = (
                np.abs((inner[:, :3, :3] @ form.centre_of_mass + inner[:, :3, 3])[:, :2]) <= half
            )
        downs = np.array([-face.rotation[2] for face in form.faces]).reshape(-1, 3)
        upright = (-inner[:, 2, :3] @ downs.T > math.cos(SNAP_TILT_RAD)).any(axis=1)
        free = (separations(form, poses, Obstacles(situation.others)) > -DEPTH).all(axis=1)
        fits = (np.abs(low[:, 2]) <= SNAP_HEIGHT_M) & (high[:, 2] <= region.size[2] + WIDTH_SLACK_M)
        return (above.all(axis=1) & upright & free & fits).astype(np.float64)


def _faces(situation: RelationScene) -> list[Face]:
    """Return the stable faces, the one that is down where the body is first, then the steadiest."""
    down = -situation.body.matrix[2, :3]
    return sorted(
        situation.body.form.faces,
        key=lambda face: float(-face.rotation[2] @ down) <= math.cos(SNAP_TILT_RAD),
    )
