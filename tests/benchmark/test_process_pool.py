"""Processes of this machine: one that cannot start is an error, one that hangs is ended."""

from __future__ import annotations

from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest

from tamp.benchmark import process_pool
from tamp.benchmark.log import RunLog
from tamp.benchmark.process_pool import ProcessPool
from tamp.benchmark.scheduler import run_all
from tamp.benchmark.worker_pool import Ended
from tamp.errors import InputError
from tests.benchmark.toys import die, hang, nothing, refuse, some


def test_workers_that_cannot_start_are_an_error_and_no_results(tmp_path: Path) -> None:
    with RunLog(tmp_path / "log.jsonl") as log, closing(ProcessPool(1, die, refuse)) as workers:
        with pytest.raises(InputError, match="before its first run"):
            run_all(some(2), workers, log, lambda line, _: None)
        assert log.lines == []


def test_a_run_that_hangs_is_lost_and_the_next_one_gets_a_process_of_its_own(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(process_pool, "GRACE", 0.0)
    hanging, usual = (
        replace(case, time=time) for case, time in zip(some(2), (0.1, 600.0), strict=True)
    )
    with closing(ProcessPool(1, hang, nothing)) as workers:
        workers.start(hanging)
        assert heard(workers) == [(hanging, None)]
        workers.start(usual)
        ((case, told),) = heard(workers)
    assert case == usual and told is not None and told["seed"] == 1


def heard(workers: ProcessPool) -> list[Ended]:
    """Wait until a run has ended."""
    while not (ended := workers.finished()):
        pass
    return ended
