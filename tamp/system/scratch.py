"""Temporary folders that are needed for a moment, as for an engine that takes meshes from files
only.
"""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import tempfile
import time
from collections.abc import Iterator
from functools import cache
from pathlib import Path

FOLDER_PATTERN = re.compile(r"^tamp-(\d+)-\w+$")
"""The names of such folders: the process's number is in them."""

ABANDONED_AFTER_S = 60.0
"""Seconds after which a folder without its process has been left by one that was killed."""


@contextlib.contextmanager
def scratch_folder() -> Iterator[Path]:
    """Create a temporary folder, which is gone afterwards; what killed processes have left goes,
    too.
    """
    _tidy(Path(tempfile.gettempdir()))
    with tempfile.TemporaryDirectory(prefix=f"tamp-{os.getpid()}-") as folder:
        yield Path(folder)


@cache
def _tidy(place: Path) -> None:
    """Remove what killed processes have left, once a process."""
    with contextlib.suppress(OSError):
        for entry in os.scandir(place):
            named = FOLDER_PATTERN.match(entry.name)
            if named is None or not entry.is_dir(follow_symlinks=False):
                continue
            found = entry.stat(follow_symlinks=False)
            if (
                found.st_uid == os.getuid()
                and time.time() - found.st_mtime > ABANDONED_AFTER_S
                and not _runs(int(named[1]))
            ):
                shutil.rmtree(entry.path, ignore_errors=True)


def _runs(number: int) -> bool:
    try:
        os.kill(number, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        return True
    return True
