"""The three measurements: a classifier's accuracy, a generator's success and how it fails, times."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import asdict
from typing import Any

import numpy as np

from benchmarks.groundings.case import Case
from benchmarks.groundings.library import Library
from grounding.dataset import Dataset
from grounding.evaluate import accuracy, evaluate
from grounding.model import RelationModel

BATCHES = (1, 64)
"""Poses that are asked for, or judged, at once."""


def measured_accuracy(model: RelationModel, library: Library, case: Case) -> dict[str, Any]:
    """Accuracy on scenes of the training set (all of it, also where a model has seen fewer) and of the test set."""
    splits = {split: library.scenes(case.relation, split) for split in ("train", "test")}
    return {split: accuracy(model, data, case.scenes) for split, data in splits.items()} | {
        f"{split}_scenes": min(case.scenes, len(data)) for split, data in splits.items()
    }


def measured_success(model: RelationModel, library: Library, case: Case) -> dict[str, Any]:
    """What `grounding.evaluate` finds on test scenes."""
    return asdict(evaluate(model, library.scenes(case.relation, "test"), case.scenes, draws=case.draws))


def measured_times(model: RelationModel, library: Library, case: Case) -> dict[str, Any]:
    """Medians over test scenes of the milliseconds for a batch, of proposals and of judgements, in one thread.

    Each scene's body was asked for once before. Situations are made before the clock starts.
    A model that classifies nothing has None.
    """
    data, rng = library.scenes(case.relation, "test"), np.random.default_rng(0)
    found: dict[str, Any] = {}
    for count in BATCHES:
        found[f"propose_{count}_ms"] = _median(data, case.scenes, lambda s, n=count: model.propose(s, n, rng))
    own = data[0].situation
    if np.isnan(model.classify(own, own.body.matrix[None])).any():
        return found | {f"classify_{count}_ms": None for count in BATCHES}
    for count in BATCHES:
        found[f"classify_{count}_ms"] = _median(
            data, case.scenes, lambda s, n=count: model.classify(s, np.repeat(s.body.matrix[None], n, axis=0))
        )
    return found


PASSES = 5
"""How often each scene is asked; its fastest counts, since other programs only ever add time."""


def _median(data: Dataset, scenes: int, asked: Callable[[Any], Any]) -> float:
    seconds = np.empty((1 + PASSES, min(scenes, len(data))))
    for passed in seconds:
        situations = [data[row].situation for row in range(len(passed))]  # new ones: nothing is known of their places
        for row, situation in enumerate(situations):
            started = time.perf_counter()
            asked(situation)
            passed[row] = time.perf_counter() - started
    # what is worked out once for a shape (how it can rest: some 5 ms) is left behind in the first pass
    return 1e3 * float(np.median(seconds[1:].min(axis=0)))


MEASURES: dict[str, Callable[[RelationModel, Library, Case], dict[str, Any]]] = {
    "accuracy": measured_accuracy,
    "success": measured_success,
    "times": measured_times,
}
