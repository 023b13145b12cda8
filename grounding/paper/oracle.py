"""The published code's judge of a pose: bodies' own boxes, no physics.

../shared/PAPER_MODELS.md, section 1, says how that code judges; ours, `grounding.oracles`, looks at
true vertices and is the more lenient one.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import product

import numpy as np
from numpy.typing import NDArray

from grounding.body_geometry import BodyGeometry
from grounding.oracles import DEPTH, NEAR
from grounding.relation_scene import Placed, RelationScene
from grounding.separation import Obstacles, separations
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Box, Part

CLOUD_NEAR_M = 0.063
"""`on`: the tolerance that the published judge comes to for clouds, metres: 3 cm in the units to
which it scales a scene whose largest body is a table of 1.5 m at 1.4 times its size.
"""


def published_oracle(
    situation: RelationScene, poses: Array, near: float = NEAR
) -> NDArray[np.bool_]:
    """Judge poses T_world_body, shape (n, 4, 4), by the published oracle; returns shape (n,).

    `on`: the bottom of the box along the world's axes around the body's own box within `near`
    metres of the support's top, the own box's centre above the surface, own boxes of the body and
    of the surroundings apart. `inside`: the eight corners of the own box in the container's box,
    true hulls at most DEPTH in each other.
    """
    if situation.region.hollow:
        form, others, depth = situation.body.form, situation.others, DEPTH
    else:
        form = own_box(situation.body.form)
        others = tuple(Placed(own_box(other.form), other.matrix) for other in situation.others)
        depth = 0.0

    apart = (separations(form, poses, Obstacles(others)) >= -depth).all(axis=1)
    return in_place(situation, poses, near) & apart


def in_place(situation: RelationScene, poses: Array, near: float = NEAR) -> NDArray[np.bool_]:
    """Judge poses T_world_body, shape (n, 4, 4), as `published_oracle` does without the
    surroundings: by where the body's own box is; returns shape (n,).
    """
    region = situation.region
    low, high = situation.body.form.corners
    corners = np.array([*product(*zip(low, high, strict=True))])
    frame = situation.support.matrix if region.hollow else situation.T_world_region
    inner = np.linalg.inv(frame) @ poses
    points = corners @ inner[:, :3, :3].transpose(0, 2, 1) + inner[:, None, :3, 3]
    if region.hollow:
        return ((points > region.box[0]) & (points < region.box[1])).all(axis=(1, 2))

    lowest, centre = points[:, :, 2].min(axis=1), points[:, :, :2].mean(axis=1)
    return (np.abs(lowest) < near) & (np.abs(centre) <= region.size[:2] / 2).all(axis=1)


def own_box(form: BodyGeometry) -> BodyGeometry:
    """Return the form of a body's bounding box along its own axes."""
    low, high = form.corners
    return _box(tuple(low.tolist()), tuple(high.tolist()))


@lru_cache(maxsize=4096)
def _box(low: tuple[float, ...], high: tuple[float, ...]) -> BodyGeometry:
    size, middle = np.subtract(high, low), np.add(high, low) / 2
    part = Part(Box(tuple(size.tolist())), Pose(tuple(middle.tolist())))
    return BodyGeometry((part,))
