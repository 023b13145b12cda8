"""The arithmetic of the tables, and that they and the pictures show it."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import pytest

from tamp.benchmark.picture import draw
from tamp.benchmark.summary import percentile, summaries, wilson
from tamp.benchmark.table import report
from tamp.errors import InputError
from tests.benchmark.toys import TIMEOUT, line, some

PARTS = {"symbolic": 1.0, "motion": 3.0}


def results() -> list[dict]:
    """Default solves all four seeds in 1, 2, 3, 4 s; uniform two of them in 10 and 10 s, and one plan is refused."""
    default, uniform = some(4), some(4, ("uniform",))
    return [
        *(
            line(case, 1.0 + case.seed, parts_s=PARTS, cpu_s=0.5, commit="abc", load=1.0)
            for case in default
        ),
        *(line(case, 10.0, parts_s=PARTS, load=2.5) for case in uniform[:2]),
        line(uniform[2], 5.0, verified=False),
        line(uniform[3], 30.1, **TIMEOUT),
    ]


def test_wilson_interval_is_the_published_one() -> None:
    assert wilson(0, 10) == pytest.approx((0.0, 0.2775), abs=1e-4)  # Newcombe 1998, table I
    assert wilson(15, 148) == pytest.approx((0.0624, 0.1605), abs=1e-4)
    assert wilson(0, 0) == (0.0, 1.0)


def test_percentiles_know_infinity() -> None:
    assert percentile([1.0, 2.0, 3.0], 50) == 2.0
    assert percentile([1.0, 2.0, 3.0, 4.0], 50) == 2.5
    assert percentile([1.0, math.inf, math.inf], 50) == math.inf
    assert percentile([1.0, 2.0, math.inf], 50) == 2.0
    assert percentile([1.0, 2.0, math.inf], 95) == math.inf
    assert math.isnan(percentile([], 50))


def test_a_summary_counts_what_the_judge_accepts() -> None:
    default, uniform = summaries(results(), "uniform")
    assert (default.solved, default.runs, default.median, default.par2) == (4, 4, 2.5, 2.5)
    assert (uniform.solved, uniform.rejected, uniform.broken) == (2, 1, 0)
    assert uniform.median == math.inf
    assert uniform.par2 == (10 + 10 + 60 + 60) / 4
    assert default.speedup == (10 / 1 + 60 / 4) / 2  # of 10/1, 10/2, 60/3, 60/4
    assert uniform.speedup is None
    assert default.parts == PARTS


def test_the_tables_say_it() -> None:
    text = report(results(), "uniform")
    assert "| swap    | default |    4/4 | 0.51-1.00 |       2.50 |" in text
    assert ">30" in text
    assert "12x" in text
    assert "3.000 (75 %)" in text
    assert "8 runs of 30 s, adaptive" in text
    assert "Commit abc" in text and "load 1.0-2.5" in text


def test_the_pictures_are_drawn_from_any_results(tmp_path: Path) -> None:
    unsolved = line(some(1, ("never",))[0], 30.0, **TIMEOUT)
    written = draw([*results(), unsolved], tmp_path / "deep")
    assert [path.name for path in written] == ["success.png", "ecdf.png", "cactus.png", "parts.png"]
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in written)


def test_pictures_without_matplotlib_or_a_folder_are_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match="cannot be written"):
        draw(results(), tmp_path / "file")
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(InputError, match=r"pip install 'tamp-planner\[bench\]'"):
        draw(results(), tmp_path)
