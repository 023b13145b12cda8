"""When the heuristics' compiled loops are taken: once they pay, and as compiled counts what numba keeps and is new."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest

from tamp.symbolic.search.heuristics.loops import selection as tiers
from tamp.symbolic.search.heuristics.loops.compiled import COMPILED


def test_plain_python_is_left_when_it_has_done_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "tamp.symbolic.search.heuristics.loops.compiled")
    monkeypatch.setattr(tiers, "THRESHOLD", replace(tiers.THRESHOLD, entries=0, enough=None))
    monkeypatch.setattr(tiers, "compiled_before", lambda: False)
    assert tiers.choose(tiers.COMPILE_THRESHOLD) is tiers.PLAIN
    monkeypatch.undo()
    monkeypatch.setattr(tiers, "THRESHOLD", replace(tiers.THRESHOLD, entries=0, enough=None))
    assert tiers.choose(1) is COMPILED


def test_only_what_numba_has_all_of_and_newer_than_its_source_counts_as_compiled(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    (tmp_path / "__pycache__").mkdir()
    for module, _ in tiers.CACHED:
        source = tmp_path / Path(str(module.__file__)).name
        source.write_text("")
        monkeypatch.setattr(module, "__file__", str(source))
    for module, names in tiers.CACHED:
        for name in names:
            assert not tiers.compiled_before()
            (
                tmp_path / "__pycache__" / f"{Path(str(module.__file__)).stem}.{name}-7.py311.nbi"
            ).write_text("")
    assert tiers.compiled_before()
    later = time.time() + 10.0
    os.utime(tmp_path / "rows.py", (later, later))
    assert not tiers.compiled_before()


def test_what_was_compiled_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """Beside the sources, where numba puts it unless a variable or a read-only folder has it put it elsewhere."""
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    code = (
        "from tamp.symbolic.search.heuristics.loops import selection; "
        "selection.load(); print(selection.compiled_before())"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "True"
