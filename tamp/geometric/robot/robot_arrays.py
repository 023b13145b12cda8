"""Arrays of a robot's folder: read with everything about them checked."""

from __future__ import annotations

import zipfile
import zlib
from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tamp.errors import InputError

MOST_BYTES = 500_000_000
"""Of all arrays of a file together."""

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
        with file.open("rb") as stream:
            with zipfile.ZipFile(stream) as packed:
                size = sum(one.file_size for one in packed.infolist())
            if size > MOST_BYTES:
                raise damaged(file, f"it unpacks to {size:,} bytes, {MOST_BYTES:,} at most")
            stream.seek(0)
            with np.load(stream, allow_pickle=False) as arrays:
                return {name: arrays[name] for name in arrays.files}
    except (
        OSError, ValueError, KeyError, EOFError, TypeError, AttributeError, MemoryError,
        NotImplementedError, RuntimeError, SyntaxError, zipfile.BadZipFile, zlib.error,
    ) as error:  # fmt: skip
        raise damaged(file, " ".join(str(error).split())) from None


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
