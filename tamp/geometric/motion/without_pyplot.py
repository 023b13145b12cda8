"""Importing a library that can draw without importing what it draws with."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType

PLOTTING = ("matplotlib", "matplotlib.pyplot")


@contextmanager
def without_pyplot() -> Iterator[None]:
    """Give imports in the block that ask for pyplot an empty module, unless it is there already.

    toppra imports pyplot for plots that nobody here asks for, and that takes longer than solving a
    small problem. Afterwards matplotlib can be imported as usual.
    """
    if PLOTTING[0] in sys.modules:
        yield
        return
    blank = {name: ModuleType(name) for name in PLOTTING}
    vars(blank["matplotlib"])["pyplot"] = blank["matplotlib.pyplot"]
    sys.modules.update(blank)
    try:
        yield
    finally:
        for name in PLOTTING:
            del sys.modules[name]
