"""A learned relation as the planner calls it: names and a scene in, poses or a probability out."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.random import Generator as Random

from grounding.body_geometry import geometry_of
from grounding.relation_scene import Placed
from grounding.relations.committee import Committee
from grounding.relations.files import read_learned
from grounding.relations.generator import ANY_WAY, PoseGenerator
from grounding.relations.situation import Situations, place_row, shape_of, situation_of
from grounding.separation import Obstacles, separations
from grounding.weights import Weights
from tamp.errors import InputError
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Scene

NEAR = 0.8
"""Bodies whose middles are farther from all proposals' furniture than this are left out, metres."""

CLEAR = 0.003
"""Metres of air to other bodies that a proposal should have."""


class LearnedRelation:
    """A relation learned from a few demonstrations, behind the planner's Protocols.

    Args:
        weights: As `grounding.relations.files.weights_of` makes them.

    Raises:
        InputError: They are no such weights.
    """

    def __init__(self, weights: Weights) -> None:
        self.kinds, self.committee, self.generator = read_learned(weights)
        self._committee: Committee = self.committee
        self._proposes: PoseGenerator = self.generator

    def classify(self, scene: Scene, arguments: Sequence[str]) -> float:
        """Return the probability that the relation holds where the bodies are.

        Raises:
            InputError: Another number of arguments, or one that is not there.
        """
        count = len(self.kinds)
        if len(arguments) != count:
            raise InputError(f"the relation has {count} arguments, not {len(arguments)}")
        return float(self._committee.predict(situation_of(scene, arguments))[0])

    def propose(
        self, scene: Scene, arguments: Sequence[str], count: int, rng: Random
    ) -> list[Pose]:
        """Propose at most `count` world poses of body `arguments[0]`, the best first; a place
        behind the arguments says on what.
        """
        names, body = list(arguments[: len(self.kinds)]), scene.bodies[arguments[0]]
        if len(names) < len(self.kinds):
            raise InputError(f"the relation has {len(self.kinds)} arguments, not {len(names)}")
        situation = situation_of(scene, names)
        places = [name for name in arguments[len(names) :] if _is_place(scene, name)]
        under = ""
        if places:
            situation.support[0] = _row(scene, places[0])
            place = scene.surfaces.get(places[0]) or scene.cavities[places[0]]
            under = place.body if scene.bodies[place.body].movable else ""
        elif len(names) == 1:
            situation.support[0] = _any_place(scene, rng)

        steady = np.array([-face.rotation[2] for face in geometry_of(body.parts).faces])
        blocked = _blocked(scene, [*names, under], situation)
        R, p = self._proposes.propose(
            situation, count, rng, steady if len(steady) else ANY_WAY, blocked
        )
        centre = shape_of(body.parts).centre
        matrices = np.tile(np.eye(4), (len(R), 1, 1))
        matrices[:, :3, :3] = R
        matrices[:, :3, 3] = p - R @ centre
        return [Pose.from_matrix(matrix) for matrix in matrices]


def _is_place(scene: Scene, name: str) -> bool:
    return name in scene.surfaces or name in scene.cavities


def _row(scene: Scene, name: str) -> tuple[float, ...]:
    place = scene.surfaces.get(name) or scene.cavities[name]
    return place_row(scene.bodies[place.body], place)


def _any_place(scene: Scene, rng: Random) -> tuple[float, ...]:
    """Return one of the fixed surfaces, large ones more often."""
    rows = [
        place_row(scene.bodies[place.body], place)
        for place in scene.surfaces.values()
        if not scene.bodies[place.body].movable
    ]
    if not rows:
        return (0.0, 0.0, 0.0, 0.0, 2.0, 2.0)
    area = np.array([row[4] * row[5] for row in rows])
    return rows[int(rng.choice(len(rows), p=area / area.sum()))]


def _blocked(
    scene: Scene, names: Sequence[str], situation: Situations
) -> Callable[[Array, Array], Array] | None:
    """Return what says by how far places are in bodies that are not named, of which the first is
    placed.
    """
    top, _, x, y = situation.support[0, :4]
    reach = NEAR + float(np.hypot(*situation.support[0, 4:]))
    around: list[Placed] = []
    for body in scene.bodies.values():
        matrix = body.pose.matrix
        if body.name in names or np.hypot(matrix[0, 3] - x, matrix[1, 3] - y) > reach:
            continue
        form = geometry_of(body.parts)
        if body.movable:
            around.append(Placed(form, matrix))
            continue
        around += [
            one for piece in form.pieces if (one := Placed(piece, matrix)).box[1, 2] > top + 0.002
        ]
    if not around:
        return None
    obstacles, form = Obstacles(around), geometry_of(scene.bodies[names[0]].parts)
    centre = shape_of(scene.bodies[names[0]].parts).centre

    def blocked(R: Array, p: Array) -> Array:
        poses = np.tile(np.eye(4), (len(R), 1, 1))
        poses[:, :3, :3], poses[:, :3, 3] = R, p - R @ centre
        return np.maximum(CLEAR - separations(form, poses, obstacles), 0.0).sum(axis=1)

    return blocked
