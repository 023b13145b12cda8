"""Thresholds of just-in-time compilation: how much work in plain Python makes compiled loops pay.

Both find the same, so the choice is about time alone, never about a result.
"""

from __future__ import annotations

import os
import sys
import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path


@dataclass
class CompilationThreshold:
    """A count of what plain Python has gone through in this process, beside what loading and
    compiling are worth.

    Attributes:
        module: The module that holds the compiled loops; once it is imported, they are there.
        load: Entries before the loops are loaded, numba with them.
        beside: Entries before they are loaded where numba has been imported for something else;
            None for as many.
        compile: Entries before they are compiled, where that has not been done yet.
        entries: Those that plain Python has gone through.
        enough: One of the thresholds, once it is known which.
    """

    module: str
    load: int
    compile: int
    beside: int | None = None
    entries: int = 0
    enough: int | None = None

    def pays(self, entries: int, compiled_before: Callable[[], bool]) -> bool:
        """Check whether the compiled loops pay, after so many more entries.

        Args:
            entries: Of the work at hand.
            compiled_before: Says whether they are kept on disk; asked once, when loading pays.
        """
        self.entries += entries
        if self.module in sys.modules:
            return True
        load = self.load
        if self.beside is not None and "numba" in sys.modules:
            load = self.beside
        if self.entries <= load:
            return False
        if self.enough is None:
            self.enough = load if compiled_before() else self.compile
        return self.entries > self.enough


def digest_of(folder: Path, modules: Sequence[str]) -> str:
    """Hash the sources of a folder's modules: what names kernels that are compiled of them all.

    Numba's own cache watches the one file that a kernel stands in.
    """
    sources = b"".join((folder / f"{name}.py").read_bytes() for name in modules)
    return f"{zlib.crc32(sources):08x}"


def are_kept(folder: Path, modules: Sequence[str], kernels: Sequence[str]) -> bool:
    """Check that numba's cache beside the sources has all kernels, compiled of these sources."""
    if "NUMBA_CACHE_DIR" in os.environ:
        return False
    made = digest_of(folder, modules)
    return all(any((folder / "__pycache__").glob(f"*.{name}_{made}-*.nbi")) for name in kernels)
