"""When compiled loops pay: at once where they are loaded, else after so much work in plain Python."""

from __future__ import annotations

import sys
import types
from pathlib import Path

import pytest

from tamp.symbolic.search.compilation_threshold import (
    CompilationThreshold,
    are_kept,
    digest_of,
)

MODULE = "loops_that_nobody_has"


def kept() -> bool:
    return True


def not_kept() -> bool:
    return False


def test_loops_on_disk_pay_once_loading_does() -> None:
    threshold = CompilationThreshold(MODULE, load=10, compile=100)
    assert [threshold.pays(5, kept) for _ in range(3)] == [False, False, True]


def test_loops_that_are_to_be_compiled_pay_later() -> None:
    threshold = CompilationThreshold(MODULE, load=10, compile=100)
    assert not threshold.pays(100, not_kept)
    assert threshold.pays(1, not_kept)


def test_the_disk_is_looked_at_once_and_not_before_loading_pays() -> None:
    asked = []

    def ask() -> bool:
        asked.append(True)
        return False

    threshold = CompilationThreshold(MODULE, load=10, compile=100)
    threshold.pays(10, ask)
    assert not asked
    threshold.pays(1, ask)
    threshold.pays(1, ask)
    assert len(asked) == 1


def test_what_is_loaded_pays_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, MODULE, types.ModuleType(MODULE))
    assert CompilationThreshold(MODULE, load=10, compile=100).pays(1, not_kept)


def test_work_is_counted_while_the_loops_are_loaded() -> None:
    threshold = CompilationThreshold(MODULE, load=10, compile=20)
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, MODULE, types.ModuleType(MODULE))
        threshold.pays(20, not_kept)
    assert threshold.pays(1, not_kept)


def test_loading_pays_sooner_where_numba_is_there_and_compiling_does_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made = {"load": 10, "compile": 100, "beside": 3}
    monkeypatch.setitem(sys.modules, "numba", types.ModuleType("numba"))
    assert [CompilationThreshold(MODULE, **made).pays(n, kept) for n in (3, 4)] == [False, True]
    assert [CompilationThreshold(MODULE, **made).pays(n, not_kept) for n in (4, 101)] == [
        False,
        True,
    ]

    monkeypatch.delitem(sys.modules, "numba")
    assert [CompilationThreshold(MODULE, **made).pays(n, kept) for n in (10, 11)] == [False, True]


def test_only_what_was_compiled_of_these_sources_is_kept(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    (tmp_path / "__pycache__").mkdir()
    for name in ("one", "other"):
        (tmp_path / f"{name}.py").write_text(name)

    def kept() -> bool:
        return are_kept(tmp_path, ["one", "other"], ["explore", "plan"])

    for kernel in ("explore", "plan"):
        assert not kept()
        made = digest_of(tmp_path, ["one", "other"])
        (tmp_path / "__pycache__" / f"x.{kernel}_{made}-7.py311.nbi").write_text("")
    assert kept()
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    assert not kept()  # nobody looks there
    monkeypatch.delenv("NUMBA_CACHE_DIR")
    (tmp_path / "other.py").write_text("another")
    assert not kept()
