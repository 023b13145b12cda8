"""Data sets of demonstrations: the paper's sample types in their shares, half of the scenes
positive.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grounding.chunks import Progress, make_dataset
from grounding.dataset import Dataset
from grounding.demonstrations import KINDS, POSITIVE, DemonstrationGenerator
from grounding.mesh_folder import MeshFolder
from grounding.objects import SPLITS
from grounding.paper.demonstrations import PaperDemonstrations
from grounding.paper.edge_negatives import EDGE_KINDS
from grounding.paper.scenes import paper_supports
from grounding.scenes import LabelledScene
from grounding.supports import FurnitureSupport, household_supports
from tamp.errors import InputError
from tamp.simulation.engines import open_drops

LAYOUTS = {"household": DemonstrationGenerator, "paper": PaperDemonstrations}
"""Who lays scenes out: densely, on small and odd pieces, any face down; or as the paper's code."""


@dataclass(frozen=True)
class Job:
    """The specification of scenes to generate; a `grounding.chunks.ChunkJob`.

    Attributes:
        relation: "on" or "inside".
        split: "train" or "test"; they share no object and no support.
        count: Scenes, half of them positive.
        seed: Of all randomness.
        folder: Of one's own meshes.
        layout: One of LAYOUTS.
        edges: Whether a share of the negatives is close by the limits, see EDGE_KINDS; of the
            layout "paper" only.
    """

    relation: str
    split: str
    count: int
    seed: int = 0
    folder: MeshFolder | None = None
    layout: str = "household"
    edges: bool = False

    @property
    def shares(self) -> Mapping[str, float]:
        """Return the share of each type of sample."""
        return (EDGE_KINDS if self.edges else KINDS)[self.relation]

    @property
    def kinds(self) -> tuple[str, ...]:
        """Return the relation's types of samples."""
        return tuple(self.shares)

    @property
    def key(self) -> str:
        """Return the key of all but the count."""
        parts = [self.relation, self.split, self.seed, self.folder and self.folder.key]
        parts += [] if self.layout == "household" else [self.layout]
        return json.dumps(parts + ["edges"] * self.edges)

    @property
    def supports(self) -> Mapping[str, FurnitureSupport]:
        """Return the pieces of furniture by name, those of the relation first."""
        if self.layout == "paper":
            return paper_supports(self.relation, self.split)
        return household_supports(self.relation, self.split)

    def chunk(self, number: int, start: int, size: int) -> list[LabelledScene]:
        """Make the first `size` scenes of chunk `number`."""
        maker = _maker(self.relation, self.split, self.folder, self.layout)
        kinds = kinds_of(self.shares, start + size)[start:]
        rng = np.random.default_rng(
            [self.seed, SPLITS.index(self.split), tuple(KINDS).index(self.relation), number]
        )
        return [maker.make(kind, rng) for kind in kinds]

    def card(self, arrays: dict[str, NDArray[Any]]) -> dict[str, Any]:
        """Return the card's own entries."""
        return {"layout": self.layout} | ({"edges": True} if self.edges else {})


def generate(
    job: Job,
    out: Path,
    workers: int | None = None,
    progress: Progress = lambda done, total: None,
    ray: str | None = None,
) -> Dataset:
    """Make a data set of demonstrations and write it, see `make_dataset`.

    Raises:
        InputError: As there, or an unknown layout, or one without negatives at the edges.
    """
    if job.layout not in LAYOUTS:
        raise InputError(f"unknown layout '{job.layout}'", found=job.layout, choices=[*LAYOUTS])
    if job.edges and job.layout != "paper":
        raise InputError(f"layout '{job.layout}' has no --edges; only 'paper' has")
    return make_dataset(job, out, workers, progress, ray)


def kinds_of(shares: Mapping[str, float], count: int) -> list[str]:
    """Return the type of each of `count` scenes: their shares hold in every run of 40, positives
    and negatives in turn.
    """
    sides = [
        [kind for kind in shares if (kind in POSITIVE) == positive] for positive in (True, False)
    ]
    owed = dict.fromkeys(shares, 0.0)
    chosen: list[str] = []
    for number in range(count):
        side = sides[number % 2]
        for kind in side:
            owed[kind] += 2 * shares[kind]
        kind = max(side, key=lambda kind: (round(owed[kind], 9), -side.index(kind)))
        owed[kind] -= 1
        chosen.append(kind)
    return chosen


@lru_cache(maxsize=2)
def _maker(
    relation: str, split: str, folder: MeshFolder | None, layout: str
) -> DemonstrationGenerator | PaperDemonstrations:
    return LAYOUTS[layout](relation, split, open_drops(), folder)
