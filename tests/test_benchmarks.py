"""The arithmetic under the benchmarks' figures."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import benchmarks
from benchmarks.cold_start import import_times
from benchmarks.common import percentile, record, times, wilson
from benchmarks.scale import exponent


def test_wilson_interval_is_the_published_one() -> None:
    assert wilson(0, 10) == pytest.approx((0.0, 0.2775), abs=1e-4)  # Newcombe 1998, table I
    assert wilson(15, 148) == pytest.approx((0.0624, 0.1605), abs=1e-4)
    assert wilson(100, 100)[0] == pytest.approx(0.9630, abs=1e-4)
    assert wilson(0, 0) == (0.0, 1.0)


def test_percentiles_of_nothing_are_not_a_number() -> None:
    assert percentile([3.0, 1.0, 2.0], 50) == 2.0
    assert np.isnan(percentile([], 50))
    assert times([], "ms")["median [ms]"] == "nan"
    assert times([0.001, 0.003], "ms")["mean [ms]"] == "2"


def test_a_record_says_where_it_comes_from(tmp_path: Path) -> None:
    file = tmp_path / "deep" / "x.jsonl"
    for seed in (1, 2):
        record(file, seed=seed, config={"problem": "swap"}, path=np.zeros(2), broken=float("nan"))
    lines = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]
    assert [line["seed"] for line in lines] == [1, 2]
    assert lines[0]["path"] == [0.0, 0.0]
    assert lines[0]["broken"] is None
    assert {"commit", "machine", "python", "numpy", "load", "config"} <= lines[0].keys()


def test_import_times_add_up_by_package() -> None:
    log = (
        "import time: self [us] | cumulative | imported package\n"
        "import time:       100 |        100 |   numpy.core\nimport time:       200 |        300 | numpy\n"
    )
    assert import_times(log) == pytest.approx({"numpy": 300e-6})


def test_the_exponent_of_growth() -> None:
    assert exponent(0.5, 0.5 * 5.0**1.7, 5.0) == pytest.approx(1.7)


@pytest.mark.parametrize(
    "script",
    [
        one
        for one in sorted(Path(benchmarks.__path__[0]).glob("*.py"))
        if "__main__" in one.read_text(encoding="utf-8")
    ],
    ids=lambda script: script.stem,
)
def test_a_script_parses_its_command_line_before_it_does_anything(script: Path) -> None:
    last = script.read_text(encoding="utf-8").split('if __name__ == "__main__":')[1]
    parsers = ("tyro.cli", "parse_args", "parse_known_args", "without_options")
    whole = script.read_text(encoding="utf-8")
    assert any(f"{one}(" in last for one in parsers) or any(
        f"{one}(" in whole for one in parsers[:3]
    )
