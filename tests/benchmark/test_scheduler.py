"""Workers that die lose no run and double none."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from tamp.benchmark.log import RunLog, read_log
from tamp.benchmark.process_pool import ProcessPool
from tamp.benchmark.ray_pool import LOCAL, RayPool
from tamp.benchmark.scheduler import ATTEMPTS, LOST, run_all
from tamp.benchmark.worker_pool import WorkerPool
from tests.benchmark.toys import die, note, nothing, some

RUNS = 6


def ray(work: Callable[..., Any]) -> WorkerPool:
    return RayPool(LOCAL, work, nothing, 2)


def processes(work: Callable[..., Any]) -> WorkerPool:
    return ProcessPool(2, work, nothing)


@pytest.mark.parametrize("pool", [processes, pytest.param(ray, marks=pytest.mark.slow)])
@pytest.mark.filterwarnings("default")  # Ray's own
def test_a_killed_worker_loses_no_run_and_doubles_none(
    pool: Callable[..., WorkerPool], tmp_path: Path
) -> None:
    traces = tmp_path / "traces"
    traces.mkdir()
    left: list[int] = []
    with (
        RunLog(tmp_path / "log.jsonl") as log,
        closing(pool(partial(note, folder=traces))) as workers,
    ):
        run_all(some(2)[:1], workers, log, lambda line, _: None)
        run_all(some(RUNS), workers, log, lambda line, count: left.append(count))
    lines = read_log(tmp_path / "log.jsonl")
    assert sorted(line["seed"] for line in lines) == list(range(RUNS))
    assert all(line["solved"] for line in lines)
    tries = {seed: len(list(traces.glob(f"{seed}.*"))) for seed in range(RUNS)}
    assert tries == {seed: 2 if seed == 1 else 1 for seed in range(RUNS)}
    assert left == list(range(RUNS - 2, -1, -1))
    killed = (traces / "1.0").read_text(encoding="utf-8")
    assert killed not in {str(line["pid"]) for line in lines if line["seed"] > 1}


def test_a_run_that_kills_every_worker_is_written_down_as_lost(tmp_path: Path) -> None:
    with RunLog(tmp_path / "log.jsonl") as log, closing(processes(die)) as workers:
        run_all(some(2), workers, log, lambda line, _: None)
    by_seed = {line["seed"]: line for line in read_log(tmp_path / "log.jsonl")}
    assert by_seed[0]["outcome"] == LOST and not by_seed[0]["solved"]
    assert str(ATTEMPTS) in by_seed[0]["explanation"][0]
    assert by_seed[1]["solved"]
