"""Weights on disk: NAME.safetensors with the numbers, NAME.json, the card, which says what they are."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tamp.data import write_whole
from tamp.errors import InputError

FORMAT = "tamp grounding 1"
"""What the card's `format` must say; raised when old weights would be read wrongly."""

_REMEDY = "Train it again: tamp-learn train --help"


@dataclass(frozen=True, eq=False)
class Weights:
    """A trained grounding.

    Attributes:
        arrays: Its numbers by name.
        card: What it is: format, relation, model, architecture, data, seed, commit, scores.
    """

    arrays: Mapping[str, NDArray[Any]]
    card: Mapping[str, Any]


def write_weights(path: Path, weights: Weights) -> None:
    """Write `path` (.safetensors) and its card beside it; a reader sees all of a file or nothing.

    Raises:
        OSError: The folder cannot be made or written.
    """
    from safetensors.numpy import save

    card = {"format": FORMAT, **weights.card}
    arrays = {name: np.asarray(array, order="C") for name, array in sorted(weights.arrays.items())}
    write_whole(path.with_suffix(".json"), (json.dumps(card, indent=2, sort_keys=True) + "\n").encode())
    write_whole(path, save(arrays, metadata={"format": FORMAT}))


def read_weights(path: Path) -> Weights:
    """The weights at `path`.

    Raises:
        InputError: A file is missing, damaged, truncated, or not of this format.
    """
    from safetensors import SafetensorError
    from safetensors.numpy import load

    card_path = path.with_suffix(".json")
    for file in (path, card_path):
        if not file.is_file():
            raise InputError("no such weight file", file=file, remedy=_REMEDY)
    try:
        card = json.loads(card_path.read_text(encoding="utf-8"))
    except (ValueError, OSError) as error:
        raise InputError(f"the card is damaged: {error}", file=card_path, remedy=_REMEDY) from None
    if not isinstance(card, dict) or card.get("format") != FORMAT:
        raise InputError(f"not a card of '{FORMAT}'", file=card_path, remedy=_REMEDY)
    try:
        arrays = load(path.read_bytes())
    except (SafetensorError, ValueError, OSError) as error:
        raise InputError(f"the weights are damaged: {error}", file=path, remedy=_REMEDY) from None
    for name, array in arrays.items():
        if array.dtype.kind == "f" and not np.isfinite(array).all():
            raise InputError(f"the weights are damaged: '{name}' is not finite", file=path, remedy=_REMEDY)
    return Weights(arrays, card)
