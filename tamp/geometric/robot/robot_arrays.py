"""Arrays of a robot's folder: read with everything about them checked."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tamp.errors import InputError
from tamp.system.npz import read_npz
from tamp.system.reading import read_bytes

MOST_BYTES = 500_000_000
"""Of all arrays of a file together."""

MOST_ARRAYS = 10_000
"""Of a file: the shipped robots have up to 144, two for each hull."""

LARGEST = 1e9
"""No number is as large."""

REMEDY = "Make the robot again: tamp-robot make"


def read_arrays(file: Path) -> dict[str, NDArray[Any]]:
    """Read all arrays of a file of a robot's folder, by their names.

    Raises:
        InputError: It is missing, no such file, or damaged.
    """
    if not file.is_file():
        raise InputError(f"{file.name} is missing", file=file, remedy=REMEDY)
    try:
        content = read_bytes(file, MOST_BYTES, kind="file of arrays")
        return read_npz(content, most_bytes=MOST_BYTES, most_members=MOST_ARRAYS)
    except InputError as error:
        raise damaged(file, error.message) from None


def damaged(file: Path, what: str) -> InputError:
    """Return the error about a file that is damaged."""
    return InputError(f"damaged: {what}", file=file, remedy=REMEDY)


def numbers(
    arrays: dict[str, NDArray[Any]], name: str, file: Path, shape: tuple[int | None, ...],
    kinds: Collection[str] = "fiu",
) -> NDArray[Any]:  # fmt: skip
    """Return an array of numbers, none of them endless.

    Args:
        arrays: Those of the file.
        name: Of the one.
        file: Which is named where it is wrong.
        shape: None for any length but 0.
        kinds: Numpy's letters of its type.

    Raises:
        InputError: It is missing, or not of this kind.
    """
    if name not in arrays:
        raise damaged(file, f"it has no '{name}'")
    found = arrays[name]
    fits = found.ndim == len(shape) and all(
        length > 0 if wanted is None else length == wanted
        for length, wanted in zip(found.shape, shape, strict=True)
    )
    if not fits or found.dtype.kind not in kinds or not (np.abs(found) < LARGEST).all():
        words = " x ".join("n" if length is None else str(length) for length in shape) or "one"
        raise damaged(file, f"'{name}' is not {words} numbers")
    return found
