"""Calls written into who makes them: what Python and numpy answer, and no function compiled."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numba.core import event
from numba.core.runtime import _nrt_python as statistics  # pyright: ignore[reportAttributeAccessIssue]
from numba.core.runtime.nrt import rtsys

from tamp.system import compilation

NUMBERS = (0.0, -0.0, 1.5, -2.0, math.inf, -math.inf, math.nan)


def compiled(signature: str, function):
    """Compile a function, which has to be the only one that is compiled."""
    with event.install_recorder("numba:compile") as recorder:
        kernel = compilation.njit(signature)(function)
    assert len(recorder.buffer) == 2, recorder.buffer
    return kernel


def same(a: float, b: float) -> bool:
    return np.float64(a).tobytes() == np.float64(b).tobytes()


@pytest.mark.parametrize("choice", [max, min])
def test_the_larger_and_the_smaller_of_two_are_pythons(choice) -> None:
    kernel = compiled("float64(float64, float64)", lambda x, y: choice(x, y))
    pairs = [(x, y) for x in NUMBERS for y in NUMBERS]
    assert all(same(kernel(x, y), choice(x, y)) for x, y in pairs)


def test_the_larger_of_three_and_of_integers_are_numbas() -> None:
    three = compilation.njit("float64(float64, float64, float64)")(lambda x, y, z: max(x, y, z))
    assert three(1.0, 3.0, 2.0) == 3.0
    assert compilation.njit("int64(int64, int64)")(lambda x, y: min(x, y))(4, 3) == 3
    assert compilation.njit("float64(int64, float64)")(lambda x, y: max(x, y))(4, 3.5) == 4.0


def test_a_number_is_truncated() -> None:
    kernel = compiled("int64(float64)", lambda x: int(x))
    assert [kernel(x) for x in (0.0, 1.9, -1.9, 1e15)] == [0, 1, -1, 10**15]
    assert compilation.njit("int64(boolean)")(lambda x: int(x))(True) == 1


def test_arrays_are_allocated_as_numpy_would() -> None:
    compilation.njit("float64[::1](int64)")(lambda n: np.empty(n))  # compiles the allocator once
    kinds = [
        compiled("float64[::1](int64)", lambda n: np.empty(n)),
        compiled("float64[:, ::1](int64)", lambda n: np.empty((n, 2))),
        compiled("int64[:, :, ::1](int64)", lambda n: np.empty((n, 2, n), np.int64)),
        compiled("uint8[::1](int64)", lambda n: np.empty(n, np.uint8)),
    ]
    made = [kernel(3) for kernel in kinds]
    assert [one.shape for one in made] == [(3,), (3, 2), (3, 2, 3), (3,)]
    assert [one.dtype for one in made] == [np.float64, np.float64, np.int64, np.uint8]
    assert all(one.flags.c_contiguous and one.flags.writeable for one in made)
    assert [kernel(0).size for kernel in kinds] == [0, 0, 0, 0]


def test_what_else_is_allocated_is_numbas() -> None:
    named = compilation.njit("float32[::1](int64)")(lambda n: np.empty(n, dtype=np.float32))
    short = compilation.njit("float64[::1](int32)")(lambda n: np.empty(n))
    assert named(2).dtype == np.float32 and short(2).shape == (2,)
    with pytest.raises(ValueError, match="negative dimensions"):
        compilation.njit("float64[::1](int64)")(lambda n: np.empty(n))(-1)


def test_an_array_is_freed_with_its_last_reference() -> None:
    kernel = compilation.njit("float64(int64)")(lambda n: np.empty(n).size + np.empty((n, n)).size)
    statistics.memsys_enable_stats()
    try:
        before = rtsys.get_allocation_stats()
        assert kernel(4) == 20.0
        after = rtsys.get_allocation_stats()
    finally:
        statistics.memsys_disable_stats()
    assert after.alloc - before.alloc == after.free - before.free
