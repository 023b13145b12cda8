"""The loops compiled by numba: importing this takes half a second, and compiles where that has not
been done before.

Each is compiled from a copy that sees the compiled ones by their names, and numba's arrays instead
of lists.
"""

# pyright: basic

from __future__ import annotations

from collections.abc import Callable, Sequence
from types import FunctionType
from typing import Any

import numpy as np
from numba import types

from tamp.symbolic.search.compilation_threshold import digest_of
from tamp.symbolic.search.heuristics.loops import (
    kernels,
    landmark_cuts,
    landmark_queue,
    rows,
)
from tamp.symbolic.search.heuristics.loops.interface import FOLDER, SOURCES, Kernels
from tamp.system.compilation import njit

_I, _F, _N, _C = types.int64[::1], types.float64[::1], types.float64, types.int64
_ROWS = types.NamedUniTuple(_I, 2, rows.CsrRows)
_INNER = {"nogil": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}

_DIGEST = digest_of(FOLDER, SOURCES)


@njit()
def _full(size, value):
    return np.full(size, value)


@njit()
def _count_up(size):
    return np.arange(size)


def _integers(values: Sequence[int]) -> Any:
    return np.array(values, dtype=np.int64)


def _reals(values: Sequence[float]) -> Any:
    return np.array(values, dtype=np.float64)


_names: dict[str, Any] = {
    **vars(rows),
    **vars(kernels),
    **vars(landmark_queue),
    **vars(landmark_cuts),
    "full": _full,
    "count_up": _count_up,
}


def _compile(function: Callable[..., Any], signature: Any = None) -> Callable[..., Any]:
    """Compile a function; without a signature it serves other compiled ones only."""
    copy = FunctionType(function.__code__, _names, function.__name__)
    if signature:
        copy.__qualname__ = f"{function.__name__}_{_DIGEST}"
    made = (
        njit(signature, cache=True, nogil=True, no_cfunc_wrapper=True)
        if signature
        else njit(**_INNER)
    )
    _names[function.__name__] = result = made(copy)
    return result


for _inner in (kernels._before, kernels._push, kernels._pop):
    _compile(_inner)

for _inner in (
    landmark_queue.put, landmark_queue.put_far, landmark_queue.take_far,
    landmark_queue.bucket_of_nearest, landmark_queue.are_few,
    landmark_cuts._dearest, landmark_cuts._explore, landmark_cuts._fill_zone,
    landmark_cuts._find_cut, landmark_cuts._make_cheaper,
):  # fmt: skip
    _compile(_inner)

COMPILED = Kernels(
    explore=_compile(
        kernels.explore, types.Tuple((_F, _I))(_ROWS, _ROWS, _ROWS, _F, _I, _F, _I, types.boolean)
    ),
    relaxed_plan=_compile(
        kernels.relaxed_plan, types.Tuple((_N, _I))(_F, _I, _ROWS, _ROWS, _F, _I, _C, _I, _C)
    ),
    landmark_cut=_compile(
        landmark_cuts.landmark_cut, _N(_ROWS, _ROWS, _ROWS, _ROWS, _F, _I, _I, _ROWS, _C)
    ),
    transposed=_compile(rows.transposed, _ROWS(_ROWS, _C)),
    appended=_compile(rows.appended, _ROWS(_ROWS, _I, _I, _C)),
    incremented=_compile(rows.incremented, _F(_F, _I, _F, _C)),
    integers=_integers,
    reals=_reals,
)
"""The compiled kernels."""
