"""The learned classifier's opinion of the scene on the page, for active learning: where it is
wrong, a label teaches most.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from grounding.demonstrate.scene import Stage
from grounding.demonstrate.use import Uses
from grounding.registry import load_grounding
from grounding.relations.grounding import LearnedRelation
from grounding.runtime import Grounding, Proposer
from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose


class Opinion:
    """Loads a learned relation, again when its file has changed, and asks its classifier."""

    def __init__(self) -> None:
        self._key: tuple[object, ...] = ()
        self._learned: Grounding | LearnedRelation | None = None

    def of(self, uses: Uses, stage: Stage, poses: Mapping[str, Pose]) -> float | None:
        """Return the probability that the relation holds of a scene's arguments with bodies at
        other poses T_world_body; None where nothing has been learned, or it cannot tell.
        """
        try:
            state = uses.weights.stat()
        except OSError:
            return None
        key = (uses.weights, state.st_mtime_ns, state.st_size)
        if key != self._key:
            self._key, self._learned = key, self._load(uses)
        if self._learned is None:
            return None

        try:
            chance = float(self._learned.classify(stage.moved(poses).scene, stage.arguments))
        except InputError:  # a body below the floor; another number of arguments
            return None
        return chance if math.isfinite(chance) else None

    @staticmethod
    def _load(uses: Uses) -> Grounding | LearnedRelation | None:
        try:
            learned = load_grounding(uses.weights)
        except InputError:
            return None
        return None if isinstance(learned, Proposer) else learned
