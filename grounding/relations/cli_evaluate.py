"""tamp-learn evaluate of one's own relation: labels it was not shown, generated scenes, physics."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from grounding.certainty import cannot_tell
from grounding.evaluate import wilson
from grounding.relations.candidates import candidates
from grounding.relations.demonstration_file import Demonstration, demonstrations_of
from grounding.relations.grounding import LearnedRelation
from grounding.relations.picture import write_picture
from grounding.relations.scenes import read_examples
from grounding.weights import read_weights
from tamp.errors import InputError
from tamp.geometric.scene.classifier import LIKELY_PROBABILITY

MOST_PICTURES = 12
"""Pictures that are written, at most."""


def evaluate_own(
    path: Path, demos: Path | None, pictures: Path | None, scenes: int, seed: int
) -> None:
    """Judge a relation by labels that it was not shown, and drop in physics what it proposes in
    scenes of its kind.

    Raises:
        InputError: The weights have no examples, demonstrations of another relation, or the folder
            for pictures has files.
    """
    weights = read_weights(path)
    name, why = str(weights.card["relation"]), cannot_tell(weights.card)
    try:
        relation, examples = LearnedRelation(weights), read_examples(weights.card.get("examples"))
    except InputError as error:
        raise error.at(path) from None
    if not examples:
        raise InputError("the card has no examples to make scenes of", file=path)
    if (
        pictures is not None
        and pictures.exists()
        and (not pictures.is_dir() or any(pictures.iterdir()))
    ):
        raise InputError("it is there already", file=pictures, remedy="Name a new folder")

    figures: dict[str, object] = {"relation": name, "scenes": scenes}
    shown = [] if demos is None else list(demonstrations_of(name, [demos]))
    if why is not None:
        print(f"classifier  it cannot tell yet: {why}")
    elif shown:
        figures |= _judged(relation, shown)

    found = candidates(relation, examples, scenes, np.random.default_rng(seed), near=0.0)
    for key, held in (
        ("stays in physics", [one.stayed for one in found]),
        (
            "holds where it lies, says the classifier",
            [one.probability >= LIKELY_PROBABILITY for one in found],
        ),
    ):
        if key.startswith("holds") and why is not None:
            continue
        share = float(np.mean(held)) if held else 0.0
        low, high = wilson(share, max(len(held), 1))
        print(f"{key}: {share:.3f} [{low:.3f}, {high:.3f}] of {len(held)} proposals")
        figures[key] = share

    if pictures is not None:
        for number, one in enumerate(found[:MOST_PICTURES], 1):
            write_picture(pictures / f"{name}_{number:02d}.png", one.bodies, one.arguments, name)
        print(f"{pictures}: {min(len(found), MOST_PICTURES)} pictures of what it would do")
    print(json.dumps(figures))


def _judged(relation: LearnedRelation, shown: list[Demonstration]) -> dict[str, object]:
    """Ask the classifier of demonstrations that it was not shown."""
    said = np.array(
        [relation.classify(one.scene, one.arguments) >= LIKELY_PROBABILITY for one in shown]
    )
    holds = np.array([one.holds for one in shown])
    figures: dict[str, object] = {}
    for key, rows, right in (("what holds", holds, said), ("what does not", ~holds, ~said)):
        if rows.any():
            share = float(right[rows].mean())
            print(f"classifier, of {rows.sum()} demonstrations of {key}: {share:.3f} right")
            figures[f"right about {key}"] = share
    for row in np.flatnonzero(said != holds)[:5]:
        print(f"  wrong: {shown[int(row)].source}")
    return figures
