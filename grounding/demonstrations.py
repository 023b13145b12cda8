"""Labelled scenes from physics: the paper's sample types (section III-E), settled and checked against true geometry."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.random import Generator as Random

from grounding.form import Form
from grounding.objects import object_templates
from grounding.oracles import REACH, ItemOf, Verdict, settled
from grounding.random_poses import afloat, on_ground, pick, random_rest, random_scale, random_turn, solids, upright
from grounding.separation import Obstacles, separations
from grounding.situation import Placed, gap, near
from grounding.supports import Support, scaled_region, support_templates
from tamp.simulation.drop import Drops, Item
from tamp.streams.resting import resting_pose
from tamp.world.pose import Array

Kinds = Mapping[str, float]

KINDS: Mapping[str, Kinds] = {
    "on": {
        "alone": 0.1, "among others": 0.4, "afloat": 0.075, "on the ground": 0.05, "above": 0.075, "sunken": 0.05,
        "in the middle": 0.075, "on another support": 0.05, "colliding": 0.125,
    },
    "inside": {
        "alone": 0.1, "among others": 0.4, "afloat": 0.05, "on the ground": 0.05, "above": 0.075, "sunken": 0.075,
        "on another support": 0.05, "colliding": 0.1, "sticking out": 0.1,
    },
}  # fmt: skip
"""The share of each type of sample (LEARNING.md, section 1); the first two hold, the others do not."""

POSITIVE = ("alone", "among others")

OTHERS = {"train": (5, 9), "test": (5, 15)}
"""Bodies in a scene beside the arguments and the other support."""

OBJECT_SCALES = {"train": (0.5, 1.6), "test": (0.4, 1.8)}
SUPPORT_SCALES = {"train": (0.8, 1.2), "test": (0.6, 1.4)}
"""Sizes; the paper's ranges. In steps of 0.1."""

TUMBLED = 0.15
"""The share of positive samples that are dropped in any orientation instead of put down."""

TRIES = 16
"""Poses at rest that are tried at once."""

_GAP = 0.001


@dataclass(frozen=True, eq=False)
class Made:
    """One scene: what `Dataset` keeps of it. Index 0 is argument 0, index 1 the body."""

    names: list[str]
    scales: list[float]
    poses: list[Array]
    support: Support
    kind: str
    feasible: bool


class Maker:
    """Makes scenes of one relation and split; keep it, for its shapes are made once.

    Args:
        relation: "on" or "inside".
        split: "train" or "test".
        drops: The engine.
        folder: Of one's own meshes, as for `object_templates`.
    """

    def __init__(self, relation: str, split: str, drops: Drops, folder: Path | None = None) -> None:
        self.relation, self.split, self._drops = relation, split, drops
        self._objects = {name: Form(parts) for name, parts in object_templates(split, folder).items()}
        self._supports = dict(support_templates(relation, split))
        self._tables = dict(support_templates("on", split))
        self._forms = {name: Form(support.parts) for name, support in (self._supports | self._tables).items()}
        self._scaled: dict[tuple[str, float], Form] = {}
        self._items = ItemOf()

    def make(self, kind: str, rng: Random) -> Made:
        """A scene of this kind; tries until one is found."""
        while True:
            made = self._try(kind, rng)
            if made is not None:
                return made

    def _try(self, kind: str, rng: Random) -> Made | None:
        name, scale = pick(self._supports, rng), random_scale(SUPPORT_SCALES[self.split], rng)
        support = self._supports[name]
        support = replace(support, region=scaled_region(support.region, scale))
        names, scales = [name], [scale]
        placed = [Placed(self._form(name, scale), upright(rng.uniform(-1.5, 1.5, 2), rng))]
        name, scale = pick(self._objects, rng), random_scale(OBJECT_SCALES[self.split], rng)
        body = self._form(name, scale)
        names, scales = [*names, name], [*scales, scale]
        other = self._other_support(placed[0], rng)
        others: list[tuple[str, float, Placed]] = [] if other is None else [other]
        for number in range(int(rng.integers(OTHERS[self.split][0], OTHERS[self.split][1] + 1))):
            found = self._distractor(kind, number, placed[0], support, others, rng)
            if found is not None:
                others.append(found)
        situation = near(placed[0], support.region, Placed(body, np.eye(4)), [item for _, _, item in others])
        everything = Obstacles([item for _, _, item in others])
        scene = _Scene(placed[0], support, body, others, everything, situation.T_world_region)
        pose = self._positive(scene, rng) if kind in POSITIVE else _NEGATIVES[kind](self, scene, rng)
        if pose is None:
            return None
        situation = near(placed[0], support.region, Placed(body, pose), [item for _, _, item in others])
        holds = settled(situation, pose[None], self._drops, self._items)[0] is Verdict.HOLDS
        if holds != (kind in POSITIVE):
            return None
        feasible = holds or self.split == "train" or self._feasible(scene, rng)
        poses = [placed[0].matrix, pose, *(item.matrix for _, _, item in others)]
        names, scales = [*names, *(o[0] for o in others)], [*scales, *(o[1] for o in others)]
        return Made(names, scales, poses, support, kind, feasible)

    # The argument

    def _positive(self, scene: _Scene, rng: Random) -> Array | None:
        if rng.random() < TUMBLED:
            pose = random_turn(rng)
            low = float((scene.body.vertices @ pose[2, :3]).min())
            half = scene.support.region.size[:2] / 2
            pose[:3, 3] = (*rng.uniform(-0.8, 0.8, 2) * half, 0.01 - low)
            poses = (scene.T_world_region @ pose)[None]
        else:
            poses = self._resting(scene.body, scene, rng)
        for pose in self._free(poses, scene)[:4]:
            self._drops.set_up(self._items(scene.body), self._around(scene, pose))
            if all(contact.distance > -0.0005 for contact in self._drops.contacts(pose)):
                return self._drops.drop(pose, 2.5)
        return None

    def _feasible(self, scene: _Scene, rng: Random) -> bool:
        poses = np.concatenate([self._resting(scene.body, scene, rng) for _ in range(16)])
        free = self._free(poses, scene)[:8]
        situation = near(
            scene.stand, scene.support.region, Placed(scene.body, np.eye(4)), [o for _, _, o in scene.others]
        )
        return any(verdict is Verdict.HOLDS for verdict in settled(situation, free, self._drops, self._items))

    def _around(self, scene: _Scene, pose: Array) -> list[tuple[Item, Array]]:
        box = Placed(scene.body, pose).box
        bodies = [scene.stand, *(item for _, _, item in scene.others if gap(item.box, box) < REACH)]
        return [(self._items(item.form), item.matrix) for item in bodies]

    def _free(self, poses: Array, scene: _Scene, gap: float = _GAP) -> Array:
        if not len(poses) or not scene.others:
            return poses
        return poses[(separations(scene.body, poses, scene.obstacles) > gap).all(axis=1)]

    def _resting(self, form: Form, scene: _Scene, rng: Random, overhang: bool = True) -> Array:
        """World poses at rest in the region, up to TRIES: any face, any yaw, the body or its centre inside."""
        region = scene.support.region
        poses = [
            scene.T_world_region @ pose
            for pose in (
                random_rest(form, region.size, not region.hollow and overhang and rng.random() < 0.3, rng)
                for _ in range(TRIES)
            )
            if pose is not None
        ]
        return np.stack(poses) if poses else np.zeros((0, 4, 4))

    # The surroundings

    def _other_support(self, stand: Placed, rng: Random) -> tuple[str, float, Placed] | None:
        name, scale = pick(self._tables, rng), random_scale(SUPPORT_SCALES[self.split], rng)
        form = self._form(name, scale)
        reach = 0.5 * float(np.linalg.norm(np.ptp(stand.form.corners, axis=0)[:2]))
        reach += 0.5 * float(np.linalg.norm(np.ptp(form.corners, axis=0)[:2]))
        angle = rng.uniform(-math.pi, math.pi)
        away = (reach + rng.uniform(0.02, 0.5)) * np.array([math.cos(angle), math.sin(angle)])
        return name, scale, Placed(form, upright(stand.matrix[:2, 3] + away, rng))

    def _distractor(
        self,
        kind: str,
        number: int,
        stand: Placed,
        support: Support,
        others: list[tuple[str, float, Placed]],
        rng: Random,
    ) -> tuple[str, float, Placed] | None:
        name, scale = pick(self._objects, rng), random_scale(OBJECT_SCALES[self.split], rng)
        form = self._form(name, scale)
        where = rng.random()
        T_world_region = stand.matrix @ support.region.matrix
        if kind != "alone" and (where < 0.6 or number == 0):
            poses = [random_rest(form, support.region.size, False, rng) for _ in range(6)]
            poses = [T_world_region @ pose for pose in poses if pose is not None]
        elif where < 0.75 and others:
            poses = [self._on_other(form, others[0], rng)]
        elif where < 0.9:
            poses = [on_ground(form, stand, rng) for _ in range(3)]
        else:
            poses = [afloat(stand, rng) for _ in range(3)]
        obstacles = Obstacles([*(item for _, _, item in others), *solids(stand)])
        for pose in (pose for pose in poses if pose is not None):
            if (separations(form, pose[None], obstacles) > 0.5 * _GAP).all():
                return name, scale, Placed(form, pose)
        return None

    def _on_other(self, form: Form, other: tuple[str, float, Placed], rng: Random) -> Array | None:
        name, scale, item = other
        region = scaled_region(self._tables[name].region, scale)
        pose = random_rest(form, region.size, False, rng)
        return None if pose is None else item.matrix @ region.matrix @ pose

    def _form(self, name: str, scale: float) -> Form:
        if (name, scale) not in self._scaled:
            self._scaled[name, scale] = (self._objects.get(name) or self._forms[name]).scaled(scale)
        return self._scaled[name, scale]

    # Samples that do not hold

    def _floating(self, scene: _Scene, rng: Random) -> Array | None:
        return afloat(scene.stand, rng)

    def _grounded(self, scene: _Scene, rng: Random) -> Array | None:
        return on_ground(scene.body, scene.stand, rng)

    def _lifted(self, scene: _Scene, rng: Random) -> Array | None:
        return self._shifted(scene, rng.uniform(0.035, 0.25), rng)

    def _sunken(self, scene: _Scene, rng: Random) -> Array | None:
        return self._shifted(scene, -rng.uniform(0.005, 0.12), rng)

    def _shifted(self, scene: _Scene, by: float, rng: Random) -> Array | None:
        poses = self._free(self._resting(scene.body, scene, rng), scene)
        if not len(poses):
            return None
        poses[0, 2, 3] += by
        return poses[0]

    def _centred(self, scene: _Scene, rng: Random) -> Array | None:
        pose = random_turn(rng)
        low, high = scene.stand.box
        pose[:3, 3] = (low + high) / 2 + rng.uniform(-0.15, 0.15, 3) * (high - low)
        return pose

    def _elsewhere(self, scene: _Scene, rng: Random) -> Array | None:
        return self._on_other(scene.body, scene.others[0], rng) if scene.others else None

    def _colliding(self, scene: _Scene, rng: Random) -> Array | None:
        poses = self._resting(scene.body, scene, rng)
        if not len(poses) or not scene.others:
            return None
        hit = poses[(separations(scene.body, poses, scene.obstacles) < -0.002).any(axis=1)]
        return hit[0] if len(hit) else None

    def _sticking(self, scene: _Scene, rng: Random) -> Array | None:
        region, body = scene.support.region, scene.body
        tall = [face for face in body.faces if face.extent > region.size[2] + 0.005]
        if tall and rng.random() < 0.5:
            face = tall[int(rng.integers(len(tall)))]
            x, y = rng.uniform(-0.5, 0.5, 2) * region.size[:2] * 0.6
            return scene.T_world_region @ resting_pose(face, rng.uniform(-math.pi, math.pi), x, y).matrix
        pose = random_rest(body, (*region.size[:2], math.inf), True, rng)
        if pose is None:
            return None
        points = body.vertices @ pose[:3, :3].T + pose[:3, 3]
        axis, sign = int(rng.integers(2)), float(rng.choice([-1.0, 1.0]))
        outermost = (sign * points[:, axis]).max()
        pose[axis, 3] += sign * (region.size[axis] / 2 + rng.uniform(0.005, 0.1) - outermost)
        return scene.T_world_region @ pose


@dataclass(frozen=True, eq=False)
class _Scene:
    stand: Placed
    support: Support
    body: Form
    others: list[tuple[str, float, Placed]]
    obstacles: Obstacles
    T_world_region: Array


_NEGATIVES: Mapping[str, Callable[[Maker, _Scene, Random], Array | None]] = {
    "afloat": Maker._floating,
    "on the ground": Maker._grounded,
    "above": Maker._lifted,
    "sunken": Maker._sunken,
    "in the middle": Maker._centred,
    "on another support": Maker._elsewhere,
    "colliding": Maker._colliding,
    "sticking out": Maker._sticking,
}
