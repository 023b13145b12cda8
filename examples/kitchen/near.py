"""What `near` means: the middles of two bodies are within 20 cm of each other, beside each other at the same height."""

import math
from collections.abc import Sequence

from numpy.random import Generator

import tamp

FAR = 0.2


class Near:
    """A grounding in plain Python: the two methods are all that the planner asks for."""

    def classify(self, scene: tamp.Scene, arguments: Sequence[str]) -> float:
        """1 or 0: whether the relation holds where the bodies are."""
        (x, y, _), (x2, y2, _) = (scene.bodies[name].pose.position for name in arguments)
        return float(math.hypot(x - x2, y - y2) <= FAR)

    def propose(self, scene: tamp.Scene, arguments: Sequence[str], count: int, rng: Generator) -> list[tamp.Pose]:
        """Poses of the first body around the second one; the planner puts them to rest on what is below."""
        body, other, *_ = arguments  # and the surface, which sample-near has among its inputs, too
        if body == other:
            return []
        (x, y, z), turn = scene.bodies[other].pose.position, scene.bodies[body].pose.quaternion
        poses: list[tamp.Pose] = []
        for _ in range(count):
            angle, far = rng.uniform(-math.pi, math.pi), rng.uniform(0.5 * FAR, FAR)
            poses.append(tamp.Pose((x + far * math.cos(angle), y + far * math.sin(angle), z), turn))
        return poses


grounding = Near()
