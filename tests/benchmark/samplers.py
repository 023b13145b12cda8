"""Samplers that a benchmark is asked for: some have no weights, one is a Python file."""

from __future__ import annotations

from tamp.errors import InputError
from tamp.geometric.samplers.placements import SurfacePlacements


def without_weights() -> SurfacePlacements:
    raise InputError("no such weight file")


KNOWN = {
    "on": {"surface": SurfacePlacements, "flow": SurfacePlacements, "mlp-bb": without_weights},
    "inside": {"surface": SurfacePlacements, "flow": without_weights},
}

MINE = """
class Middle:
    def propose(self, scene, arguments, count, rng):
        return []
grounding = Middle()
"""
