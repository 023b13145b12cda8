"""One run of a benchmark: whatever happens in it, a line of results comes back."""

from __future__ import annotations

import json
import pickle
from pathlib import Path

from tamp.benchmark.case import Case, cases, labelled, relations
from tamp.benchmark.line import read_line
from tamp.benchmark.run_case import ERROR, run_case
from tamp.benchmark.table import report
from tests.benchmark.samplers import KNOWN, MINE


def test_an_error_of_the_planner_is_an_outcome() -> None:
    told = run_case(Case("swap", "default", 0, 1.0, samplers=(("on", "nobody"),)), dict)
    assert told["outcome"] == ERROR and not told["solved"]
    assert "nobody" in told["explanation"][-1]


def test_a_run_with_a_python_file_needs_no_file(tmp_path: Path) -> None:
    """As on another machine of a cluster; what its sampler does wrong stands in the line and in the report."""
    file = tmp_path / "mine.py"
    file.write_text(MINE.replace("return []", "raise ValueError('mine')"))
    served = relations(f"on={file}", KNOWN)
    label, sources = labelled(f"on={file}", served)
    (case,) = cases(["one_object"], {label: served}, [0], 30.0, sources=sources)
    file.unlink()
    line = run_case(pickle.loads(pickle.dumps(case)), dict)
    assert line["outcome"] == "SOLVED" and line["verified"]
    assert line["config"]["sampler"] == label
    assert line["config"]["samplers"] == {"on": str(file)}
    assert read_line(json.dumps(line).encode(), file, 1) == json.loads(json.dumps(line))
    shown = report([line])
    assert "Samplers that were sidelined:\n1 x on=" in shown
    assert "ValueError: mine" in shown
