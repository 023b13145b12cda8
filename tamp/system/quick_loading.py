"""The cache of compiled kernels: loaded and nothing else, or compiled anew where it is unreadable.

It changes classes of numba's own, and leaves them as they are where a numba of another version
lacks what is needed.
"""

from __future__ import annotations

import pickle
from collections.abc import Callable
from typing import Any

from numba.core.caching import Cache, IndexDataCacheFile
from numba.core.runtime.nrt import rtsys

REPLACED = frozenset({"refresh", "_guard_against_spurious_io_errors", "_load_overload"})
"""What numba's own way to load a kernel calls."""


UNREADABLE = (AttributeError, ImportError, EOFError, pickle.UnpicklingError, ValueError, TypeError)
"""What a file of the cache raises that was cut off, or names a class that the code calls otherwise
now."""


def compile_what_cannot_be_read() -> None:
    """Have numba take an unreadable file of its cache for an empty one.

    An index names the classes of its kernels' arguments, and is read whole before numba looks
    whether it is of this source: where one was renamed, a new version stopped at the old one's.
    """
    for name, nothing in (("_load_index", dict), ("load", lambda: None)):
        original = getattr(IndexDataCacheFile, name, None)
        if original is not None:
            setattr(IndexDataCacheFile, name, _or_nothing(original, nothing))


def _or_nothing(load: Callable[..., Any], nothing: Callable[[], Any]) -> Callable[..., Any]:
    def load_or_nothing(self: Any, *arguments: Any) -> Any:
        try:
            return load(self, *arguments)
        except UNREADABLE:
            return nothing()

    return load_or_nothing


def load_without_compiler() -> None:
    """Have numba load a kept kernel without what compiling one takes.

    Before it looks for a kernel, numba readies the implementations of all that it can compile, and
    scipy's linear algebra for them: a quarter of a second. A kernel needs only the runtime; who
    compiles after all readies the rest (numba.core.compiler.compile_extra).
    """
    if frozenset(Cache.load_overload.__code__.co_names) != REPLACED:
        return

    def load_overload(self: Any, sig: Any, target_context: Any) -> Any:
        rtsys.initialize(target_context)
        with self._guard_against_spurious_io_errors():
            return self._load_overload(sig, target_context)

    Cache.load_overload = load_overload
