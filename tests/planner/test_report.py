"""The time in the summary and in the results of a benchmark: by the kinds of streams, not by their names."""

from __future__ import annotations

import re
from types import SimpleNamespace
from typing import Any

import pytest

from tamp.benchmark.run_case import PARTS, parts
from tamp.planner.report import summary, time_shares
from tamp.stream import StreamKind
from tamp.symbolic.algorithms.experience.stream_statistics import StreamStatistics
from tamp.symbolic.algorithms.result import Outcome, SearchStatistics


def spent(seconds: dict[str, float], kinds: dict[str, StreamKind]) -> Any:
    """What a solution says of its time; streams' statistics are those of its streams."""
    streams = [SimpleNamespace(name=name, kind=kind) for name, kind in kinds.items()]
    statistics = {name: StreamStatistics(seconds=seconds.get(name, 0.0)) for name in kinds}
    return SimpleNamespace(
        problem=SimpleNamespace(stream_task=SimpleNamespace(streams=streams)),
        seconds=seconds, statistics=statistics, warnings=(), solved=True, plan=(), duration=0.0,
        cost=0.0, improvements=(), bound=None, gap=None, effort=SearchStatistics(), samplers={},
        outcome=Outcome.SOLVED, explanation=(), tallies=(),
    )  # fmt: skip


KINDS = {
    "drive-there": StreamKind.MOTION, "plan-nothing": StreamKind.TESTS,
    "sample-grasp": StreamKind.GRASPS, "sample-x": StreamKind.PLACEMENTS, "ik2": StreamKind.IK,
    "weigh": StreamKind.OTHER,
}  # fmt: skip
SECONDS = {
    "total": 10.0, "search": 1.0, "drive-there": 2.0, "plan-nothing": 1.5, "sample-grasp": 0.5,
    "sample-x": 1.0, "ik2": 0.5, "weigh": 1.0, "timing": 0.5,
}  # fmt: skip


def test_the_summary_sorts_time_by_the_kind_of_a_stream_whatever_it_is_called() -> None:
    text = " ".join(summary(spent(SECONDS, KINDS)).partition("  time ")[2].split())
    assert text.startswith("10.0 s: ")
    told = dict(re.findall(r"([a-z][a-z ]*[a-z]) (\d+) %", text))
    assert told == {
        "motion": "20", "tests": "15", "placements": "10", "search": "10", "other streams": "10",
        "grasps": "5", "ik": "5", "timing": "5", "other": "20",
    }  # fmt: skip


def test_results_sort_it_in_a_robots_planners_words() -> None:
    assert PARTS.keys() == {*StreamKind}
    found = parts(spent(SECONDS, KINDS))
    assert list(found) == [
        "symbolic", "sampling", "ik", "collision", "motion", "other streams", "timing",
    ]  # fmt: skip
    assert found == pytest.approx(
        {"sampling": 1.5, "ik": 0.5, "collision": 1.5, "motion": 2.0, "other streams": 1.0,
         "timing": 0.5, "symbolic": 3.0}
    )  # fmt: skip


@pytest.mark.parametrize(
    ("parts", "total", "shares"),
    [
        ({"a": 1.0, "b": 1.0, "c": 1.0}, 3.0, [("a", 34), ("b", 33), ("c", 33)]),
        ({"a": 1.0}, 4.0, [("a", 25), ("other", 75)]),
        ({"a": 1.0, "b": 0.004}, 1.004, [("a", 100)]),
        ({"a": 3.0}, 2.0, [("a", 100)]),
    ],
)
def test_shares_are_whole_percents_of_100(
    parts: dict[str, float], total: float, shares: list[tuple[str, int]]
) -> None:
    assert time_shares(parts, total, "other") == shares
