"""A shortcut through numba's cache: kernels that were compiled before, loaded and nothing else.

It changes a class of numba's own, and leaves it as it is where a numba of another version lacks
what the shortcut needs.
"""

from __future__ import annotations

from typing import Any

from numba.core.caching import Cache
from numba.core.runtime.nrt import rtsys

REPLACED = frozenset({"refresh", "_guard_against_spurious_io_errors", "_load_overload"})
"""What numba's own way to load a kernel calls."""


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
