"""The bytes of a file that a problem names, read with a limit."""

from __future__ import annotations

from pathlib import Path

from tamp.errors import InputError


def read_raw(path: Path, most: int) -> bytes:
    """Read all bytes of a regular file.

    Args:
        path: The file.
        most: Bytes beyond which it is refused, unread.

    Raises:
        InputError: It is missing, no regular file (a device or a pipe would never end), unreadable
            or too large.
    """
    name = path.name if len(path.name) <= 80 else f"{path.name[:77]}..."
    try:
        if not path.is_file():
            kind = "it is no regular file" if path.exists() else "there is no such file"
            raise InputError(f"cannot read '{name}': {kind}")
        with path.open("rb") as stream:
            content = stream.read(most + 1)
    except (OSError, ValueError) as error:  # ValueError: a zero byte in the name
        why = (
            error.strerror
            if isinstance(error, OSError) and error.strerror
            else "it is no name of a file"
        )
        raise InputError(f"cannot read '{name}': {why}") from None
    if len(content) > most:
        raise InputError(f"cannot read '{name}': it is larger than {most / 1e6:g} MB")
    return content
