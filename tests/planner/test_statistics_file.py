"""--statistics: what streams did is kept from run to run, in a file that is read with care."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tamp.commands.solve import BAD_INPUT, SOLVED, run
from tamp.planner.statistics_file import read_statistics
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
