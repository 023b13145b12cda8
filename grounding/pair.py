"""A file of numbers and its card, NAME.json, which says what they are: two files that belong
together.

The card holds the hash of its file. Of a new pair the card is written beside the old one first,
under a name of its own; then the file takes its place, and then the card. So whoever is killed
leaves the old pair, or the new one: a file whose card has not yet taken its place is read with the
one that waits.
"""

from __future__ import annotations

import contextlib
import glob
import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tamp.errors import InputError
from tamp.system.outputs import write_whole
from tamp.system.reading import parse_json, read_bytes, read_text

MOST_CARD_BYTES = 4_000_000
"""The largest card that is read; one of the default data set has 4 kB."""

HASH = "sha256"
"""The card's key of its file's hash."""


def write_pair(path: Path, content: bytes, card: Mapping[str, Any]) -> None:
    """Write a file and its card so that a reader sees the old pair or the new one.

    Raises:
        OSError: The folder cannot be made or written.
    """
    digest = hashlib.sha256(content).hexdigest()
    text = json.dumps({**card, HASH: digest}, indent=2, sort_keys=True) + "\n"
    beside = path.with_suffix(".json")
    waiting = _waiting(beside, digest)

    try:
        write_whole(waiting, text.encode())
        write_whole(path, content)
    except BaseException as error:
        waiting.unlink(missing_ok=True)
        if isinstance(error, OSError):
            error.filename = str(path)  # what the caller asked for, not the name of a moment
        raise
    waiting.replace(beside)

    for left in beside.parent.glob(
        f".{glob.escape(beside.name)}.{'[0-9a-f]' * 16}"
    ):  # of runs that were killed
        with contextlib.suppress(OSError):
            left.unlink()


@dataclass(frozen=True)
class Pair:
    """A file and its card, as they were read.

    Attributes:
        content: The file's bytes.
        card: The card, without the hash.
        stranger: The error when the card is that of another file; to be raised once the file itself
            was found sound.
    """

    content: bytes
    card: dict[str, Any]
    stranger: InputError | None = None


def read_pair(path: Path, form: str, *, what: str, most: int, remedy: str) -> Pair:
    """Read a file and its card.

    Args:
        path: The file; its card is beside it.
        form: What the card's `format` must say.
        what: What the file holds, for messages: "weights".
        most: Bytes beyond which the file is refused.
        remedy: How to make it anew.

    Raises:
        InputError: A file is missing, too large or no file; the card is damaged or of another
            format.
    """
    beside = path.with_suffix(".json")
    for file in (path, beside):
        if not file.exists():
            raise InputError(f"no such {what}", file=file, remedy=remedy)
    content = read_bytes(path, most, kind=f"file of {what}")
    digest = hashlib.sha256(content).hexdigest()

    waiting = _waiting(beside, digest)
    card = _card(beside, form, remedy)
    if card.get(HASH, digest) != digest and waiting.is_file():
        card = _card(waiting, form, remedy)
    if card.get(HASH, digest) != digest:  # perhaps the pair has just been written
        card = _card(beside, form, remedy)
    if card.pop(HASH, digest) == digest:
        return Pair(content, card)
    message = (
        f"{path.name} and its card do not belong together: "
        f"one of them was changed or is another one's"
    )
    meant = f"{remedy}; if it was changed on purpose, take '{HASH}' out of the card"
    return Pair(content, card, InputError(message, file=beside, remedy=meant))


def _card(file: Path, form: str, remedy: str) -> dict[str, Any]:
    try:
        text = read_text(file, MOST_CARD_BYTES, kind="card")
        found = parse_json(
            text.replace(": Infinity", ": null"), file, kind="card"
        )  # of earlier versions
    except InputError as error:
        message = (
            error.message
            if error.message.startswith("this is")
            else f"the card is damaged: {error.message}"
        )
        raise InputError(
            message, file=file, line=error.line, column=error.column, remedy=remedy
        ) from None
    if not isinstance(found, dict) or found.get("format") != form:
        raise InputError(f"not a card of '{form}'", file=file, remedy=remedy)
    _refuse_infinite(found, file, remedy)
    return found


def _refuse_infinite(value: Any, file: Path, remedy: str) -> None:
    """Refuse infinity, which is how JSON's 1e999 is read."""
    waiting = [value]
    while waiting:
        one = waiting.pop()
        if isinstance(one, float) and not math.isfinite(one):
            raise InputError(
                "the card is damaged: a number is not finite", file=file, remedy=remedy
            )
        waiting += one.values() if isinstance(one, dict) else one if isinstance(one, list) else ()


def _waiting(beside: Path, digest: str) -> Path:
    """Return where the card of a file of this hash waits until the file is there."""
    return beside.with_name(f".{beside.name}.{digest[:16]}")
