"""The time that the user gives is kept, whatever a sampler does; and the reason names the objects."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks.interrupts import members
from tamp.geometric.context import Context
from tamp.planner.problem import Problem, load_problem
from tamp.planner.solution import Solution
from tamp.planner.solve import solve
from tamp.stream import Call, Rejection
from tamp.symbolic.algorithms.result import Outcome
from tests.clock import unhindered, waited
from tests.commands.test_solve import ENCLOSED, SOLVE

BUDGET = 1.0
LATE = 1.0  # half of it is promised on an idle machine; the tests share theirs
"""Seconds after the budget that are allowed, as the README promises."""

Function = Callable[..., Any]


def endless(context: Context, *inputs: object, call: Call) -> Iterator[object]:
    """Never yields."""
    while True:
        pass
    yield


def sleeping(context: Context, *inputs: object, call: Call) -> Iterator[object]:
    time.sleep(3600.0)
    yield


def sleeping_test(context: Context, *inputs: object, call: Call) -> bool:
    time.sleep(3600.0)
    return True


def rejecting(context: Context, *inputs: object, call: Call) -> Iterator[object]:
    """Never ends, never gives a value."""
    while True:
        yield Rejection("dislikes it")


def swallowing(context: Context, *inputs: object, call: Call) -> Iterator[object]:
    """Catches whatever is raised at it, and goes on."""
    while True:
        try:
            while True:
                time.sleep(0.01)
        except Exception:
            continue
    yield


def swallowing_once(context: Context, *inputs: object, call: Call) -> Iterator[object]:
    """Catches even what is not meant to be caught, and then goes on as if nothing had been."""
    try:
        while True:
            time.sleep(0.01)
    except BaseException:
        yield Rejection("interrupted")
    while True:
        time.sleep(0.01)


def swallowing_everything(context: Context, *inputs: object, call: Call) -> Iterator[object]:
    """Catches whatever can be caught, for ever."""
    while True:
        try:
            while True:
                time.sleep(0.01)
        except BaseException:
            continue
    yield


def compiled(context: Context, *inputs: object, call: Call) -> Iterator[object]:
    """Long calls that the interpreter cannot interrupt."""
    matrix = np.eye(600)
    while True:
        matrix = matrix @ matrix
    yield


def slow_rejections(context: Context, *inputs: object, call: Call) -> Iterator[object]:
    while True:
        time.sleep(0.3)
        yield Rejection("slow")


def timed(
    problem: Problem, budget: float = BUDGET, algorithm: str = "adaptive"
) -> tuple[Solution, float]:
    started = unhindered()
    solution = solve(problem, max_time=budget, seed=0, algorithm=algorithm)
    return solution, unhindered() - started


@pytest.mark.parametrize(
    ("stream", "function", "algorithm"),
    [
        ("sample-on", endless, "adaptive"),
        ("sample-on", sleeping, "adaptive"),
        ("sample-on", rejecting, "adaptive"),
        ("sample-on", swallowing, "adaptive"),
        ("sample-on", swallowing_once, "adaptive"),
        ("sample-on", swallowing_everything, "adaptive"),
        ("sample-on", compiled, "adaptive"),
        ("sample-on", slow_rejections, "adaptive"),
        ("sample-grasp", endless, "adaptive"),
        ("test-reachable", sleeping_test, "adaptive"),
        ("inverse-kinematics", rejecting, "adaptive"),
        ("plan-pick", sleeping, "adaptive"),
        ("plan-base-motion", rejecting, "adaptive"),
        ("sample-on", endless, "incremental"),
        ("inverse-kinematics", rejecting, "incremental"),
        ("plan-pick", sleeping, "incremental"),
    ],
)
@pytest.mark.filterwarnings(
    "ignore::pytest.PytestUnraisableExceptionWarning"
)  # the alarm may ring in a gc callback
def test_a_sampler_that_never_ends(stream: str, function: Function, algorithm: str) -> None:
    problem = load_problem("one_object", functions={stream: function})
    solution, seconds = timed(problem, algorithm=algorithm)
    assert seconds < BUDGET + LATE
    assert solution.outcome in (Outcome.TIMEOUT, Outcome.EXHAUSTED), solution.outcome
    assert not solution.plan and solution.explanation
    if solution.outcome is Outcome.EXHAUSTED:
        assert function is rejecting


def test_a_generator_that_never_ends() -> None:
    """The same for an object that grounds a relation."""

    class Endless:
        def propose(
            self, scene: object, arguments: object, count: int, rng: object
        ) -> list[object]:
            while True:
                time.sleep(0.01)

    alone = load_problem("one_object", groundings={"on": Endless()}, samplers={"on": "given:alone"})
    solution, seconds = timed(alone)
    assert seconds < BUDGET + LATE and solution.outcome is Outcome.TIMEOUT
    assert "soup_can" in "\n".join(solution.explanation), solution.explanation


@pytest.mark.parametrize("algorithm", ["adaptive", "incremental"])
def test_no_plan_that_cannot_be_proven_names_the_object(algorithm: str, tmp_path: Path) -> None:
    (tmp_path / "enclosed.yaml").write_text(ENCLOSED)
    budget = 4.0
    solution, seconds = timed(load_problem(tmp_path / "enclosed.yaml"), budget, algorithm)
    assert seconds < budget + LATE
    assert solution.outcome in (Outcome.TIMEOUT, Outcome.EXHAUSTED, Outcome.INFEASIBLE)
    text = "\n".join(solution.explanation)
    assert "can" in text and any(
        wall in text for wall in ("north", "south", "east", "west", "lid")
    ), text


@pytest.mark.parametrize("budget", [1e-6, 0.05, 0.3])
def test_a_very_short_budget(budget: float) -> None:
    """A fast machine may find a plan in 0.3 s; none finds one in a microsecond."""
    solution, seconds = timed(load_problem("eight_objects"), budget)
    assert seconds < budget + LATE
    assert solution.outcome is Outcome.TIMEOUT or (solution.solved and budget > 1e-6)
    assert solution.solved or solution.explanation


def test_the_alarm_is_disarmed_afterwards() -> None:
    timed(load_problem("one_object", functions={"sample-on": sleeping}), 0.3)
    time.sleep(0.5)  # an alarm that still rings would raise here


def test_the_whole_command_keeps_the_time(tmp_path: Path) -> None:
    """From the start of the process, loading included; what it has to wait for a core does not count."""
    (tmp_path / "enclosed.yaml").write_text(ENCLOSED)
    words = [SOLVE, "enclosed.yaml", "--algorithm", "incremental", "--time", "6", "--json"]
    started = time.monotonic()
    pipe, queued = subprocess.PIPE, 0.0
    with subprocess.Popen(
        words, cwd=tmp_path, stdout=pipe, stderr=pipe, text=True, start_new_session=True
    ) as process:
        while process.poll() is None:  # it says less than a pipe holds
            queued = max(
                [queued, *map(waited, members(process.pid))]
            )  # the one who works, not the one who watches
            time.sleep(0.02)
        out, err = process.communicate(timeout=60)
    seconds = time.monotonic() - started - queued
    assert process.returncode == 1, out + err
    assert json.loads(out)["outcome"] == "timeout"
    assert seconds < 6.0 + LATE + 2.0
    assert sys.platform != "linux" or not (tmp_path / "plan.json").exists()
