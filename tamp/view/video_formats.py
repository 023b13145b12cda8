"""The video formats that can be written."""

from __future__ import annotations

from pathlib import Path

from tamp.errors import InputError

VIDEO_FORMATS = {".gif": "GIF", ".webp": "WEBP"}
"""What they are called, by the file's ending. No mp4: its encoders are GPL or large."""


def check_suffix(file: Path) -> None:
    """Refuse a moving picture of a kind that is not written.

    Raises:
        InputError: The file's ending is none of MOVING.
    """
    suffix = file.suffix.lower()
    if suffix not in VIDEO_FORMATS:
        what = f"no moving picture is written as '{suffix or file.name}'"
        raise InputError(what, file=file, found=suffix, choices=tuple(VIDEO_FORMATS))
