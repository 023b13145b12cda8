"""Validation of a JSON document whose shape is not to be trusted: every surprise is an InputError
that says where.

Not one reader with the YAML's (`tamp.geometric.loading.yaml_nodes`): a place is a path here and a
line there, numbers have units and tags there, and what the two share is `InputError`.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tamp.errors import InputError

Array = NDArray[np.float64]

LARGEST_NUMBER = 1e12
"""Of a number in a file: metres, radians, seconds, costs and counts are all below."""


class Field:
    """A value in the document, and where it stands ("actions[3].segments[0].times")."""

    def __init__(self, value: Any, where: str, file: Path | None) -> None:
        self.value, self.where, self.file = value, where, file

    def wrong(
        self, message: str, *, found: str | None = None, choices: tuple[str, ...] = ()
    ) -> InputError:
        """Return the error to raise about this field."""
        where = f"{self.where}: " if self.where else ""
        return InputError(f"{where}{message}", file=self.file, found=found, choices=choices)

    def __contains__(self, key: str) -> bool:
        return self.get(key) is not None

    def __getitem__(self, key: str) -> Field:
        found = self.get(key)
        if found is None:
            null = key in self.mapping()
            raise self.wrong(f"'{key}' is {'null' if null else 'missing'}")
        return found

    def get(self, key: str) -> Field | None:
        """Return the field under a key, or None when it is absent or null."""
        value = self.mapping().get(key)
        return (
            None
            if value is None
            else Field(value, f"{self.where}.{key}" if self.where else key, self.file)
        )

    def mapping(self) -> dict[str, Any]:
        """Read the field as an object."""
        if not isinstance(self.value, dict):
            raise self.wrong(f"an object is expected, not {_kind(self.value)}")
        return self.value

    def fields(self) -> dict[str, Field]:
        """Read the field as an object; return its members."""
        return {
            key: Field(value, f"{self.where}.{key}", self.file)
            for key, value in self.mapping().items()
        }

    def items(self) -> list[Field]:
        """Read the field as an array; return its elements."""
        if not isinstance(self.value, list):
            raise self.wrong(f"an array is expected, not {_kind(self.value)}")
        return [
            Field(value, f"{self.where}[{at}]", self.file) for at, value in enumerate(self.value)
        ]

    def text(self, choices: tuple[str, ...] = ()) -> str:
        """Read the field as a string, one of `choices` if there are any."""
        if not isinstance(self.value, str):
            raise self.wrong(f"a string is expected, not {_kind(self.value)}")
        if choices and self.value not in choices:
            raise self.wrong(
                f"'{clipped(self.value)}' is unknown", found=self.value, choices=choices
            )
        return self.value

    def number(self, least: float = -math.inf) -> float:
        """Read the field as a finite number."""
        if isinstance(self.value, bool) or not isinstance(self.value, int | float):
            raise self.wrong(f"a number is expected, not {_kind(self.value)}")
        try:
            number = float(self.value)
        except OverflowError:
            number = math.inf
        if not math.isfinite(number):
            raise self.wrong("a finite number is expected")
        if abs(number) > LARGEST_NUMBER:
            raise self.wrong(f"{number:g} is larger than anything that is counted or measured here")
        if number < least:
            raise self.wrong(f"{number:g} is less than {least:g}")
        return number

    def numbers(self, size: int | None = None) -> Array:
        """Read the field as an array of finite numbers, shape (size,)."""
        plain = isinstance(self.value, list) and all(
            type(item) in (float, int) for item in self.value
        )
        array = np.array(self.value, dtype=float) if plain else np.array([math.nan])
        if not (np.abs(array) <= LARGEST_NUMBER).all():
            # which says where
            array = np.array([item.number() for item in self.items()], dtype=float)
        if size is not None and len(array) != size:
            raise self.wrong(f"{size} numbers are expected, not {len(array)}")
        return array

    def rows(self, width: int | None = None) -> Array:
        """Read the field as rows of finite numbers, shape (n >= 1, width); without a width as many
        as the first row has.
        """
        items = self.items()
        if not items:
            raise self.wrong("at least one row is expected")
        if width is None:
            width = len(items[0].numbers())
        return np.stack([item.numbers(width) for item in items])


def clipped(word: str, length: int = 60) -> str:
    """Clip a word that may be very long to its beginning."""
    return word if len(word) <= length else f"{word[:length]}..."


def _kind(value: Any) -> str:
    names = {
        dict: "an object",
        list: "an array",
        str: "a string",
        bool: "true or false",
        type(None): "null",
    }
    return names.get(type(value), "a number")
