from __future__ import annotations

import math
import signal
import subprocess
import sys
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.motion.sampling_based import JointSpace, PlaneSpace, connect
from tamp.geometric.scene.pose import Array
from tamp.system.deadline import Deadline, OutOfTime
from tests.clock import unhindered
from tests.geometric.motion.synthetic import Sampled, wall_with_gap

SPACE = JointSpace((-3.0,) * 7, (3.0,) * 7)
START, GOAL = np.array([-1.0, *[0.0] * 6]), np.array([1.0, *[0.0] * 6])


def _wall(a: Array, b: Array) -> bool:
    base = np.zeros(3)
    return Sampled(wall_with_gap, 0.05).edge_free(np.append(base, a), np.append(base, b))


def _search(
    seed: int,
    edge_free: Callable[[Array, Array], bool] = _wall,
    checks: int = 2000,
    seconds: float = 20.0,
):
    return connect(
        SPACE, START, [GOAL], edge_free, seed=seed, checks=checks, deadline=Deadline(seconds), reach=1.0
    )  # fmt: skip


def test_a_path_joins_start_and_goal_by_free_edges() -> None:
    path, checks = _search(1)
    assert path is not None and 0 < checks <= 2000
    assert np.array_equal(path[0], START) and np.array_equal(path[-1], GOAL)
    assert len(path) > 2
    assert all(_wall(a, b) for a, b in pairwise(path))


def test_a_goal_that_is_shut_in_does_not_hide_another() -> None:
    unreachable = np.array([1.0, *[0.0] * 5, 2.5])

    def edge_free(a: Array, b: Array) -> bool:
        return bool(a[6] < 2 and b[6] < 2) and _wall(a, b)

    path, _ = connect(
        SPACE, START, [unreachable, GOAL], edge_free, seed=1, checks=5000, deadline=Deadline(20), reach=1.0
    )  # fmt: skip
    assert path is not None and np.array_equal(path[-1], GOAL)


def test_the_seed_decides_in_one_process_whatever_ran_before() -> None:
    runs = [_search(seed) for seed in (1, 2, 1, 2, 1)]
    paths = [path for path, _ in runs if path is not None]
    assert len(paths) == len(runs)
    assert all(np.array_equal(paths[0], paths[i]) and runs[0][1] == runs[i][1] for i in (2, 4))
    assert np.array_equal(paths[1], paths[3])
    assert not np.array_equal(paths[0], paths[1])


def test_the_seed_decides_in_two_processes(root: Path) -> None:
    program = (
        "from tests.geometric.motion.test_sampling_based import _search; p, n = _search(7);"
        "import hashlib; print(n, hashlib.sha256(p.tobytes()).hexdigest())"
    )
    outputs = [
        subprocess.run(
            [sys.executable, "-c", program], cwd=root, capture_output=True, text=True, check=True
        )
        for _ in range(2)
    ]
    assert outputs[0].stdout == outputs[1].stdout and len(outputs[0].stdout.split()[1]) == 64
    assert outputs[0].stderr == ""


def test_an_infeasible_search_ends_after_its_checks() -> None:
    path, checks = _search(1, lambda _a, _b: False, checks=500)
    assert path is None and 500 <= checks <= 502


def test_an_infeasible_search_honours_the_deadline() -> None:
    began = unhindered()
    path, _ = _search(1, lambda _a, _b: False, checks=10**9, seconds=0.1)
    assert path is None and unhindered() - began < 0.3


@pytest.mark.parametrize("kind", [OutOfTime, KeyboardInterrupt])
def test_an_exception_from_a_signal_handler_reaches_the_caller(kind: type[BaseException]) -> None:
    def handler(*_: object) -> None:
        raise kind

    previous = signal.signal(signal.SIGALRM, handler)
    raised = 0
    try:
        for repetition in range(1, 6):
            signal.setitimer(signal.ITIMER_REAL, 0.02)
            with pytest.raises(kind):
                _search(repetition, lambda _a, _b: False, checks=10**9)
            raised += 1
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, previous)
    assert raised == 5
    assert _search(1)[0] is not None  # and the planner still works


def test_an_interrupted_process_dies_of_nothing_but_the_exception(root: Path) -> None:
    program = (
        "import signal; from tests.geometric.motion.test_sampling_based import _search\n"
        "def handler(*_): raise KeyboardInterrupt\n"
        "signal.signal(signal.SIGALRM, handler); signal.setitimer(signal.ITIMER_REAL, 0.05)\n"
        "try: _search(1, lambda a, b: False, checks=10**9)\n"
        "except KeyboardInterrupt: raise SystemExit(130)\n"
    )
    ended = subprocess.run(
        [sys.executable, "-c", program], cwd=root, capture_output=True, text=True, check=False
    )
    assert ended.returncode == 130 and ended.stderr == ""


def test_an_exception_in_the_checker_reaches_the_caller() -> None:
    def broken(_a: Array, _b: Array) -> bool:
        raise ValueError("from the checker")

    with pytest.raises(ValueError, match="from the checker"):
        _search(1, broken)


TURNS = [
    math.pi,
    -math.pi,
    3 * math.pi,
    math.radians(179.99999),
    math.nextafter(math.pi, 0.0),
    -3 * math.pi,
    0.0,
]


@pytest.mark.parametrize("radius", [None, 0.5])
@pytest.mark.parametrize("yaw", TURNS)
def test_no_yaw_makes_the_planner_wait(radius: float | None, yaw: float) -> None:
    plane = PlaneSpace((-2.0, 2.0), (-2.0, 2.0), radius)
    pillar = np.array([0.0, 0.0])

    def edge_free(a: Array, b: Array) -> bool:
        return all(
            float(np.linalg.norm(a[:2] + t * (b - a)[:2] - pillar)) > 0.5
            for t in np.linspace(0.0, 1.0, 30)
        )

    for start, goal in ((yaw, 1.0), (1.0, yaw), (yaw, yaw)):
        began = unhindered()
        ends = np.array([-1.5, 0.0, start]), np.array([1.5, 0.1, goal])
        path, checks = connect(
            plane, ends[0], [ends[1]], edge_free, seed=1, checks=3000, deadline=Deadline(20), reach=1.0
        )  # fmt: skip
        assert path is not None and checks > 0
        assert np.all(path[:, 2] >= -math.pi) and np.all(path[:, 2] < math.pi)
        assert unhindered() - began < 10


def test_ends_out_of_the_bounds_are_no_reason_to_wait() -> None:
    outside = np.array([3.5, *[0.0] * 6])
    nowhere = np.full(7, np.nan)
    for start, goals in (
        (outside, [GOAL]),
        (START, [outside]),
        (START, [nowhere]),
        (nowhere, [GOAL]),
    ):
        began = unhindered()
        path, checks = connect(
            SPACE, start, goals, _wall, seed=1, checks=2000, deadline=Deadline(20), reach=1.0
        )
        assert path is None and checks == 0
        assert unhindered() - began < 5
    path, _ = connect(
        SPACE, START, [outside, GOAL], _wall, seed=1, checks=2000, deadline=Deadline(20), reach=1.0
    )
    assert path is not None and np.array_equal(path[-1], GOAL)
