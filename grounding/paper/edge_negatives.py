"""Negative samples close by the limits of a relation, a departure from the paper's: beside the
surface at its height, grazing another body, poking out of a container.

Of the paper's negatives 2 % are beside the surface at its height, so that its classifiers take most
poses over the edge for good (docs/paper-models.md).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.random import Generator as Random

from grounding.body_geometry import BodyGeometry
from grounding.paper.scenes import PaperScenes
from grounding.relation_scene import Placed
from grounding.scenes import SampledScene
from grounding.separation import Obstacles, separations
from tamp.geometric.scene.pose import Array

EDGE_KINDS: Mapping[str, Mapping[str, float]] = {
    "on": {
        "alone": 0.1,
        "among others": 0.4,
        "afloat": 0.05,
        "on the ground": 0.025,
        "above": 0.05,
        "sunken": 0.05,
        "in the middle": 0.025,
        "on another support": 0.025,
        "colliding": 0.1,
        "grazing": 0.075,
        "beside": 0.1,
    },
    "inside": {
        "alone": 0.1,
        "among others": 0.4,
        "afloat": 0.025,
        "on the ground": 0.025,
        "above": 0.05,
        "sunken": 0.05,
        "on another support": 0.025,
        "colliding": 0.075,
        "grazing": 0.075,
        "sticking out": 0.075,
        "poking out": 0.1,
    },
}
"""The share of each type of sample, in place of `grounding.demonstrations.KINDS`."""

BESIDE_M = 0.3
"""How far from the surface the middle of a body is at most that stands beside it, metres."""

GRAZE_M = (0.002, 0.03)
"""How deep a body is in the one that it grazes, metres."""

POKE_M = (0.001, 0.05)
"""How far a corner of the own box is out of the container's box, metres."""


def beside(scenes: PaperScenes, scene: SampledScene, rng: Random) -> Array | None:
    """Put the body at rest height with the middle of its own box beside the surface."""
    poses = scenes.resting(scene, rng)
    if not len(poses):
        return None
    half = scene.support.region.size[:2] / 2
    while True:
        at = rng.uniform(-half - BESIDE_M, half + BESIDE_M)
        if (np.abs(at) > half).any():
            break
    inner = np.linalg.inv(scene.T_world_region) @ poses[0]
    inner[:2, 3] = at - inner[:2, :3] @ scene.body.corners.mean(axis=0)
    return scene.T_world_region @ inner


def grazing(scenes: PaperScenes, scene: SampledScene, rng: Random) -> Array | None:
    """Put the body where it is a little in another one that is on or in argument 0."""
    poses = scenes.resting(scene, rng)
    with_it = [item for item in scene.placed[1:] if is_with(scene, item)]
    if not len(poses) or not with_it:
        return None

    other = with_it[int(rng.integers(len(with_it)))]
    reach = (_radius(scene.body) + _radius(other.form)) * rng.uniform(-1.0, 1.0, (len(poses), 2))
    poses[:, :2, 3] = other.matrix[:2, 3] + reach
    gaps = separations(scene.body, poses, Obstacles([other]))[:, 0]
    grazed = poses[(gaps < -GRAZE_M[0]) & (gaps > -GRAZE_M[1])]
    return grazed[0] if len(grazed) else None


def poking_out(scenes: PaperScenes, scene: SampledScene, rng: Random) -> Array | None:
    """Move the body from rest until a corner of its own box is a little out of the container's
    box, through any of its six sides.
    """
    poses = scenes.resting(scene, rng)
    if not len(poses):
        return None
    region = scene.support.region
    inner = np.linalg.inv(scene.stand.matrix) @ poses[0]
    middle, half = scene.body.corners.mean(axis=0), np.ptp(scene.body.corners, axis=0) / 2
    centre, reach = inner[:3, :3] @ middle + inner[:3, 3], np.abs(inner[:3, :3]) @ half
    axis, side = int(rng.integers(3)), int(rng.integers(2))
    sign = 2 * side - 1
    outermost = centre[axis] + sign * reach[axis]
    inner[axis, 3] += region.box[side, axis] + sign * rng.uniform(*POKE_M) - outermost
    return scene.stand.matrix @ inner


def is_with(scene: SampledScene, item: Placed) -> bool:
    """Check whether a body is on or in argument 0, not on the floor."""
    local = np.linalg.inv(scene.T_world_region) @ item.matrix[:, 3]
    return bool((np.abs(local[:2]) <= scene.support.region.size[:2] / 2).all() and local[2] > 0.0)


def _radius(form: BodyGeometry) -> float:
    return float(np.linalg.norm(np.ptp(form.corners, axis=0)[:2])) / 2


EDGE_NEGATIVES: Mapping[str, Callable[[PaperScenes, SampledScene, Random], Array | None]] = {
    "beside": beside,
    "grazing": grazing,
    "poking out": poking_out,
}
"""Who makes samples of each type that the paper has not."""
