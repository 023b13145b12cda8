"""Labelled scenes in the paper's layout: its sample types with its ranges (section III-E and the
public code), each one dropped in physics.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.random import Generator as Random

from grounding.demonstrations import POSITIVE, sticking_out
from grounding.mesh_folder import MeshFolder
from grounding.oracles import Verdict, drop_verdicts
from grounding.paper.edge_negatives import EDGE_NEGATIVES, is_with
from grounding.paper.oracle import in_place
from grounding.paper.scenes import AIR_HEIGHTS_M, FLOOR_AREA_M, PaperScenes
from grounding.random_poses import random_rest, random_turn
from grounding.scenes import LabelledScene, SampledScene, free, some_hold_in_physics, touchable
from grounding.separation import separations
from tamp.geometric.scene.pose import Array
from tamp.simulation.drops import Drops

SHIFT_M: Mapping[str, tuple[float, float]] = {"on": (0.10, 0.25), "inside": (0.05, 0.20)}
"""How far "above" and "sunken" are from rest, metres."""

MIDDLE_M = (0.45, 0.65)
"""How far "in the middle" of a support is below its surface, metres."""

FALL_M = 0.05
"""From how high a positive sample falls, metres."""

SETTLING_S = 5.0
"""How long it is given, seconds."""

CROWDED = ("among others", "colliding", "grazing")
"""Types with other bodies on or in argument 0; in all others those lie on the floor, but for
HALF_CROWDED.
"""

HALF_CROWDED = ("sticking out", "beside", "poking out")
"""Types of which half are as CROWDED."""

TOUCHING = ("colliding", "grazing")
"""Types that do not hold by what they touch, not by where they are."""


class PaperDemonstrations:
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
        self._relation, self._split, self._drops = relation, split, drops
        self._scenes = PaperScenes(relation, split, folder)

    def make(self, kind: str, rng: Random) -> LabelledScene:
        """Sample a scene of this kind; tries until one is found."""
        while True:
            made = self._try(kind, rng)
            if made is not None:
                return made

    def _try(self, kind: str, rng: Random) -> LabelledScene | None:
        positive = kind in POSITIVE
        crowded = kind in CROWDED or (kind in HALF_CROWDED and rng.random() < 0.5)
        scene = self._scenes.draw(rng, crowded=crowded)
        pose = self._positive(scene, rng) if positive else self._negative(kind, scene, rng)
        if pose is None:
            return None

        verdicts = drop_verdicts(scene.situation(pose), pose[None], self._drops, self._scenes.items)
        if (verdicts[0] is Verdict.HOLDS) != positive:
            return None
        # the published code labels `inside` by the test that it judges by, contacts left out
        labelled_so = self._relation == "inside" and kind not in TOUCHING
        if labelled_so and in_place(scene.situation(pose), pose[None])[0] != positive:
            return None

        feasible = positive or self._split == "train" or self._feasible(scene, rng)
        return scene.made(pose, kind, positive, feasible)

    def _positive(self, scene: SampledScene, rng: Random) -> Array | None:
        """Let the body fall onto or into argument 0 where nothing is in the way."""
        for pose in free(self._scenes.resting(scene, rng), scene)[:4]:
            self._drops.set_up(
                self._scenes.items(scene.body), touchable(scene, pose, self._scenes.items)
            )
            pose[2, 3] += FALL_M
            if all(contact.distance > 0.0 for contact in self._drops.contacts(pose)):
                return self._drops.drop(pose, SETTLING_S)
        return None

    def _feasible(self, scene: SampledScene, rng: Random) -> bool:
        poses = np.concatenate([self._scenes.resting(scene, rng) for _ in range(16)])
        return some_hold_in_physics(scene, poses, self._drops, self._scenes.items)

    # Samples that do not hold

    def _negative(self, kind: str, scene: SampledScene, rng: Random) -> Array | None:
        if kind in EDGE_NEGATIVES:
            return EDGE_NEGATIVES[kind](self._scenes, scene, rng)
        return _NEGATIVES[kind](self, scene, rng)

    def _floating(self, scene: SampledScene, rng: Random) -> Array | None:
        pose = random_turn(rng)
        pose[:2, 3] = rng.uniform(-FLOOR_AREA_M, FLOOR_AREA_M, 2)
        pose[2, 3] = rng.uniform(*AIR_HEIGHTS_M)
        return pose

    def _grounded(self, scene: SampledScene, rng: Random) -> Array | None:
        return random_rest(scene.body, (2 * FLOOR_AREA_M, 2 * FLOOR_AREA_M, np.inf), False, rng)

    def _lifted(self, scene: SampledScene, rng: Random) -> Array | None:
        return self._shifted(scene, rng.uniform(*SHIFT_M[self._relation]), rng)

    def _sunken(self, scene: SampledScene, rng: Random) -> Array | None:
        return self._shifted(scene, -rng.uniform(*SHIFT_M[self._relation]), rng)

    def _buried(self, scene: SampledScene, rng: Random) -> Array | None:
        return self._shifted(scene, -rng.uniform(*MIDDLE_M), rng)

    def _shifted(self, scene: SampledScene, by: float, rng: Random) -> Array | None:
        poses = self._scenes.resting(scene, rng)
        if not len(poses):
            return None
        poses[0, 2, 3] += by
        return poses[0]

    def _elsewhere(self, scene: SampledScene, rng: Random) -> Array | None:
        return self._scenes.on_other(scene, rng)

    def _colliding(self, scene: SampledScene, rng: Random) -> Array | None:
        """Put the body where another one is, moved by up to that one's mean half size."""
        poses = self._scenes.resting(scene, rng)
        with_it = [item for item in scene.placed[1:] if is_with(scene, item)]
        if not len(poses) or not with_it:
            return None

        other = with_it[int(rng.integers(len(with_it)))]
        pose, half = poses[0], float(np.ptp(other.form.corners, axis=0)[:2].mean()) / 2
        pose[:2, 3] = other.matrix[:2, 3] + rng.uniform(-half, half, 2)
        hit = (separations(scene.body, pose[None], scene.obstacles) < 0.0).any()
        return pose if hit else None

    def _sticking(self, scene: SampledScene, rng: Random) -> Array | None:
        return sticking_out(scene, rng)


_NEGATIVES: Mapping[str, Callable[[PaperDemonstrations, SampledScene, Random], Array | None]] = {
    "afloat": PaperDemonstrations._floating,
    "on the ground": PaperDemonstrations._grounded,
    "above": PaperDemonstrations._lifted,
    "sunken": PaperDemonstrations._sunken,
    "in the middle": PaperDemonstrations._buried,
    "on another support": PaperDemonstrations._elsewhere,
    "colliding": PaperDemonstrations._colliding,
    "sticking out": PaperDemonstrations._sticking,
}
