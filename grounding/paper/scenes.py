"""Random scenes laid out as the paper's public code lays them out: two pieces on the ground, bodies
upright, nothing else on the support in about half of the scenes.

Facts and figures: ../shared/PAPER_MODELS.md, section 1 (ethz-asl/predicate_learning, read and
measured, nothing copied). Shapes are our own.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.random import Generator as Random

from grounding.body_geometry import BodyGeometry
from grounding.mesh_folder import MeshFolder
from grounding.objects import object_templates
from grounding.oracles import ItemOf
from grounding.random_poses import pick, random_rest, solids, upright
from grounding.relation_scene import Placed, region_of
from grounding.scenes import GAP, TRIES, SampledScene
from grounding.separation import Obstacles, separations
from grounding.supports import FurnitureSupport, scaled_region
from tamp.errors import InputError
from tamp.geometric.loading.furniture import FURNITURE, FurnitureOptions
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import CONTACT_GAP, Body, Box, Part, Surface

OBJECT_COUNT = {"train": (5, 9), "test": (5, 15)}
"""Bodies in a scene, argument 1 among them, the two pieces of furniture not."""

OBJECT_SCALE = {"train": (0.5, 1.6), "test": (0.4, 1.8)}
SUPPORT_SCALE = {"train": (0.8, 1.2), "test": (0.6, 1.4)}
"""Factors, drawn uniformly."""

SUPPORT_AREA_M = 1.8
"""Furniture stands within this of the origin, along x and y, metres."""

FLOOR_AREA_M = 1.5
"""Bodies lie on the floor, and hang in the air, within this of the origin, metres."""

AIR_HEIGHTS_M = (0.2, 2.0)
"""Where bodies hang in the air, metres."""

SUPPORT_SIZES_M: Mapping[str, Mapping[str, tuple[float, float, float]]] = {
    "train": {
        "wide_cabinet": (0.50, 0.90, 0.80),
        "long_cabinet": (0.45, 1.00, 0.60),
        "block": (0.60, 0.60, 0.50),
    },
    "test": {"table": (1.50, 1.00, 0.63), "chest": (1.00, 0.70, 1.10)},
}
"""`on`: the pieces at scale 1. Those of training are estimates: iGibson's assets are not public."""

CONTAINER_SIZES_M = {"square_box": (0.50, 0.50, 0.15), "long_box": (0.60, 0.40, 0.16)}
"""`inside`: the boxes at scale 1, the same ones in training and test."""

STEADY_RAD = math.radians(8.0)
"""The tilt that a body withstands whose own frame says what is up; others are left out: the
published bodies lie in their files as they stand.
"""

CONTAINER_WALL_M = 0.02
"""Thickness of their walls and floor, metres."""


@lru_cache(maxsize=4)
def paper_supports(relation: str, split: str) -> Mapping[str, FurnitureSupport]:
    """Make the pieces for `on`, the boxes for `inside`, by name; deterministic."""
    if relation == "inside":
        made = {
            name: FURNITURE["open_box"].build(
                name, size, FurnitureOptions(thickness=CONTAINER_WALL_M)
            )
            for name, size in CONTAINER_SIZES_M.items()
        }
        bodies = {
            name: Body(name, built.parts, Pose(), False, cavities=built.cavities)
            for name, built in made.items()
        }
        return {
            name: FurnitureSupport(body.parts, region_of(body, body.cavities[0]))
            for name, body in bodies.items()
        }

    found: dict[str, FurnitureSupport] = {}
    for name, size in SUPPORT_SIZES_M[split].items():
        body = _table(name, size) if name == "table" else _solid(name, size)
        found[name] = FurnitureSupport(body.parts, region_of(body, body.surfaces[0]))
    return found


class PaperScenes:
    """Draws scenes of one relation and split; keep it, for its shapes are made once.

    Args:
        relation: "on" or "inside".
        split: "train" or "test".
        folder: Of one's own meshes.
    """

    def __init__(self, relation: str, split: str, folder: MeshFolder | None = None) -> None:
        self.relation, self.split, self.items = relation, split, ItemOf()
        forms = {
            name: BodyGeometry(parts) for name, parts in object_templates(split, folder).items()
        }
        self._objects = {name: form for name, form in forms.items() if stands_upright(form)}
        if not self._objects:
            raise InputError("none of the bodies stands as its own frame has it")
        self._supports = dict(paper_supports(relation, split))
        self._forms = {
            name: BodyGeometry(support.parts) for name, support in self._supports.items()
        }

    def draw(self, rng: Random, *, crowded: bool = True) -> SampledScene:
        """Sample a scene: with `crowded` one to all of the other bodies are on or in argument 0,
        the rest lies on the floor.
        """
        stand, other = self._furniture(rng)
        name, scale, placed = stand
        support = self._supports[name]
        support = replace(support, region=scaled_region(support.region, scale))
        T_world_region = placed.matrix @ support.region.matrix
        body_name, body_scale, body = self._object(rng)

        low, high = OBJECT_COUNT[self.split]
        count = int(rng.integers(low, high + 1)) - 1
        with_it = int(rng.integers(1, count + 1)) if crowded else 0
        others = [other]
        obstacles = [placed, other[2]]
        for number in range(count):
            there = number < with_it
            found = self._body_around(there, support, T_world_region, placed, obstacles, rng)
            if found is not None:
                others.append(found)
                obstacles.append(found[2])

        return SampledScene(
            (name, body_name),
            (scale, body_scale),
            placed,
            support,
            body,
            tuple(others),
            Obstacles([item for _, _, item in others]),
            T_world_region,
        )

    def resting(self, scene: SampledScene, rng: Random) -> Array:
        """Sample world poses at rest in the region, shape (n, 4, 4), n <= TRIES: `on` upright,
        `inside` turned by nothing or on any face.
        """
        found = [
            self._rest(scene.body, scene.support, scene.T_world_region, rng) for _ in range(TRIES)
        ]
        poses = [scene.T_world_region @ pose for pose in found if pose is not None]
        return np.stack(poses) if poses else np.zeros((0, 4, 4))

    def on_other(self, scene: SampledScene, rng: Random) -> Array | None:
        """Sample a pose at rest on or in the other piece."""
        name, scale, item = scene.others[0]
        support = self._supports[name]
        region = scaled_region(support.region, scale)
        T_world_region = item.matrix @ region.matrix
        pose = self._rest(scene.body, replace(support, region=region), T_world_region, rng)
        return None if pose is None else T_world_region @ pose

    def _furniture(
        self, rng: Random
    ) -> tuple[tuple[str, float, Placed], tuple[str, float, Placed]]:
        """Sample the two pieces, with replacement, apart from each other."""
        while True:
            pieces: list[tuple[str, float, Placed]] = []
            for _ in range(2):
                name = pick(self._supports, rng)
                scale = float(rng.uniform(*SUPPORT_SCALE[self.split]))
                at = rng.uniform(-SUPPORT_AREA_M, SUPPORT_AREA_M, 2)
                pieces.append(
                    (name, scale, Placed(self._forms[name].scaled(scale), upright(at, rng)))
                )

            first, second = (piece[2] for piece in pieces)
            if (separations(first.form, first.matrix[None], Obstacles([second])) > GAP).all():
                return pieces[0], pieces[1]

    def _object(self, rng: Random) -> tuple[str, float, BodyGeometry]:
        name, scale = pick(self._objects, rng), float(rng.uniform(*OBJECT_SCALE[self.split]))
        return name, scale, self._objects[name].scaled(scale)

    def _body_around(
        self,
        there: bool,
        support: FurnitureSupport,
        T_world_region: Array,
        stand: Placed,
        obstacles: list[Placed],
        rng: Random,
    ) -> tuple[str, float, Placed] | None:
        """Sample another body on or in argument 0, or on the floor; None where no try was free."""
        name, scale, form = self._object(rng)
        solid = Obstacles([*obstacles[1:], *solids(stand)])
        for _ in range(6):
            if there:
                local = self._rest(form, support, T_world_region, rng)
                pose = None if local is None else T_world_region @ local
            else:
                area = (2 * FLOOR_AREA_M, 2 * FLOOR_AREA_M, math.inf)
                pose = random_rest(form, area, False, rng)
            if pose is not None and (separations(form, pose[None], solid) > 0.5 * GAP).all():
                return name, scale, Placed(form, pose)
        return None

    def _rest(
        self, form: BodyGeometry, support: FurnitureSupport, T_world_region: Array, rng: Random
    ) -> Array | None:
        """Sample T_region_body: as it stands in its own frame with any yaw; in a container half of
        the time along the world's axes, as the published sampler has it, else on any stable face.
        """
        region = support.region
        if region.hollow and rng.random() < 0.5:
            return random_rest(form, region.size, False, rng)

        yaw = rng.uniform(-math.pi, math.pi)
        if region.hollow:
            yaw = -math.atan2(T_world_region[1, 0], T_world_region[0, 0])
        c, s = math.cos(yaw), math.sin(yaw)
        points = form.vertices @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        low, high = points.min(axis=0), points.max(axis=0)
        half = region.size[:2] / 2
        least, most = -half - low[:2], half - high[:2]
        if not region.hollow:
            least, most = _reachable(least, most, half, low, high)
        if (least > most).any() or high[2] - low[2] > region.size[2]:
            return None

        x, y = rng.uniform(least, most)
        return Pose.from_xyz_yaw(float(x), float(y), CONTACT_GAP - float(low[2]), yaw).matrix.copy()


def stands_upright(form: BodyGeometry) -> bool:
    """Check whether a body rests as it is in its own frame, and withstands a tilt of STEADY_RAD."""
    return any(
        face.angle >= STEADY_RAD and float(face.rotation[2, 2]) > 0.999 for face in form.faces
    )


def _reachable(
    least: Array, most: Array, half: Array, low: Array, high: Array
) -> tuple[Array, Array]:
    """Return the range of a body's x and y on a surface: along an axis where it is too large to lie
    on it whole, its middle is in the inner half.
    """
    middle = (low + high)[:2] / 2
    large = least > most
    least[large], most[large] = (-half / 2 - middle)[large], (half / 2 - middle)[large]
    return least, most


def _table(name: str, size: tuple[float, float, float]) -> Body:
    built = FURNITURE["table"].build(name, size, FurnitureOptions())
    return Body(name, built.parts, Pose(), False, surfaces=built.surfaces)


def _solid(name: str, size: tuple[float, float, float]) -> Body:
    part = Part(Box(size), Pose((0.0, 0.0, size[2] / 2)))
    top = Surface(name, name, Pose((0.0, 0.0, size[2])), size[:2])
    return Body(name, (part,), Pose(), False, surfaces=(top,))
