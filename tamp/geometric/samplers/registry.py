"""The registry of hand-made samplers: which generator serves which relation."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from tamp.geometric.samplers.placements import SurfacePlacements, UniformPlacements
from tamp.geometric.samplers.sampler import Generator

SAMPLERS: Mapping[str, Mapping[str, Callable[[], Generator]]] = {
    "on": {"surface": SurfacePlacements, "uniform": UniformPlacements},
    "inside": {"surface": SurfacePlacements, "uniform": UniformPlacements},
}
"""Relation to the generators that can serve it, the default first."""
