"""Problems of the benchmark that have no plan, written to files."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.infeasible_scenes import KINDS

BY_NAME = {make.__name__: (number, make) for number, make in enumerate(KINDS)}


def written(kind: str, folder: Path, seed: int = 0) -> Path:
    number, make = BY_NAME[kind]
    path = folder / f"{kind}.yaml"
    path.write_text(make(np.random.default_rng((number, seed))).text, encoding="utf-8")
    return path
