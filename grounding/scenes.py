"""Random scenes to put a body into: a support or container, another support, and bodies on, in and
around them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.random import Generator as Random

from grounding.body_geometry import BodyGeometry
from grounding.mesh_folder import MeshFolder
from grounding.objects import object_templates
from grounding.oracles import DROP_NEIGHBOURS_M, ItemOf, Verdict, drop_verdicts
from grounding.random_poses import (
    afloat,
    on_ground,
    pick,
    random_rest,
    random_scale,
    solids,
    upright,
)
from grounding.relation_scene import Placed, RelationScene, gap, near
from grounding.separation import Obstacles, separations
from grounding.supports import FurnitureSupport, scaled_region, support_templates
from tamp.geometric.scene.pose import Array
from tamp.simulation.drops import Drops, Item

OTHERS = {"train": (5, 9), "test": (5, 15)}
"""Bodies in a scene beside the arguments and the other support."""

OBJECT_SCALES = {"train": (0.5, 1.6), "test": (0.4, 1.8)}
SUPPORT_SCALES = {"train": (0.8, 1.2), "test": (0.6, 1.4)}
"""Sizes; the paper's ranges. In steps of 0.1."""

TRIES = 16
"""Poses at rest that are tried at once."""

TRIED = 8
"""Poses that are let go until a scene counts as one in which nothing holds."""

GAP = 0.001
"""Metres that are kept between bodies."""


@dataclass(frozen=True, eq=False)
class LabelledScene:
    """One labelled scene: what `Dataset` keeps of it. Index 0 is the support, index 1 the body.

    Attributes:
        columns: Numbers that are kept beside, the same names in every scene of a data set.
    """

    names: list[str]
    scales: list[float]
    poses: list[Array]
    support: FurnitureSupport
    kind: str
    holds: bool
    feasible: bool
    columns: Mapping[str, int] = field(default_factory=dict[str, int])


@dataclass(frozen=True, eq=False)
class SampledScene:
    """A scene without a pose for its body.

    Attributes:
        names, scales: Of the support and the body.
        stand: The support.
        support: Of what it is made, with its region at its size.
        body: What is placed.
        others: Names, scales and places of all other bodies.
    """

    names: tuple[str, str]
    scales: tuple[float, float]
    stand: Placed
    support: FurnitureSupport
    body: BodyGeometry
    others: tuple[tuple[str, float, Placed], ...]
    obstacles: Obstacles
    T_world_region: Array

    @property
    def placed(self) -> list[Placed]:
        """Return the other bodies."""
        return [item for _, _, item in self.others]

    def situation(self, pose: Array) -> RelationScene:
        """Return the situation with the body at T_world_body, shape (4, 4)."""
        return near(self.stand, self.support.region, Placed(self.body, pose), self.placed)

    def made(
        self,
        pose: Array,
        kind: str,
        holds: bool,
        feasible: bool,
        columns: Mapping[str, int] | None = None,
    ) -> LabelledScene:
        """Label this scene, with the body at T_world_body, shape (4, 4)."""
        names = [*self.names, *(name for name, _, _ in self.others)]
        scales = [*self.scales, *(scale for _, scale, _ in self.others)]
        poses = [self.stand.matrix, pose, *(item.matrix for item in self.placed)]
        return LabelledScene(
            names, scales, poses, self.support, kind, holds, feasible, columns or {}
        )


class SceneSampler:
    """Draws scenes of one relation and split; keep it, for its shapes are made once.

    Args:
        relation: "on" or "inside".
        split: "train" or "test".
        folder: Of one's own meshes.
    """

    def __init__(self, relation: str, split: str, folder: MeshFolder | None = None) -> None:
        self.split, self.items = split, ItemOf()
        self._objects = {
            name: BodyGeometry(parts) for name, parts in object_templates(split, folder).items()
        }
        self._supports = dict(support_templates(relation, split))
        self._tables = dict(support_templates("on", split))
        self._forms = {
            name: BodyGeometry(support.parts)
            for name, support in (self._supports | self._tables).items()
        }
        self._scaled: dict[tuple[str, float], BodyGeometry] = {}

    def draw(self, rng: Random, *, crowded: bool = True) -> SampledScene:
        """Sample a scene; `crowded` has bodies on or in the support."""
        name, scale = pick(self._supports, rng), random_scale(SUPPORT_SCALES[self.split], rng)
        support = self._supports[name]
        support = replace(support, region=scaled_region(support.region, scale))
        stand = Placed(self._form(name, scale), upright(rng.uniform(-1.5, 1.5, 2), rng))
        body_name, body_scale = (
            pick(self._objects, rng),
            random_scale(OBJECT_SCALES[self.split], rng),
        )
        others = [self._other_support(stand, rng)]
        for number in range(int(rng.integers(OTHERS[self.split][0], OTHERS[self.split][1] + 1))):
            found = self._distractor(crowded, number, stand, support, others, rng)
            if found is not None:
                others.append(found)

        return SampledScene(
            (name, body_name),
            (scale, body_scale),
            stand,
            support,
            self._form(body_name, body_scale),
            tuple(others),
            Obstacles([item for _, _, item in others]),
            stand.matrix @ support.region.matrix,
        )

    def on_other(
        self, form: BodyGeometry, other: tuple[str, float, Placed], rng: Random
    ) -> Array | None:
        """Sample a pose at rest on the other support."""
        name, scale, item = other
        region = scaled_region(self._tables[name].region, scale)
        pose = random_rest(form, region.size, False, rng)
        return None if pose is None else item.matrix @ region.matrix @ pose

    def _other_support(self, stand: Placed, rng: Random) -> tuple[str, float, Placed]:
        name, scale = pick(self._tables, rng), random_scale(SUPPORT_SCALES[self.split], rng)
        form = self._form(name, scale)
        reach = 0.5 * float(np.linalg.norm(np.ptp(stand.form.corners, axis=0)[:2]))
        reach += 0.5 * float(np.linalg.norm(np.ptp(form.corners, axis=0)[:2]))
        angle = rng.uniform(-math.pi, math.pi)
        away = (reach + rng.uniform(0.02, 0.5)) * np.array([math.cos(angle), math.sin(angle)])
        return name, scale, Placed(form, upright(stand.matrix[:2, 3] + away, rng))

    def _distractor(
        self,
        crowded: bool,
        number: int,
        stand: Placed,
        support: FurnitureSupport,
        others: list[tuple[str, float, Placed]],
        rng: Random,
    ) -> tuple[str, float, Placed] | None:
        name, scale = pick(self._objects, rng), random_scale(OBJECT_SCALES[self.split], rng)
        form = self._form(name, scale)
        where = rng.random()
        T_world_region = stand.matrix @ support.region.matrix
        if crowded and (where < 0.6 or number == 0):
            poses = [random_rest(form, support.region.size, False, rng) for _ in range(6)]
            poses = [T_world_region @ pose for pose in poses if pose is not None]
        elif where < 0.75:
            poses = [self.on_other(form, others[0], rng)]
        elif where < 0.9:
            poses = [on_ground(form, stand, rng) for _ in range(3)]
        else:
            poses = [afloat(stand, rng) for _ in range(3)]
        obstacles = Obstacles([*(item for _, _, item in others), *solids(stand)])
        for pose in (pose for pose in poses if pose is not None):
            if (separations(form, pose[None], obstacles) > 0.5 * GAP).all():
                return name, scale, Placed(form, pose)
        return None

    def _form(self, name: str, scale: float) -> BodyGeometry:
        if (name, scale) not in self._scaled:
            self._scaled[name, scale] = (self._objects.get(name) or self._forms[name]).scaled(scale)
        return self._scaled[name, scale]


def touchable(scene: SampledScene, pose: Array, items: ItemOf) -> list[tuple[Item, Array]]:
    """Return what the body can touch from T_world_body, shape (4, 4), as the engine's items and
    their matrices.
    """
    box = Placed(scene.body, pose).box
    bodies = [
        scene.stand,
        *(item for item in scene.placed if gap(item.box, box) < DROP_NEIGHBOURS_M),
    ]
    return [(items(item.form), item.matrix) for item in bodies]


def some_hold_in_physics(scene: SampledScene, poses: Array, drops: Drops, items: ItemOf) -> bool:
    """Check whether the relation holds in physics at one of the poses T_world_body, shape (n, 4,
    4), the first TRIED of them that are clear of the other bodies.
    """
    verdicts = drop_verdicts(scene.situation(np.eye(4)), free(poses, scene)[:TRIED], drops, items)
    return any(verdict is Verdict.HOLDS for verdict in verdicts)


def free(poses: Array, scene: SampledScene) -> Array:
    """Select those of the poses T_world_body, shape (n, 4, 4), at which the body is clear of the
    other bodies.
    """
    if not len(poses) or not scene.others:
        return poses
    return poses[(separations(scene.body, poses, scene.obstacles) > GAP).all(axis=1)]


def resting(scene: SampledScene, rng: Random) -> Array:
    """Sample world poses at rest in the region, up to TRIES: any face, any yaw, the body or its
    centre inside.
    """
    region = scene.support.region
    poses = [
        scene.T_world_region @ pose
        for pose in (
            random_rest(scene.body, region.size, not region.hollow and rng.random() < 0.3, rng)
            for _ in range(TRIES)
        )
        if pose is not None
    ]
    return np.stack(poses) if poses else np.zeros((0, 4, 4))
