"""What runs tell of streams is added up in a file; a solution's cost, duration and gap."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.planner.solution import Action, Solution
from tamp.planner.statistics_file import add_statistics, read_statistics
from tamp.planner.timed_trajectories import Segment, Trajectory
from tamp.symbolic.algorithms.experience.stream_statistics import StreamStatistics
from tamp.symbolic.algorithms.experience.success_posterior import Posterior
from tamp.symbolic.algorithms.result import Outcome


def ran(calls: int, successes: int, seconds: float = 0.5) -> StreamStatistics:
    made = StreamStatistics()
    made.calls, made.successes, made.seconds = calls, successes, seconds
    return made


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "s.json"


def test_runs_add_up(file: Path) -> None:
    assert read_statistics(file, "cupboard") == {}
    add_statistics(file, "cupboard", {"ik": ran(10, 4), "never": ran(0, 0)})
    total = add_statistics(file, "cupboard", {"ik": ran(5, 5, 1.0), "sample-on": ran(1, 0)})
    assert total == {"ik": Posterior(9, 6, 1.5), "sample-on": Posterior(0, 1, 0.5)}
    assert read_statistics(file, "cupboard") == total  # what was never called is not kept


def test_streams_stand_in_order_whole_and_with_their_mean(file: Path) -> None:
    add_statistics(file, "cupboard", {"b": ran(4, 3), "a": ran(1, 1)})
    document = json.loads(file.read_text())
    assert list(document["streams"]) == ["a", "b"]
    assert document["streams"]["b"]["mean"] == pytest.approx(Posterior(3, 1).mean, abs=1e-6)
    assert [path.name for path in file.parent.iterdir() if not path.name.startswith(".")] == [
        "s.json"
    ]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (
            {"format": "other"},
            "it is no 'tamp-statistics' file of version 1. Name another file, or delete this one",
        ),
        ({"version": 2}, "it is no 'tamp-statistics' file of version 1"),
        ({"domain": "other"}, "its statistics are of domain 'other', not 'cupboard'"),
        (
            {"streams": {"a": {"successes": 1.5, "failures": 0, "seconds": 0}}},
            "streams.a.successes: 1.5 is no whole",
        ),
        (
            {"streams": {"a": {"successes": 1, "failures": 0, "seconds": -1}}},
            "streams.a.seconds: -1 is less than 0",
        ),
        ({"streams": {"a": {"successes": 1}}}, "streams.a: 'failures' is missing"),
    ],
)
def test_a_file_that_is_none_of_ours_is_refused_and_stays(
    file: Path, change: dict[str, Any], words: str
) -> None:
    document = {
        "format": "tamp-statistics",
        "version": 1,
        "domain": "cupboard",
        "streams": {},
        **change,
    }
    file.write_text(json.dumps(document))
    with pytest.raises(InputError, match=words) as told:
        add_statistics(file, "cupboard", {"ik": ran(1, 1)})
    assert told.value.file == str(file) and json.loads(file.read_text()) == document


def action(cost: float, *seconds: float) -> Action:
    segments = (Segment("base", np.array([0.0, last]), np.zeros((2, 3)), 0.08) for last in seconds)
    return Action("move", (), (), Trajectory(tuple(segments)), 0.0, cost)


def solution(*actions: Action, bound: float | None = None) -> Solution:
    return Solution(None, Outcome.SOLVED, 0, "adaptive", actions, bound=bound)


def test_costs_and_durations_add_up() -> None:
    made = solution(action(1.0, 2.0, 0.5), action(2.5, 1.0))
    assert made.solved and (made.cost, made.duration) == (3.5, 3.5)
    assert action(1.0, 2.0, 0.5).trajectory.duration == 2.5 and solution().duration == 0.0


@pytest.mark.parametrize(
    ("cost", "bound", "gap"),
    [(4.0, 4.0, 0.0), (4.0, 3.0, 0.25), (4.0, 0.0, 1.0), (4.0, 5.0, 0.0), (0.0, 0.0, 0.0)],
)
def test_the_gap_is_the_share_of_the_cost_that_the_bound_leaves(
    cost: float, bound: float, gap: float
) -> None:
    assert solution(action(cost, 1.0), bound=bound).gap == pytest.approx(gap)


def test_without_a_bound_or_a_plan_there_is_no_gap() -> None:
    assert solution(action(1.0, 1.0)).gap is None and solution(bound=3.0).gap is None
