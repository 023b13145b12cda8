"""Compiling kernels: nobody's time, told of, and possible where nothing can be kept."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

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
    monkeypatch.setattr(STANDSTILL, "told", counts.append)
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


RENAMED = """
from typing import NamedTuple
from tamp.system.compilation import njit
class NAME(NamedTuple):
    one: int
@njit(cache=True)
def first(some): return some.one
assert first(NAME(3)) == 3
"""


def test_a_cache_of_classes_that_have_other_names_now_is_compiled_anew(tmp_path: Path) -> None:
    """Whoever upgrades keeps the old version's cache: its index names classes that are no more."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path])}
    environment["NUMBA_CACHE_DIR"] = str(tmp_path / "cache")
    for name in ("Task", "PackedTask", "PackedTask"):
        (tmp_path / "renamed.py").write_text(RENAMED.replace("NAME", name))
        done = subprocess.run(
            [sys.executable, "-c", "import renamed"],
            env=environment,
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stderr
    (index,) = (tmp_path / "cache").rglob("*.nbi")
    assert b"PackedTask" in index.read_bytes()


def test_a_cache_that_was_cut_off_is_compiled_anew(tmp_path: Path) -> None:
    cache = str(tmp_path / "cache")
    assert run(tmp_path, 0, NUMBA_CACHE_DIR=cache) == ""
    source = (tmp_path / "adding.py").read_text().replace("== 0", "in (0, 1)")
    (tmp_path / "adding.py").write_text(source + "print(sum(add.stats.cache_hits.values()))")

    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path])}
    environment["NUMBA_CACHE_DIR"] = cache
    hits: list[str] = []
    for broken in ("", "", "nbi", "", "nbc", ""):
        for file in Path(cache).rglob(f"*.{broken}") if broken else ():
            file.write_bytes(file.read_bytes()[:20])
        done = subprocess.run(
            [sys.executable, "-c", "import adding"], env=environment, capture_output=True, text=True
        )
        assert done.stderr == ""
        hits.append(done.stdout.strip())
    assert hits == ["0", "1", "0", "1", "0", "1"]


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
