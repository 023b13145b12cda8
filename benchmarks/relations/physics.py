"""What stays when proposals are dropped in physics, in generated scenes of each relation's kind."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

from benchmarks.relations.files import write
from grounding.relations.candidates import candidates
from grounding.relations.demonstration_file import demonstrations_of
from grounding.relations.files import weights_of
from grounding.relations.grounding import LearnedRelation
from grounding.relations.learner import learn
from grounding.relations.scenes import examples_of


def dropped(name: str, seeds: int, scenes: int = 20) -> dict[str, str | float]:
    """Learn from 20 demonstration files, propose one pose in each scene, and let the body go."""
    stayed: list[bool] = []
    likely: list[bool] = []
    for seed in range(seeds):
        rng = np.random.default_rng(seed)
        with tempfile.TemporaryDirectory() as folder:
            write(Path(folder), name, 10, 10, rng)
            shown = list(demonstrations_of(name, [Path(folder)]))
            relation = LearnedRelation(weights_of(learn(name, shown, rng), {}))
            found = candidates(relation, examples_of(shown), scenes, rng, near=0.0)
        stayed += [one.stayed for one in found]
        likely += [one.probability >= 0.5 for one in found]
    return {
        "relation": name,
        "proposals": len(stayed),
        "stay": round(float(np.mean(stayed)), 3),
        "hold where they lie, says the classifier": round(float(np.mean(likely)), 3),
    }
