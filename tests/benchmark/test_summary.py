"""The arithmetic of the tables, and that they show it."""

from __future__ import annotations

import math

import pytest

from tamp.benchmark.summary import percentile, summaries, wilson
from tamp.benchmark.table import report
from tests.benchmark.results import PARTS, results


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
