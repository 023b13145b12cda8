"""A line of a benchmark's results: read, and each of its fields looked at, before any table is made
of it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from tamp.benchmark.case import IDENTITY
from tamp.errors import InputError
from tamp.system.reading import parse_json

REMEDY = "Remove the line: its run is redone"

LARGEST = 1e9
"""No time, count or cost of a run is larger: seconds of thirty years."""

Line = dict[str, Any]


def read_line(text: bytes, path: Path, number: int) -> Line:
    """Read a result.

    Args:
        text: The line.
        path: Of the file, for messages.
        number: Of the line, from 1.

    Raises:
        InputError: It is no result of tamp-bench, with the file, the line, and the field that is
            wrong.
    """
    try:
        line = parse_json(text.decode("utf-8"), kind="result")
        if not isinstance(line, dict):
            raise InputError("no object")
        _check(line)
    except UnicodeDecodeError:
        raise _wrong(path, number, "it is not UTF-8 text") from None
    except InputError as error:
        raise _wrong(path, number, error.message) from None
    return line


def _wrong(path: Path, number: int, what: str) -> InputError:
    return InputError(f"no result of tamp-bench: {what}", file=path, line=number, remedy=REMEDY)


def _check(line: Line) -> None:
    for name in NEEDED:
        if name not in line:
            raise InputError(f"'{name}' is missing")
    config = line["config"]
    if not isinstance(config, dict):
        raise InputError(f"'config' is {_shown(config)}, not an object")
    for name in IDENTITY:
        if name not in config:
            raise InputError(f"'config.{name}' is missing")
    _check_fields(config, CONFIG, "config.")
    _check_fields(line, FIELDS, "")
    if line["solved"] and line["outcome"] != "SOLVED":
        raise InputError(f"'outcome' is {_shown(line['outcome'])} of a run that is solved")


def _check_fields(
    entries: Mapping[str, Any], fields: Mapping[str, tuple[str, Callable[[Any], bool]]], at: str
) -> None:
    for name, (wanted, fits) in fields.items():
        if name in entries and not fits(entries[name]):
            raise InputError(f"'{at}{name}' is {_shown(entries[name])}, not {wanted}")


def _word(value: Any) -> bool:
    """Check that a word may stand in a table."""
    return isinstance(value, str) and 0 < len(value) <= 4096 and value.isprintable()


def _number(value: Any) -> bool:
    return (
        isinstance(value, int | float)
        and not isinstance(value, bool)
        and math.isfinite(value)
        and value <= LARGEST
    )


def _amount(value: Any) -> bool:
    return _number(value) and value >= 0


def _seed(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value < 2**64


def _count(value: Any) -> bool:
    return isinstance(value, int) and _amount(value)


def _texts(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(one, str) for one in value)


def _words(value: Any) -> bool:
    return isinstance(value, dict) and all(
        _word(name) and _word(one) for name, one in value.items()
    )


def _amounts(value: Any) -> bool:
    return isinstance(value, dict) and all(
        _word(name) and _amount(one) for name, one in value.items()
    )


def _machine(value: Any) -> bool:
    return (
        isinstance(value, dict)
        and _word(value.get("cpu"))
        and "cores" in value  # Python does not know how many there are everywhere: None
        and (value["cores"] is None or _count(value["cores"]))
    )


def _objects(value: Any) -> bool:
    return isinstance(value, dict) and all(isinstance(one, dict) for one in value.values())


def _lists(value: Any) -> bool:
    return isinstance(value, dict) and all(isinstance(one, list) for one in value.values())


def _or_none(fits: Callable[[Any], bool]) -> Callable[[Any], bool]:
    return lambda value: value is None or fits(value)


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


NEEDED = ("config", "seed", "outcome", "solved", "verified", "planning_s")
"""What no line is without."""

CONFIG: Mapping[str, tuple[str, Callable[[Any], bool]]] = {
    "problem": ("a name", _word),
    "sampler": ("a name", _word),
    "algorithm": ("a name", _word),
    "seed": ("a seed: 0 to 2^64 - 1", _seed),
    "time": ("a time in seconds", lambda value: _amount(value) and value > 0),
    "samplers": ("names by relation", _words),
}
"""Of the entries of `config`: what each should be, and whether it is."""

FIELDS: Mapping[str, tuple[str, Callable[[Any], bool]]] = {
    "seed": ("a seed: 0 to 2^64 - 1", _seed),
    "outcome": ("a word", _word),
    "solved": ("true or false", lambda value: isinstance(value, bool)),
    "verified": ("true, false or null", _or_none(lambda value: isinstance(value, bool))),
    **{
        name: ("a time in seconds", _amount)
        for name in ("planning_s", "load_s", "cpu_s", "verify_s")
    },
    "motion_s": ("a time in seconds", _or_none(_amount)),
    "cost": ("a number", _or_none(_number)),
    "actions": ("a count", _count),
    "load": ("a number", _amount),
    "explanation": ("a list of texts", _texts),
    "warnings": ("a list of texts", _texts),
    "violations": ("a list of texts", _texts),
    "parts_s": ("seconds by part", _amounts),
    "streams": ("figures by stream", _objects),
    "samplers": ("lists by relation", _lists),
    "machine": ("a machine: cpu and cores", _machine),
    **{name: ("a name", _word) for name in ("commit", "tamp", "python", "numpy")},
}
"""The same of the line's own entries; those of later versions are left as they are."""
