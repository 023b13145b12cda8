"""When the packed search's compiled loop is taken: once it pays, and if it was made of these sources."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import pytest

from tamp.symbolic.search.packed import selection


def test_plain_python_is_left_when_it_has_done_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "tamp.symbolic.search.packed.compiled", raising=False)
    beside = selection.LOAD_BESIDE_NUMBA_THRESHOLD
    for numba, kept, enough in (
        (True, False, selection.COMPILE_THRESHOLD),
        (True, True, beside),
        (False, True, selection.LOAD_THRESHOLD),
    ):
        if numba:
            monkeypatch.setitem(sys.modules, "numba", sys)
        else:
            monkeypatch.delitem(sys.modules, "numba")
        fresh = replace(selection.THRESHOLD, entries=0, enough=None)
        monkeypatch.setattr(selection, "THRESHOLD", fresh)
        monkeypatch.setattr(selection, "compiled_before", lambda kept=kept: kept)
        assert not selection.pays(enough)
        assert selection.pays(1)


def test_only_what_was_made_of_these_sources_counts_as_compiled(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    (tmp_path / "__pycache__").mkdir()
    for name in selection.SOURCES:
        (tmp_path / f"{name}.py").write_text(name)
    monkeypatch.setattr(selection, "FOLDER", tmp_path)
    for name in selection.KEPT:
        assert not selection.compiled_before()
        (tmp_path / "__pycache__" / f"x.{name}_{selection.digest()}-7.py311.nbi").write_text("")
    assert selection.compiled_before()
    (tmp_path / f"{selection.SOURCES[0]}.py").write_text("another")
    assert not selection.compiled_before()
