"""The files of a folder at any depth, as many as a folder of one's own data has: never a whole
file system.
"""

from __future__ import annotations

import os
from fnmatch import fnmatch
from pathlib import Path

from tamp.errors import InputError

MOST_FILES = 100_000
"""Files and folders that are looked at in a folder; ShapeNet's mugs have 2,000, YCB's objects some
hundreds each.
"""


def files_below(folder: Path, pattern: str = "*", most: int = MOST_FILES) -> list[Path]:
    """List the regular files of a folder at any depth whose names match, sorted; links to folders
    are not followed, and what is no folder has none.

    Raises:
        InputError: There is more in it than `most` files and folders.
    """
    found: list[Path] = []
    seen = 0
    for place, folders, files in os.walk(folder):
        seen += len(folders) + len(files)
        if seen > most:
            what = f"more than {most:,} files and folders in this folder"
            raise InputError(what, file=folder, remedy="Name the folder of your own files alone")
        found += [Path(place, name) for name in files if fnmatch(name, pattern)]
    return sorted(file for file in found if file.is_file())
