"""The blind ceiling: what an ideal generator that does not look at the surroundings reaches on a
data set.

Beside each success rate it says how much of what is missing is the generator's fault, and how much
the chance of meeting another body, for one that spreads over the region as demonstrations do. It is
no bound of what a blind network could be taught: bodies are rare in the corners, and one that goes
there alone does better (`CornerModel`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from weakref import WeakKeyDictionary

import numpy as np
from numpy.random import Generator as Random
from numpy.typing import NDArray

from grounding.body_geometry import BodyGeometry
from grounding.dataset import Dataset
from grounding.oracles import paper_oracle
from grounding.paper.oracle import published_oracle
from grounding.relation_scene import RelationScene
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import CONTACT_GAP
from tamp.geometric.stability.placement import resting_pose

SPREADS = (0.5, 0.7, 0.9)
"""Shares of a region's sides that are used; nearer to its middle a body is rarely outside, farther
from it rarely where another one is.
"""

FACES = ("upright", "any", "flattest")
"""Which side is down: as in the body's own frame, any stable one by its angle, the one that leaves
the body lowest.
"""


INSET_M = 0.001
"""How far within the limits a body at a corner is, metres."""


@dataclass(frozen=True)
class BlindModel:
    """An ideal generator that sees the two arguments only: exact height, a stable face, uniform
    over the middle of the region. It is no classifier.

    Attributes:
        face: One of FACES.
        spread: The share of the region's sides that is used.
    """

    face: str
    spread: float

    def propose(self, situation: RelationScene, count: int, rng: Random) -> Array:
        """Propose `count` poses T_world_body, shape (count, 4, 4)."""
        poses = [self._pose(situation, rng) for _ in range(count)]
        return situation.T_world_region @ np.stack(poses)

    def classify(self, situation: RelationScene, poses: Array) -> Array:
        """Return not-a-number, shape (n,): it cannot tell."""
        return np.full(len(poses), math.nan)

    def _pose(self, situation: RelationScene, rng: Random) -> Array:
        form, yaw = situation.body.form, rng.uniform(-math.pi, math.pi)
        pose = _at_rest(form, self.face, yaw, rng)
        points = form.vertices @ pose[:3, :3].T
        low, high = points.min(axis=0)[:2], points.max(axis=0)[:2]

        half = situation.region.size[:2] / 2
        free = np.maximum(half - (high - low) / 2, 0.0) if situation.region.hollow else half
        pose[:2, 3] = rng.uniform(-1, 1, 2) * self.spread * free - (low + high) / 2
        return pose


@dataclass(frozen=True)
class CornerModel:
    """An ideal generator that sees the two arguments only, and goes to the region's corners, where
    other bodies are rarest. It is no classifier.

    `on`: upright, the middle of the own box a millimetre within a corner of the surface. `inside`:
    the own box's shortest edge up, flush with a corner of the container's box.
    """

    def propose(self, situation: RelationScene, count: int, rng: Random) -> Array:
        """Propose `count` poses T_world_body, shape (count, 4, 4)."""
        low, high = situation.body.form.corners
        region, turn = situation.region, np.eye(3)
        half = region.size[:2] / 2 - INSET_M
        if region.hollow:
            turn = _lying(high - low, half)
            half = np.ptp(region.box[:, :2], axis=0) / 2 - INSET_M
        middle, reach = turn @ (low + high) / 2, np.abs(turn) @ (high - low) / 2
        if region.hollow:
            half = np.maximum(half - reach[:2], 0.0)

        poses = np.tile(np.eye(4), (count, 1, 1))
        poses[:, :3, :3] = turn
        poses[:, :2, 3] = rng.choice([-1.0, 1.0], (count, 2)) * half - middle[:2]
        poses[:, 2, 3] = reach[2] - middle[2] + CONTACT_GAP
        return situation.T_world_region @ poses

    def classify(self, situation: RelationScene, poses: Array) -> Array:
        """Return not-a-number, shape (n,): it cannot tell."""
        return np.full(len(poses), math.nan)


@dataclass(frozen=True)
class BlindCeiling:
    """The best of the blind generators, for each oracle.

    Attributes:
        mca: By `grounding.oracles.paper_oracle`.
        published: By `published_oracle`.
        corner: Of `CornerModel` by `published_oracle`.
    """

    mca: float
    published: float
    corner: float


def blind_ceiling(
    data: Dataset, indices: Sequence[int] | NDArray[np.intp], draws: int, seed: int
) -> BlindCeiling:
    """Compute the share of poses that hold, of the best blind generator on these scenes of a data
    set.

    Args:
        data: Test scenes.
        indices: Which of them.
        draws: Poses a scene.
        seed: Of the draws.
    """
    key = (tuple(int(index) for index in indices), draws, seed)
    ceilings = _CEILINGS.setdefault(data, {})
    if key not in ceilings:
        ceilings[key] = _ceiling(data, key[0], draws, seed)
    return ceilings[key]


_CEILINGS: WeakKeyDictionary[Dataset, dict[tuple[tuple[int, ...], int, int], BlindCeiling]] = (
    WeakKeyDictionary()
)
"""Ceilings by scenes, draws and seed: many models are judged on the same ones."""


def _ceiling(data: Dataset, indices: tuple[int, ...], draws: int, seed: int) -> BlindCeiling:
    models = [BlindModel(face, spread) for face, spread in product(FACES, SPREADS)]
    corner, corner_model = 0.0, CornerModel()
    found = np.zeros((len(models), 2))
    rng = np.random.default_rng(seed)
    for index in indices:
        situation = data[index].situation
        for row, model in enumerate(models):
            poses = model.propose(situation, draws, rng)
            found[row, 0] += paper_oracle(situation, poses).mean()
            found[row, 1] += published_oracle(situation, poses).mean()
    for index in indices:
        situation = data[index].situation
        poses = corner_model.propose(situation, draws, rng)
        corner += float(published_oracle(situation, poses).mean())

    mca, published = (found / len(indices)).max(axis=0)
    return BlindCeiling(float(mca), float(published), corner / len(indices))


def _lying(size: Array, half: Array) -> Array:
    """Return the rotation, shape (3, 3), that brings a box's shortest edge up and its longest edge
    along the longer side of a rectangle of half edges (2,).
    """
    rows = np.argsort(-size)
    if half[0] < half[1]:
        rows[:2] = rows[1::-1]
    turn = np.eye(3)[rows]
    turn[2] *= np.linalg.det(turn)
    return turn


def _at_rest(form: BodyGeometry, which: str, yaw: float, rng: Random) -> Array:
    """Return a pose T_region_body at rest, its x and y at no particular place."""
    faces = form.faces
    if which == "upright" or not faces:
        pose = Pose.from_xyz_yaw(0.0, 0.0, 0.0, yaw).matrix.copy()
        pose[2, 3] = CONTACT_GAP - float(form.vertices[:, 2].min())
        return pose

    if which == "flattest":
        face = min(faces, key=lambda face: face.extent)
    else:
        weights = np.array([face.angle for face in faces])
        face = faces[int(rng.choice(len(faces), p=weights / weights.sum()))]
    return resting_pose(face, yaw, 0.0, 0.0).matrix.copy()
