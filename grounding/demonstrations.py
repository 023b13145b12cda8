"""Labelled scenes from physics: the paper's sample types (section III-E), settled and checked
against true geometry.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
from numpy.random import Generator as Random

from grounding.mesh_folder import MeshFolder
from grounding.oracles import Verdict, drop_verdicts
from grounding.random_poses import afloat, on_ground, random_rest, random_turn
from grounding.scenes import (
    LabelledScene,
    SampledScene,
    SceneSampler,
    free,
    resting,
    some_hold_in_physics,
    touchable,
)
from grounding.separation import separations
from tamp.geometric.scene.pose import Array
from tamp.geometric.stability.placement import resting_pose
from tamp.simulation.drops import Drops

Kinds = Mapping[str, float]

KINDS: Mapping[str, Kinds] = {
    "on": {
        "alone": 0.1,
        "among others": 0.4,
        "afloat": 0.075,
        "on the ground": 0.05,
        "above": 0.075,
        "sunken": 0.05,
        "in the middle": 0.075,
        "on another support": 0.05,
        "colliding": 0.125,
    },
    "inside": {
        "alone": 0.1,
        "among others": 0.4,
        "afloat": 0.05,
        "on the ground": 0.05,
        "above": 0.075,
        "sunken": 0.075,
        "on another support": 0.05,
        "colliding": 0.1,
        "sticking out": 0.1,
    },
}
"""The share of each type of sample (LEARNING.md, section 1); the first two hold, the
others do not.
"""

POSITIVE = ("alone", "among others")

TUMBLED = 0.15
"""The share of positive samples that are dropped in any orientation instead of put down."""


class DemonstrationGenerator:
    """Makes scenes of one relation and split; keep it, for its shapes are made once.

    Args:
        relation: "on" or "inside".
        split: "train" or "test".
        drops: The engine.
        folder: Of one's own meshes.
    """

    def __init__(
        self, relation: str, split: str, drops: Drops, folder: MeshFolder | None = None
    ) -> None:
        self._split, self._drops, self._scenes = split, drops, SceneSampler(relation, split, folder)

    def make(self, kind: str, rng: Random) -> LabelledScene:
        """Sample a scene of this kind; tries until one is found."""
        while True:
            made = self._try(kind, rng)
            if made is not None:
                return made

    def _try(self, kind: str, rng: Random) -> LabelledScene | None:
        scene = self._scenes.draw(rng, crowded=kind != "alone")
        pose = (
            self._positive(scene, rng) if kind in POSITIVE else _NEGATIVES[kind](self, scene, rng)
        )
        if pose is None:
            return None
        holds = (
            drop_verdicts(scene.situation(pose), pose[None], self._drops, self._scenes.items)[0]
            is Verdict.HOLDS
        )
        if holds != (kind in POSITIVE):
            return None
        return scene.made(
            pose, kind, holds, holds or self._split == "train" or self._feasible(scene, rng)
        )

    # The argument

    def _positive(self, scene: SampledScene, rng: Random) -> Array | None:
        if rng.random() < TUMBLED:
            pose = random_turn(rng)
            low = float((scene.body.vertices @ pose[2, :3]).min())
            half = scene.support.region.size[:2] / 2
            pose[:3, 3] = (*rng.uniform(-0.8, 0.8, 2) * half, 0.01 - low)
            poses = (scene.T_world_region @ pose)[None]
        else:
            poses = resting(scene, rng)
        for pose in free(poses, scene)[:4]:
            self._drops.set_up(
                self._scenes.items(scene.body), touchable(scene, pose, self._scenes.items)
            )
            if all(contact.distance > -0.0005 for contact in self._drops.contacts(pose)):
                return self._drops.drop(pose, 2.5)
        return None

    def _feasible(self, scene: SampledScene, rng: Random) -> bool:
        poses = np.concatenate([resting(scene, rng) for _ in range(16)])
        return some_hold_in_physics(scene, poses, self._drops, self._scenes.items)

    # Samples that do not hold

    def _floating(self, scene: SampledScene, rng: Random) -> Array | None:
        return afloat(scene.stand, rng)

    def _grounded(self, scene: SampledScene, rng: Random) -> Array | None:
        return on_ground(scene.body, scene.stand, rng)

    def _lifted(self, scene: SampledScene, rng: Random) -> Array | None:
        return self._shifted(scene, rng.uniform(0.035, 0.25), rng)

    def _sunken(self, scene: SampledScene, rng: Random) -> Array | None:
        return self._shifted(scene, -rng.uniform(0.005, 0.12), rng)

    def _shifted(self, scene: SampledScene, by: float, rng: Random) -> Array | None:
        poses = free(resting(scene, rng), scene)
        if not len(poses):
            return None
        poses[0, 2, 3] += by
        return poses[0]

    def _centred(self, scene: SampledScene, rng: Random) -> Array | None:
        pose = random_turn(rng)
        low, high = scene.stand.box
        pose[:3, 3] = (low + high) / 2 + rng.uniform(-0.15, 0.15, 3) * (high - low)
        return pose

    def _elsewhere(self, scene: SampledScene, rng: Random) -> Array | None:
        return self._scenes.on_other(scene.body, scene.others[0], rng)

    def _colliding(self, scene: SampledScene, rng: Random) -> Array | None:
        poses = resting(scene, rng)
        if not len(poses) or not scene.others:
            return None
        hit = poses[(separations(scene.body, poses, scene.obstacles) < -0.002).any(axis=1)]
        return hit[0] if len(hit) else None

    def _sticking(self, scene: SampledScene, rng: Random) -> Array | None:
        return sticking_out(scene, rng)


def sticking_out(scene: SampledScene, rng: Random) -> Array | None:
    """Sample a pose at rest in a cavity, shape (4, 4), with the body too tall for it or across its
    side; None where none was found.
    """
    region, body = scene.support.region, scene.body
    tall = [face for face in body.faces if face.extent > region.size[2] + 0.005]
    if tall and rng.random() < 0.5:
        face = tall[int(rng.integers(len(tall)))]
        x, y = rng.uniform(-0.5, 0.5, 2) * region.size[:2] * 0.6
        return (
            scene.T_world_region @ resting_pose(face, rng.uniform(-math.pi, math.pi), x, y).matrix
        )
    pose = random_rest(body, (*region.size[:2], math.inf), True, rng)
    if pose is None:
        return None
    points = body.vertices @ pose[:3, :3].T + pose[:3, 3]
    axis, sign = int(rng.integers(2)), float(rng.choice([-1.0, 1.0]))
    outermost = (sign * points[:, axis]).max()
    pose[axis, 3] += sign * (region.size[axis] / 2 + rng.uniform(0.005, 0.1) - outermost)
    return scene.T_world_region @ pose


_NEGATIVES: Mapping[str, Callable[[DemonstrationGenerator, SampledScene, Random], Array | None]] = {
    "afloat": DemonstrationGenerator._floating,
    "on the ground": DemonstrationGenerator._grounded,
    "above": DemonstrationGenerator._lifted,
    "sunken": DemonstrationGenerator._sunken,
    "in the middle": DemonstrationGenerator._centred,
    "on another support": DemonstrationGenerator._elsewhere,
    "colliding": DemonstrationGenerator._colliding,
    "sticking out": DemonstrationGenerator._sticking,
}
