"""Data from exploration: poses proposed without knowing what holds, tried in physics, labelled by
what happened.

A scene is tried out in three steps. Poses are drawn, at random or by a grounding, and the body is
let go at each: it stays, or it falls and may come to rest where the relation holds after all. What
came to rest is then moved a little or a lot, or slid elsewhere, and tried again, which finds where
the relation ends. One trial of a scene is kept, success and failure in turn.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
from numpy.random import Generator as Random
from numpy.typing import NDArray

from grounding.chunks import RELATIONS, Progress, make_dataset
from grounding.dataset import Dataset
from grounding.mesh_folder import MeshFolder
from grounding.model import RelationModel
from grounding.oracles import Verdict, drop_verdicts
from grounding.random_poses import random_turn
from grounding.registry import load_model
from grounding.scenes import LabelledScene, SampledScene, SceneSampler, free
from grounding.supports import FurnitureSupport, household_supports
from grounding.weights import read_weights
from tamp.errors import InputError
from tamp.geometric.samplers.placements import BOX_GROWTH_SHARE
from tamp.geometric.scene.pose import Array, Pose
from tamp.simulation.drops import Drops
from tamp.simulation.engines import open_drops

STAYED, RESTED = "stayed", "came to rest"
"""How a relation can come to hold: the body stayed where it was put, or it fell and lies where it
holds too.
"""

KINDS = (STAYED, RESTED, *(verdict.value for verdict in Verdict if verdict is not Verdict.HOLDS))
"""The types of samples: the failures are those of `drop_verdicts`."""

DRAWN, MOVED, SLID = 12, 6, 8
"""Poses that are drawn in a scene, that one which was found is moved to, and that it is slid to."""

CROWDED = 0.8
"""The share of scenes with bodies on or in the support (the paper's share of the positive
samples).
"""

FARTHEST, STEEPEST = 0.3, 1.0
"""Metres and radians by which a pose is moved at most; all magnitudes down to a hundredth are as
likely.
"""

HARD = 0.75
"""The share of failures that are taken from poses near one that was found: they show where the
relation ends.
"""

SECONDS = 2.5
"""For how long a body may fall until it counts as come to rest."""


@dataclass(frozen=True)
class Exploration:
    """The specification of an exploration; a `grounding.chunks.ChunkJob`.

    Attributes:
        relation: "on" or "inside".
        count: Scenes, half of them positive.
        seed: Of all randomness.
        weights: Of a grounding that draws half of the poses; None for random ones alone.
        folder: Of one's own meshes.
    """

    relation: str
    count: int
    seed: int = 0
    weights: Path | None = None
    folder: MeshFolder | None = None

    @property
    def split(self) -> str:
        """Return "train": exploration is for training."""
        return "train"

    @property
    def supports(self) -> Mapping[str, FurnitureSupport]:
        """Return the pieces of furniture by name, those of the relation first."""
        return household_supports(self.relation, self.split)

    @property
    def kinds(self) -> tuple[str, ...]:
        """Return the outcomes: what can happen."""
        return KINDS

    @property
    def key(self) -> str:
        """Return the key of all but the count; of the weights what they are, not where."""
        digest = None if self.weights is None else sha256(self.weights.read_bytes()).hexdigest()
        return json.dumps(
            ["explored", self.relation, self.seed, self.folder and self.folder.key, digest]
        )

    def chunk(self, number: int, start: int, size: int) -> list[LabelledScene]:
        """Make the first `size` scenes of chunk `number`."""
        explorer = _explorer(self.relation, self.weights, self.folder)
        rng = np.random.default_rng([self.seed, RELATIONS.index(self.relation), number, len(KINDS)])
        return [explorer.make(row % 2 == 0, rng) for row in range(size)]

    def card(self, arrays: dict[str, NDArray[Any]]) -> dict[str, Any]:
        """Return the card's entries: how often a body was let go, and who drew."""
        drawn = None if self.weights is None else dict(read_weights(self.weights).card)
        return {"trials": int(arrays["trials"].sum()), "drawn by": drawn or "random"}


def explore(
    job: Exploration,
    out: Path,
    workers: int | None = None,
    progress: Progress = lambda done, total: None,
) -> Dataset:
    """Make a data set by exploration and write it, see `make_dataset`.

    Raises:
        InputError: As there; or the weights are missing, damaged or of another relation.
    """
    if job.weights is not None:
        load_model(job.weights)
        relation = read_weights(job.weights).card.get("relation")
        if relation != job.relation:
            raise InputError(
                f"these are weights for '{relation}', not '{job.relation}'", file=job.weights
            )
    return make_dataset(job, out, workers, progress)


class Explorer:
    """Tries poses out; keep it, for its shapes are made once.

    Args:
        scenes: Where it plays.
        drops: The engine.
        model: What draws half of the poses; None for random ones alone.
    """

    def __init__(
        self, scenes: SceneSampler, drops: Drops, model: RelationModel | None = None
    ) -> None:
        self._scenes, self._drops, self._model = scenes, drops, model

    def make(self, holds: bool, rng: Random) -> LabelledScene:
        """Make a scene where the relation came to hold, or where it did not; explores until there
        is one.
        """
        trials, near = 0, not holds and rng.random() < HARD
        while True:
            scene = self._scenes.draw(rng, crowded=rng.random() < CROWDED)
            tried, count = self.explore(scene, rng)
            trials += count
            kept = [
                one
                for one in tried
                if (one[0] in (STAYED, RESTED)) == holds and (one[2] or not near)
            ]
            kinds = sorted({one[0] for one in kept})
            if kinds and not holds:  # a rare way to fail is kept as often as a frequent one
                kind = kinds[int(rng.integers(len(kinds)))]
                kept = [one for one in kept if one[0] == kind]
            if kept:
                kind, pose, _ = kept[int(rng.integers(len(kept)))]
                return scene.made(pose, kind, holds, True, {"trials": trials})

    def explore(
        self, scene: SampledScene, rng: Random
    ) -> tuple[list[tuple[str, Array, bool]], int]:
        """Explore a scene: return what happened in it, and how often the body was let go.

        Returns:
            Kinds, poses T_world_body, and whether it was tried because of one that was found; and
            the number.
        """
        drawn = np.stack([uniform(scene, rng) for _ in range(DRAWN)])
        if self._model is not None:
            proposed = self._model.propose(scene.situation(drawn[0]), DRAWN // 2, rng)
            drawn[: len(proposed)] = [moved(pose, rng) for pose in proposed]
        tried = [(kind, pose, False) for kind, pose in self._try(scene, drawn)]
        found = [pose for kind, pose, _ in tried if kind in (STAYED, RESTED)]
        trials = len(drawn)
        if found:
            chosen = found[int(rng.integers(len(found)))]
            poses = [moved(chosen, rng) for _ in range(MOVED)] + [
                slid(scene, chosen, rng) for _ in range(SLID)
            ]
            tried += [(kind, pose, True) for kind, pose in self._try(scene, np.stack(poses))]
            trials += len(poses)
        return tried, trials

    def _try(self, scene: SampledScene, poses: Array) -> list[tuple[str, Array]]:
        """Let the body go at each pose: the failures, and where it came to rest so that the
        relation holds.

        What came to rest against other bodies is neither: it stays, but is no place to put
        something.
        """
        situation, items = scene.situation(poses[0]), self._scenes.items
        verdicts = drop_verdicts(situation, poses, self._drops, items)
        tried = [(verdict.value, pose) for verdict, pose in zip(verdicts, poses, strict=True)]
        # what is lower than the region, or in another body, cannot come to rest in it
        falling = (
            Verdict.HOLDS,
            Verdict.TOO_HIGH,
            Verdict.OUTSIDE,
            Verdict.OVERLAPPING,
            Verdict.TIPS,
        )
        rests, stayed = [], []
        self._drops.set_up(
            items(scene.body),
            [(items(one.form), one.matrix) for one in (scene.stand, *situation.others)],
        )

        for verdict, pose in zip(verdicts, poses, strict=True):
            if verdict in falling and all(
                one.distance > -0.0005 for one in self._drops.contacts(pose)
            ):
                rests.append(self._drops.drop(pose, SECONDS))
                stayed.append(verdict is Verdict.HOLDS)

        found: list[tuple[str, Array]] = []
        after = drop_verdicts(situation, np.stack(rests), self._drops, items) if rests else []
        for verdict, pose, there in zip(after, rests, stayed, strict=True):
            if verdict is Verdict.HOLDS and len(free(pose[None], scene)):
                found.append((STAYED if there else RESTED, pose))

        failed = [one for one in tried if one[0] != Verdict.HOLDS]
        return failed + found


def uniform(scene: SampledScene, rng: Random) -> Array:
    """Sample T_world_body uniformly: anywhere in the support's box, grown by half its largest half
    extent, turned in any way; (4, 4).
    """
    low, high = scene.support.region.box
    margin = BOX_GROWTH_SHARE * float((high - low).max()) / 2
    pose = random_turn(rng)
    pose[:3, 3] = rng.uniform(low - margin, high + margin)
    return scene.stand.matrix @ pose


def slid(scene: SampledScene, pose: Array, rng: Random) -> Array:
    """Sample T_world_body anywhere in the support's box, as high as before and tilted alike, turned
    by any angle; (4, 4).
    """
    low, high = scene.support.region.box
    place = scene.stand.matrix[:3, :3] @ rng.uniform(low, high) + scene.stand.matrix[:3, 3]
    result = Pose.from_xyz_yaw(0.0, 0.0, 0.0, rng.uniform(-math.pi, math.pi)).matrix @ pose
    result[:3, 3] = (*place[:2], pose[2, 3])
    return result


def moved(pose: Array, rng: Random) -> Array:
    """Perturb T_world_body by FARTHEST and STEEPEST at most; half of them only sideways, half of
    them only about the vertical, by any angle. Shape (4, 4).
    """
    result = pose.copy()
    far, steep = (most * 10.0 ** -rng.uniform(0.0, 2.0) for most in (FARTHEST, STEEPEST))
    step, axis = rng.normal(size=3), rng.normal(size=3)
    if rng.random() < 0.5:
        step[2] = 0.0
    if rng.random() < 0.5:
        steep, axis = rng.uniform(-math.pi, math.pi), np.array([0.0, 0.0, 1.0])
    x, y, z = (float(v) for v in math.sin(steep / 2) * axis / np.linalg.norm(axis))
    turn = Pose((0.0, 0.0, 0.0), (x, y, z, math.cos(steep / 2))).matrix
    result[:3, :3] = turn[:3, :3] @ pose[:3, :3]
    result[:3, 3] += far * step / np.linalg.norm(step)
    return result


@lru_cache(maxsize=2)
def _explorer(relation: str, weights: Path | None, folder: MeshFolder | None) -> Explorer:
    model = None if weights is None else load_model(weights)
    return Explorer(SceneSampler(relation, "train", folder), open_drops(), model)
