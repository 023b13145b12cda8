"""A relational model as the planner calls it: the face that it means is said, not guessed anew."""

from __future__ import annotations

from collections.abc import Sequence

from numpy.random import Generator as Random

from grounding.relation_scene import relation_scene_of
from grounding.relational.model import RelationalModel
from grounding.runtime import Grounding, laid
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Scene
from tamp.geometric.stability.placement import Placement


class PlacingSampler(Grounding):
    """A relational model in the planner: each of its poses stands on a face that it has chosen."""

    def __init__(self, model: RelationalModel) -> None:
        super().__init__(model)
        self._relational = model

    def propose(
        self, scene: Scene, arguments: Sequence[str], count: int, rng: Random
    ) -> list[Placement | Pose]:
        """Propose at most `count` placements of body `arguments[0]` on or in `arguments[1]`, the
        best first; a pose where the model means one that rests on nothing.
        """
        situation = relation_scene_of(scene, arguments)
        poses, rotations = self._relational.propose_on_faces(situation, count, rng)
        return [
            laid(scene, arguments, rotation, pose)
            for rotation, pose in zip(rotations, poses, strict=True)
        ]
