"""The interfaces that ground a relation such as `on`: a generator that proposes poses, and a
classifier that judges them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, runtime_checkable

from numpy.random import Generator as Random

from tamp.geometric.scene.classifier import Classifier as Classifier
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Scene
from tamp.geometric.stability.placement import Placement


@runtime_checkable
class Generator(Protocol):
    """Proposes poses of a relation's first argument that may make the relation hold.

    What it proposes is advice: the stream that asks certifies each that rests, or rejects it. One
    that is not hand-made shares the work with the hand-made one (`mixture`), and is asked no more
    in a run in which it raises, repeats itself, proposes nothing of use, or takes more than a tenth
    of the time.
    """

    def propose(
        self, scene: Scene, arguments: Sequence[str], count: int, rng: Random
    ) -> Sequence[Pose | Placement]:
        """Propose at most `count` placements or world poses of body `arguments[0]`, the best first;
        an empty list when there will be none.

        A pose is laid onto the face and the region that it is nearest to; a placement says which.

        Args:
            scene: The scene at that step of the plan: other bodies where they will be, the proposed
                one, which is in the hand, at its start for its shape's sake.
            arguments: The relation's arguments: (body, surface) or (body, cavity).
            count: How many are wanted.
            rng: The only source of randomness.
        """
        ...
