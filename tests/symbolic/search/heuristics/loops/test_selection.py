"""When the heuristics' compiled loops are taken: once they pay, and as compiled counts what numba keeps and is new."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace

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


def test_what_was_compiled_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """Beside the sources, where numba puts it unless a variable or a read-only folder has it put it elsewhere."""
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    code = (
        "from tamp.symbolic.search.heuristics.loops import selection; "
        "selection.load(); print(selection.compiled_before())"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "True"
