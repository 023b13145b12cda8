"""Reading of input files, bytes, text and JSON: what they are is found out before they are read."""

from __future__ import annotations

import json
import os
import stat
from pathlib import Path
from typing import Any

from tamp.errors import InputError

MOST_BYTES = 32_000_000
"""The largest plan file that is read: two thousand actions need half of it."""

MOST_DIGITS = 20
"""Of an integer in JSON: what is counted, and a seed, have no more."""

KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
    (stat.S_ISSOCK, "a socket"),
)
"""What a name may mean that is no regular file."""


def is_file(path: Path) -> bool:
    """Check whether a regular file of that name is there; a name that cannot be one is none."""
    return os.path.isfile(path)  # pathlib's raises for a name that is too long


def read_bytes(file: Path, most: int = MOST_BYTES, *, kind: str = "file") -> bytes:
    """Read the bytes of a regular file.

    Args:
        file: Its name; a folder, a device, a pipe or a socket is refused, and never waited for.
        most: Bytes beyond which it is refused unread.
        kind: What it should be, for the message: "plan file".

    Raises:
        InputError: It is none, is missing, too large or cannot be read.
    """
    try:
        found = os.stat(file)
        for is_kind, name in KINDS:
            if is_kind(found.st_mode):
                raise InputError(f"this is {name}, no {kind}", file=file)
        if found.st_size > most:
            raise InputError(f"no {kind} is {found.st_size / 1e6:.1f} MB large", file=file)
        with open(file, "rb") as stream:
            content = stream.read(most + 1)  # what says that it is empty, as in /proc, need not be
    except FileNotFoundError:
        raise InputError("no such file", file=file) from None
    except OSError as error:
        raise InputError(f"it cannot be read: {error.strerror}", file=file) from None
    except ValueError:
        raise InputError(f"no {kind} has such a name", file=file) from None
    if len(content) > most:
        raise InputError(f"no {kind} is larger than {most / 1e6:.1f} MB", file=file)
    return content


def read_text(file: Path, most: int = MOST_BYTES, *, kind: str = "file") -> str:
    """Read the text of a regular file in UTF-8, as `read_bytes` reads it.

    Raises:
        InputError: As for `read_bytes`; or it is no text, with the line.
    """
    content = read_bytes(file, most, kind=kind)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(f"this is no {kind}: it is not UTF-8 text", file=file, line=line) from None


def read_json(file: Path, most: int = MOST_BYTES, *, kind: str = "plan file") -> Any:
    """Read the JSON document in a regular file.

    Raises:
        InputError: As for `read_text`; or it is not JSON, nested too deeply, has a number that is
            not finite or has too many digits, or a key twice.
    """
    return parse_json(read_text(file, most, kind=kind), file, kind=kind)


def parse_json(text: str, file: Path | None = None, *, kind: str = "plan file") -> Any:
    """Parse the JSON document in a text.

    Raises:
        InputError: As for `read_json`.
    """
    try:
        return json.loads(
            text, parse_constant=_refuse_constant, parse_int=_integer, object_pairs_hook=_unique
        )  # fmt: skip
    except json.JSONDecodeError as error:
        raise InputError(
            f"not JSON: {error.msg}", file=file, line=error.lineno, column=error.colno
        ) from None
    except RecursionError:
        raise InputError(f"this is no {kind}: it is nested too deeply", file=file) from None
    except InputError as error:
        raise error.at(file) from None


def _refuse_constant(constant: str) -> float:
    raise InputError(f"{constant} is not a number that may stand here")


def _integer(digits: str) -> int:
    if len(digits) > MOST_DIGITS + digits.startswith("-"):
        raise InputError(f"an integer of {len(digits)} digits")
    return int(digits)


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    members = dict(pairs)
    if len(members) != len(pairs):
        seen: set[str] = set()
        twice = next(key for key, _ in pairs if key in seen or seen.add(key))
        raise InputError(f"the key '{twice}' is given twice")
    return members
