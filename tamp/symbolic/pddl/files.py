"""PDDL files as text: what is no file, no text or far too large is refused before it is read."""

from __future__ import annotations

import codecs
from pathlib import Path

from tamp.errors import InputError
from tamp.system.reading import read_bytes

MAX_BYTES = 50_000_000
"""The largest PDDL file that is read, bytes."""

_MARKS = {codecs.BOM_UTF16_LE: "UTF-16", codecs.BOM_UTF16_BE: "UTF-16"}


def read_pddl(path: Path) -> str:
    """Read the text of a PDDL or streams file: UTF-8, or any encoding that keeps ASCII where only
    comments differ.

    Bytes that are not UTF-8 become U+FFFD inside of comments, so that lines and columns stay what
    they are.

    Raises:
        InputError: There is no such file, it is a folder, device or pipe, cannot be read, is far
            too large, or is not UTF-8 outside of a comment; then with the line.
    """
    return decoded(read_bytes(path, MAX_BYTES, kind="PDDL file"), path)


def decoded(content: bytes, path: Path) -> str:
    """Decode the bytes of a PDDL file, see `read_pddl`."""
    for mark, name in _MARKS.items():
        if content.startswith(mark):
            raise InputError(f"cannot read it: it is {name}", file=path, remedy="Save it as UTF-8")
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError:
        pass

    lines: list[str] = []
    for number, line in enumerate(
        content.replace(b"\r\n", b"\n").replace(b"\r", b"\n").split(b"\n"), start=1
    ):
        code, semicolon, comment = line.partition(b";")
        try:
            lines.append(
                code.decode("utf-8") + (semicolon + comment).decode("utf-8", errors="replace")
            )
        except UnicodeDecodeError as error:
            what = "cannot read it: it is not UTF-8 text"
            column = len(code[: error.start].decode("utf-8")) + 1
            raise InputError(
                what, file=path, line=number, column=column, remedy="Save it as UTF-8"
            ) from None
    return "\n".join(lines)
