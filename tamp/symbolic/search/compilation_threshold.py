"""Thresholds of just-in-time compilation: how much work in plain Python makes compiled loops pay.

Both find the same, so the choice is about time alone, never about a result.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass


@dataclass
class CompilationThreshold:
    """A count of what plain Python has gone through in this process, beside what loading and
    compiling are worth.

    Attributes:
        module: The module that holds the compiled loops; once it is imported, they are there.
        load: Entries before the loops are loaded.
        compile: Entries before they are compiled, where that has not been done yet.
        entries: Those that plain Python has gone through.
        enough: One of the thresholds, once it is known which.
    """

    module: str
    load: int
    compile: int
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
        if self.entries <= self.load:
            return False
        if self.enough is None:
            self.enough = self.load if compiled_before() else self.compile
        return self.entries > self.enough
