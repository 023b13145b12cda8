"""Candidates: scenes in which a relation is proposed, or nearly so, settled in physics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator as Random

from grounding.body_geometry import geometry_of
from grounding.relation_scene import Placed
from grounding.relations.demonstration_text import BodyEntry
from grounding.relations.grounding import LearnedRelation
from grounding.relations.scenes import DemonstratedBodies, loaded, made, otherwise
from grounding.separation import Obstacles, separations
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Scene
from tamp.simulation.drops import Drops, Item
from tamp.simulation.engines import open_drops

SECONDS = 1.5
"""For how long a body may fall."""

MOVED, TURNED = 0.01, 0.2
"""Metres and radians by which what stays may move."""

ABOVE = 0.3
"""Metres above what is below from where a body that was put elsewhere is let down, at most."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """A scene with argument 0 where it came to rest.

    Attributes:
        bodies: As a demonstration file has them.
        scene: The same.
        arguments: Of the relation.
        proposed: Whether the generator put it there.
        stayed: Whether it stayed where it was put.
        probability: That the relation holds where it lies, by the classifier.
    """

    bodies: Mapping[str, BodyEntry]
    scene: Scene
    arguments: tuple[str, ...]
    proposed: bool
    stayed: bool
    probability: float


def candidates(
    relation: LearnedRelation, examples: Sequence[DemonstratedBodies], count: int, rng: Random,
    near: float = 0.5,
) -> list[Candidate]:  # fmt: skip
    """Make scenes and put argument 0 where the relation is proposed, or close to that.

    Args:
        relation: What proposes and judges.
        examples: Whose bodies the scenes are made of.
        count: How many.
        rng: The only source of randomness.
        near: Share of those that are changed after they were proposed.
    """
    found: list[Candidate] = []
    with open_drops() as drops:
        for row in range(count):
            example = examples[row % len(examples)]
            bodies = made(example, rng)
            scene, name = loaded(bodies, example.arguments), example.arguments[0]
            poses = relation.propose(scene, example.arguments, 1, rng)
            if not poses:
                continue
            pose, changed = poses[0], bool(rng.random() < near)
            if changed:
                pose = _lifted(scene, name, otherwise(pose, rng))
            at_rest = _at_rest(drops, scene, name, pose)
            after = {**bodies, name: replace(bodies[name], pose=at_rest)}
            there = loaded(after, example.arguments)
            likely = relation.classify(there, example.arguments)
            stayed = not changed and _same(pose, at_rest)
            found.append(Candidate(after, there, example.arguments, not changed, stayed, likely))
    return found


def _at_rest(drops: Drops, scene: Scene, name: str, pose: Pose) -> Pose:
    """Let a body go at a pose, the others stand still."""
    others = [
        (Item(body.parts, body.mass, body.friction), body.pose.matrix)
        for body in scene.bodies.values()
        if body.name != name
    ]
    body = scene.bodies[name]
    drops.set_up(Item(body.parts, body.mass, body.friction), others)
    return _on_floor(body, Pose.from_matrix(drops.drop(pose.matrix, SECONDS)))


def _on_floor(body: Body, pose: Pose) -> Pose:
    """Lift a pose out of the floor, into which an engine lets a body sink that fell onto it."""
    sunk = max(0.0, -float(bounds(body.parts, pose)[0][2]))
    return replace(pose, position=(*pose.position[:2], pose.position[2] + sunk))


def _lifted(scene: Scene, name: str, pose: Pose) -> Pose:
    """Lift a pose out of what it would lie in: to just above the other bodies there."""
    form = geometry_of(scene.bodies[name].parts)
    around = [
        Placed(piece, body.pose.matrix)
        for body in scene.bodies.values()
        if body.name != name
        for piece in geometry_of(body.parts).pieces
    ]
    matrices = np.tile(pose.matrix, (31, 1, 1))
    matrices[:, 2, 3] += np.linspace(0.0, ABOVE, 31)
    clear = separations(form, matrices, Obstacles(around)).min(axis=1, initial=1.0) > -0.001
    return Pose.from_matrix(matrices[int(np.argmax(clear))])


def _same(one: Pose, other: Pose) -> bool:
    apart = float(np.linalg.norm(np.subtract(one.position, other.position)))
    turned = float(np.arccos(np.clip((np.trace(one.rotation.T @ other.rotation) - 1) / 2, -1, 1)))
    return apart < MOVED and turned < TURNED
