"""The interface of a trained grounding: numpy only, for one relation."""

from __future__ import annotations

from typing import Protocol

from numpy.random import Generator as Random

from grounding.relation_scene import RelationScene
from tamp.geometric.scene.pose import Array


class RelationModel(Protocol):
    """A generator and a classifier over situations. Poses are T_world_body of the body, shape (n,
    4, 4).
    """

    def propose(self, situation: RelationScene, count: int, rng: Random) -> Array:
        """Propose at most `count` poses, the best first, shape (n, 4, 4); none when it knows of no
        way.

        Args:
            situation: The body stands anywhere in it; only its form matters, and, to some models,
                where it starts.
            count: How many are wanted.
            rng: The only source of randomness.
        """
        ...

    def classify(self, situation: RelationScene, poses: Array) -> Array:
        """Return the probability that the relation holds with the body at each of the poses,
        shape (n,).

        Not a number from a model that is a generator only.

        Args:
            situation: The arguments and their surroundings.
            poses: T_world_body, shape (n, 4, 4).
        """
        ...
