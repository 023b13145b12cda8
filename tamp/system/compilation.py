"""Just-in-time compilation of kernels with numba: once for an installation, at nobody's expense,
and kept wherever one may write.

All kernels get their `njit` from here. A deadline stands still while one is compiled
(`tamp.system.deadline`).
"""

from __future__ import annotations

import gc
import os
import warnings
from collections.abc import Callable
from typing import Any

import numba
from numba.core import event

from tamp.system.deadline import STANDSTILL
from tamp.system.quick_calls import call_directly
from tamp.system.quick_compiling import (
    code_when_called,
    compare_quickly,
    generate_code_when_called,
    optimize_with_one_manager,
)
from tamp.system.quick_loading import compile_what_cannot_be_read, load_without_compiler
from tamp.system.quick_typing import (
    list_variables_quickly,
    measure_types_once,
    refresh_when_there_is_more,
    tell_only_listeners,
    type_operators_once,
)

INNER_KERNEL = {"error_model": "numpy", "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""Options of functions that only compiled code calls: they are kept with those that call them."""

CANNOT_KEEP = (
    "compiled kernels cannot be kept: {why}. They are compiled anew in each run; "
    "NUMBA_CACHE_DIR names a folder"
)


class _Compiling(event.Listener):
    """Stops the clock, and the search for garbage, while numba compiles.

    Neither is what it leaves searched afterwards: half a million objects, which to find and to free
    costs a tenth of what compiling takes. They stay, 60 MB, in the one process that compiles.
    """

    def __init__(self) -> None:
        self.count = 0
        self.collects = False
        self.said = False

    def on_start(self, event: event.Event) -> None:
        if STANDSTILL.depth == 0:
            self.collects = gc.isenabled()
            gc.disable()
        STANDSTILL.begin()
        if STANDSTILL.told is not None:
            STANDSTILL.told(self.count)
        self.count += 1

    def on_end(self, event: event.Event) -> None:
        STANDSTILL.end()
        if STANDSTILL.depth == 0 and self.collects:
            gc.freeze()
            gc.enable()


_COMPILING = _Compiling()
event.register("numba:compile", _COMPILING)


compare_quickly()
optimize_with_one_manager()
generate_code_when_called()
type_operators_once()
call_directly()
refresh_when_there_is_more()
list_variables_quickly()
measure_types_once()
tell_only_listeners()
load_without_compiler()
compile_what_cannot_be_read()


def njit(
    signature: Any = None, *, cache: bool = False, **options: Any
) -> Callable[[Callable[..., Any]], Any]:
    """Compile a function just in time, with numba.

    Args:
        signature: Compile (or load) now, for these types; None compiles at the first call.
        cache: Keep it on disk: beside the source, or where that cannot be written in the user's
            cache (`XDG_CACHE_HOME`). Where neither can be, a warning says so once and it is
            compiled in each process.
        options: As for `numba.njit`.
    """

    def compiled(function: Callable[..., Any]) -> Any:
        with code_when_called():
            if cache:
                try:
                    return numba.njit(signature, cache=True, **options)(function)
                except RuntimeError as error:  # numba found no folder
                    if "cannot cache" not in str(error):
                        raise
                    _say("no folder for it can be written")
                except OSError as error:  # the folder's disk is full
                    _say(os.strerror(error.errno) if error.errno else str(error))
            return numba.njit(signature, **options)(function)

    return compiled


def _say(why: str) -> None:
    if not _COMPILING.said:
        _COMPILING.said = True
        warnings.warn(CANNOT_KEEP.format(why=why), RuntimeWarning, stacklevel=2)
