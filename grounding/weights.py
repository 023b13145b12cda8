"""Weights on disk: NAME.safetensors with the numbers, NAME.json, the card, which says what they
are.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grounding.pair import read_pair, write_pair
from tamp.errors import InputError
from tamp.system.reading import parse_json

FORMAT = "tamp grounding 1"
"""What the card's `format` must say; raised when old weights would be read wrongly."""

MOST_BYTES = 200_000_000
"""The largest file of weights that is read; those that ship have at most 0.7 MB."""

MOST_HEADER = 1_000_000
"""The largest header of such a file, bytes; those that ship have a few kB."""

TYPES = ("BOOL", "U8", "I8", "I16", "I32", "I64", "F16", "F32", "F64")
"""The types of arrays that numpy has, in the words of safetensors."""

REMEDY = "Train it again: tamp-learn train --help"


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
    """Write `path` (.safetensors) and its card beside it; a reader sees the old pair or the new
    one.

    Raises:
        OSError: The folder cannot be made or written.
    """
    from safetensors.numpy import save

    arrays = {name: np.asarray(array, order="C") for name, array in sorted(weights.arrays.items())}
    write_pair(path, save(arrays, metadata={"format": FORMAT}), {"format": FORMAT, **weights.card})


def read_weights(path: Path) -> Weights:
    """Read the weights at `path`.

    Raises:
        InputError: A file is missing, damaged, truncated, or not of this format, or the two do not
            belong together.
    """
    from safetensors import SafetensorError
    from safetensors.numpy import load

    pair = read_pair(path, FORMAT, what="weight file", most=MOST_BYTES, remedy=REMEDY)
    content, card = pair.content, pair.card
    for name in ("relation", "model"):
        if name in card and not (isinstance(card[name], str) and card[name].isprintable()):
            card_file = path.with_suffix(".json")
            raise InputError(
                f"'{name}' of the card is {card[name]!r:.60}, not a name",
                file=card_file,
                remedy=REMEDY,
            )
    try:
        _check_header(content)
        arrays = load(content)
    except (
        SafetensorError,
        InputError,
        ValueError,
        KeyError,
        TypeError,
        OSError,
        MemoryError,
    ) as error:
        what = error.message if isinstance(error, InputError) else str(error)
        raise InputError(f"the weights are damaged: {what}", file=path, remedy=REMEDY) from None
    for name, array in arrays.items():
        if array.dtype.kind == "f" and not np.isfinite(array).all():
            first = ", ".join(str(index) for index in np.argwhere(~np.isfinite(array))[0])
            what = f"array '{name}', entry ({first}): it is not finite"
            raise InputError(f"the weights are damaged: {what}", file=path, remedy=REMEDY)
    if pair.stranger is not None:
        raise pair.stranger
    return Weights(arrays, card)


def _check_header(content: bytes) -> None:
    """Refuse what claims more than is there before anything is made of it."""
    if len(content) < 8:
        raise InputError("the file is cut off")
    (size,) = struct.unpack_from("<Q", content)
    if size > min(len(content) - 8, MOST_HEADER):
        raise InputError(f"its header claims {size:,} bytes")
    try:
        header = parse_json(content[8 : 8 + size].decode("utf-8"), kind="header")
    except UnicodeDecodeError:
        raise InputError("its header is no text") from None
    if not isinstance(header, dict):
        raise InputError("its header is no object")
    for name, entry in header.items():
        if name == "__metadata__":
            continue
        kind = entry.get("dtype") if isinstance(entry, dict) else None
        if kind not in TYPES:
            raise InputError(f"array '{name:.100}' is of type {kind!r:.40}", choices=TYPES)
