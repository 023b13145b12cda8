"""Trained groundings as the planner calls them: a scene and names in, world poses or a probability
out. Numpy only.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.random import Generator as Random

from grounding.model import RelationModel
from grounding.relation_scene import relation_scene_of
from tamp.geometric.samplers.sampler import Generator
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Scene
from tamp.geometric.stability.placement import SNAP_HEIGHT_M, Placement, placement_on
from tamp.geometric.stability.stable_poses import stable_faces_of


class Grounding:
    """A model behind the planner's Protocols of `tamp.geometric.samplers.sampler`.

    Args:
        model: What was trained.
    """

    def __init__(self, model: RelationModel) -> None:
        self.model = model

    def propose(
        self, scene: Scene, arguments: Sequence[str], count: int, rng: Random
    ) -> Sequence[Placement | Pose]:
        """Propose at most `count` world poses of body `arguments[0]` on or in `arguments[1]`, the
        best first.
        """
        poses = self.model.propose(relation_scene_of(scene, arguments), count, rng)
        return [Pose.from_matrix(pose) for pose in poses]

    def classify(self, scene: Scene, arguments: Sequence[str]) -> float:
        """Return the probability that the relation holds where the body is."""
        situation = relation_scene_of(scene, arguments)
        return float(
            np.clip(self.model.classify(situation, situation.body.matrix[None])[0], 0.0, 1.0)
        )


class Proposer:
    """A grounding that proposes and has no classifier yet.

    Args:
        grounding: What proposes.
        cannot_tell: Why it does not judge.
    """

    def __init__(self, grounding: Generator, cannot_tell: str) -> None:
        self._grounding, self.cannot_tell = grounding, cannot_tell

    def propose(
        self, scene: Scene, arguments: Sequence[str], count: int, rng: Random
    ) -> Sequence[Placement | Pose]:
        """Propose as the grounding does."""
        return self._grounding.propose(scene, arguments, count, rng)


def laid(
    scene: Scene, arguments: Sequence[str], rotation: Array, T_world_body: Array
) -> Placement | Pose:
    """Return the placement on a face near a pose; the pose itself where it is far above or below.

    Args:
        scene: The planner's.
        arguments: Names of the body and of the surface or cavity.
        rotation: What turns the body's face down, (3, 3), as `stable_faces` has it.
        T_world_body: Shape (4, 4).
    """
    pose, region = Pose.from_matrix(T_world_body), scene.region(arguments[1])
    stable = stable_faces_of(scene.bodies[arguments[0]])
    index = stable.index_of(rotation)
    if index is None:
        return pose

    T_region_body = scene.world_pose(region).inverse() @ pose
    if abs(T_region_body.position[2] - stable.ways[index].height) > SNAP_HEIGHT_M:
        return pose
    return placement_on(index, stable.ways[index], T_region_body, region.name)
