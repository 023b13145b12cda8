"""Shortcuts through numba's compiler: the same kernels, and code of others' functions as numba makes it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from numba.core.compiler import Flags


def test_options_compare_as_numba_would_have_them() -> None:
    plain, named, changed = Flags(), Flags(), Flags()
    default = Flags.options["nrt"].default
    setattr(named, "nrt", default)  # noqa: B010
    setattr(changed, "nrt", not default)  # noqa: B010
    assert plain == named and hash(plain) == hash(named) and named.values() == plain.values()
    assert plain != changed and changed.values() != plain.values() and plain != 3
    assert hash(plain) == hash(tuple(sorted(plain.values())))


KEPT_BACK = """
import sys
from numba import types
from numba.core.codegen import JITCodeLibrary

from tamp.system.compilation import njit

generated = []
finish = JITCodeLibrary._finalize_specific
JITCodeLibrary._finalize_specific = lambda self: (generated.append(self.name), finish(self))


@njit(no_cpython_wrapper=True, no_cfunc_wrapper=True)
def half(x):
    if x > 1e9:
        raise ValueError("too large")
    return x / 2


@njit(types.float64(types.float64), cache=True, no_cfunc_wrapper=True)
def quarter(x):
    return half(half(x))


print(quarter(2.0), "quarter" in generated, "half" in generated)
try:
    quarter(4e9)
except ValueError as error:
    print(error)
"""


def test_machine_code_is_generated_of_what_python_calls(tmp_path: Path) -> None:
    (tmp_path / "kernels.py").write_text(KEPT_BACK)
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    said = [
        subprocess.run(
            [sys.executable, "kernels.py"], cwd=tmp_path, env=environment,
            capture_output=True, text=True, check=True,
        ).stdout
        for _ in range(2)
    ]  # fmt: skip
    assert said == ["0.5 True False\ntoo large\n"] * 2  # compiled, then loaded


def test_functions_of_others_are_compiled_as_numba_does() -> None:
    from numba import cfunc, njit, vectorize

    inner = njit(lambda x: x + 1.0)
    outer = njit(lambda x: inner(x) * 2.0)
    assert outer(1.0) == 4.0 and inner(1.0) == 2.0
    assert cfunc("float64(float64)")(lambda x: inner(x)).ctypes(1.0) == 2.0
    assert vectorize(["float64(float64)"])(lambda x: outer(x))([1.0, 2.0]).tolist() == [4.0, 6.0]
