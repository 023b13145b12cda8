"""tamp-solve --optimize and what stands behind it: better plans until the time is up, the best one is kept."""

from __future__ import annotations

import json
import signal
from itertools import pairwise
from pathlib import Path

import pytest

from tamp.commands.solve import BAD_INPUT, SOLVED, run
from tamp.plan.write import plan_text
from tamp.planner.optimize import improves, optimize
from tamp.planner.problem import load_problem
from tamp.planner.solution import Solution
from tamp.verification.verify import verify


def test_plans_get_better_and_the_best_one_holds() -> None:
    told: list[Solution] = []
    solution = optimize(load_problem("one_object"), max_time=4.0, improved=told.append)
    assert solution.solved and len(told) == len(solution.improvements) >= 2
    assert all(improves(later, sooner) for sooner, later in pairwise(told))
    assert [step.duration for step in solution.improvements] == [plan.duration for plan in told]
    assert solution.duration == told[-1].duration < told[0].duration
    assert solution.bound == solution.cost == 4.0 and solution.gap == 0.0
    report = verify(json.loads(plan_text(solution)))
    assert report.holds, report.text()


def test_an_interruption_keeps_the_best_plan() -> None:
    def improved(solution: Solution) -> None:
        if len(solution.improvements) == 2:
            signal.raise_signal(signal.SIGINT)

    solution = optimize(load_problem("one_object"), max_time=60.0, improved=improved)
    assert solution.solved and len(solution.improvements) == 2
    assert solution.seconds["total"] < 60.0


def test_the_improvements_repeat_as_far_as_both_runs_came() -> None:
    runs: list[list[float]] = []
    for _ in range(2):
        solution = optimize(load_problem("one_object"), max_time=3.0, seed=4)
        runs.append([step.duration for step in solution.improvements])
    both = min(map(len, runs))
    assert both and runs[0][:both] == runs[1][:both]


def test_the_command_reports_each_improvement(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(["one_object", "--optimize", "--time", "3"]) == SOLVED
    lines = capsys.readouterr().out.splitlines()
    assert lines[1].endswith("cost 4, no plan below 4, gap 0 %")
    assert any("lower bound of the cost 4, gap 0 %" in line for line in lines)
    assert json.loads((tmp_path / "plan.json").read_text())["cost"] == 4.0
    assert run(["one_object", "--optimize", "--time", "3", "--json"]) == SOLVED
    document = json.loads(capsys.readouterr().out)["optimization"]
    assert (
        document["bound"] == 4.0
        and document["gap"] == 0.0
        and document["improvements"][0]["cost"] == 4.0
    )


def test_searches_are_not_chosen_for_it(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["one_object", "--optimize", "--algorithm", "incremental"]) == BAD_INPUT
    assert "--optimize has searches of its own" in capsys.readouterr().err
