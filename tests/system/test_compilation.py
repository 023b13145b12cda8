"""Compiling kernels: nobody's time, told of, and possible where nothing can be kept."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from numba.core.compiler import Flags

from tamp.system import compilation
from tamp.system.deadline import STANDSTILL, Deadline

ADDING = """
from tamp.system.compilation import njit
@njit("int64(int64)", cache=True)
def add(x): return x + 1
assert add(1) == 2 and add.stats.cache_hits[add.signatures[0]] == HITS
"""


def test_the_clock_stands_still_while_numba_compiles(monkeypatch: pytest.MonkeyPatch) -> None:
    counts: list[int] = []
    monkeypatch.setattr(compilation._COMPILING, "told", counts.append)
    began, total = time.monotonic(), STANDSTILL.total
    deadline = Deadline(60.0)

    @compilation.njit("float64(float64[::1])")
    def summed(numbers):
        total = 0.0
        for k in range(len(numbers)):
            total += numbers[k]
        return total

    compiled = STANDSTILL.total - total
    assert compiled > 0.0 and len(counts) >= 1 and STANDSTILL.depth == 0
    elapsed = deadline.elapsed()
    assert elapsed <= time.monotonic() - began - compiled


def run(folder: Path, hits: int, **environment: str) -> str:
    """Compile a kernel of `folder` in a process of its own; what it warns of."""
    (folder / "adding.py").write_text(ADDING.replace("HITS", str(hits)))
    known = {name: text for name, text in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    environment = {**known, "PYTHONPATH": os.pathsep.join([str(folder), *sys.path]), **environment}
    done = subprocess.run(
        [sys.executable, "-c", "import adding"], env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return done.stderr


def test_where_the_package_cannot_be_written_the_users_cache_serves(tmp_path: Path) -> None:
    (tmp_path / "__pycache__").write_text("not a folder: nobody, root neither, can write into it")
    cache = tmp_path / "cache"
    assert run(tmp_path, 0, XDG_CACHE_HOME=str(cache)) == ""
    assert list(cache.rglob("*.nbi"))


def test_where_nothing_can_be_written_it_says_so_once_and_goes_on(tmp_path: Path) -> None:
    (tmp_path / "__pycache__").write_text("not a folder")
    (tmp_path / "cache").write_text("neither")
    said = run(tmp_path, 0, XDG_CACHE_HOME=str(tmp_path / "cache"), HOME=str(tmp_path / "cache"))
    assert said.count("RuntimeWarning") == 1 and "compiled kernels cannot be kept" in said


def test_options_compare_as_numba_would_have_them() -> None:
    plain, named, changed = Flags(), Flags(), Flags()
    default = Flags.options["nrt"].default
    setattr(named, "nrt", default)  # noqa: B010
    setattr(changed, "nrt", not default)  # noqa: B010
    assert plain == named and hash(plain) == hash(named) and named.values() == plain.values()
    assert plain != changed and changed.values() != plain.values() and plain != 3
    assert hash(plain) == hash(tuple(sorted(plain.values())))
