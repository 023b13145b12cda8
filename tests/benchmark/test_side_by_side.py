"""Ratios of paired runs: a run without a plan takes for ever, and is not left out."""

from __future__ import annotations

import math

from benchmarks.side_by_side import cost_of, ratio, spent_of


def test_a_run_without_a_plan_is_infinite() -> None:
    lost: dict[str, object] = {"cpu_s": 3.0, "cost": None}
    won: dict[str, object] = {"cpu_s": 3.0, "start_s": 1.0, "cost": 7.0}
    assert spent_of(lost) == cost_of(lost) == math.inf
    assert (spent_of(won), cost_of(won)) == (2.0, 7.0)


def test_ratios_count_what_one_side_has_not_solved() -> None:
    assert ratio([math.inf, math.inf, 1.0], [1.0, 2.0, 1.0]) == math.inf
    assert ratio([1.0], [math.inf]) == 0.0
    assert ratio([2.0, math.inf], [1.0, math.inf]) == 2.0
    assert math.isnan(ratio([math.inf], [math.inf]))
