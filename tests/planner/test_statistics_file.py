"""--statistics: what streams did is kept from run to run, in a file that is read with care."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tamp.commands.solve import BAD_INPUT, SOLVED, run
from tamp.errors import InputError
from tamp.planner.statistics_file import add_statistics, read_statistics
from tamp.symbolic.algorithms.experience.stream_statistics import StreamStatistics
from tamp.symbolic.algorithms.experience.success_posterior import Posterior


def plan(folder: Path, name: str = "one_object", *more: str) -> int:
    words = [
        name,
        "--statistics",
        str(folder / "s.json"),
        "--out",
        str(folder / "plan.json"),
        "--quiet",
        *more,
    ]
    return run(words)


def test_runs_add_up_and_the_plan_is_repeated_with_the_same_file(tmp_path: Path) -> None:
    assert plan(tmp_path) == SOLVED
    first = read_statistics(tmp_path / "s.json", "cupboard")
    assert first["inverse-kinematics"].successes >= 2 and first["plan-pick"].successes == 1
    saved = (tmp_path / "s.json").read_text(encoding="utf-8")
    assert plan(tmp_path) == SOLVED
    second = read_statistics(tmp_path / "s.json", "cupboard")
    assert second["plan-pick"].successes == 2
    assert all(second[name].successes >= first[name].successes for name in first)
    text = {"timing": None}
    made = json.loads((tmp_path / "plan.json").read_text(encoding="utf-8")) | text
    (tmp_path / "s.json").write_text(saved, encoding="utf-8")
    assert plan(tmp_path) == SOLVED
    assert json.loads((tmp_path / "plan.json").read_text(encoding="utf-8")) | text == made


def test_a_posterior() -> None:
    assert Posterior().mean == 0.5
    assert Posterior(8, 0).expected_failures < Posterior(1, 7).expected_failures
    assert Posterior(1, 2, 0.5) + Posterior(3, 4, 1.0) == Posterior(4, 6, 1.5)


HEAD = '{"format": "tamp-statistics", "version": 1, "domain": "cupboard"'


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{", "not JSON"),
        ("[]", "tamp-statistics"),
        (
            '{"format": "tamp-statistics", "version": 1, "domain": "other", "streams": {}}',
            "'other'",
        ),
        (HEAD + "}", "'streams' is missing"),
        (HEAD + ', "streams": {"plan-pick": {"successes": -1}}}', "plan-pick"),
        (
            HEAD + ', "streams": {"x": {"successes": 1, "failures": -1, "seconds": 0}}}',
            "streams.x.failures",
        ),
    ],
)
def test_a_broken_file_is_one_error_and_stays(
    text: str, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "s.json").write_text(text, encoding="utf-8")
    assert plan(tmp_path) == BAD_INPUT
    error = capsys.readouterr().err
    assert words in error and "s.json" in error and "Traceback" not in error
    assert (tmp_path / "s.json").read_text(encoding="utf-8") == text
    assert not (tmp_path / "plan.json").exists()


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
