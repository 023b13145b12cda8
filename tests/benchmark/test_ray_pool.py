"""Runs on a Ray cluster: where there is none, one is told at once what to do."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest

from tamp.benchmark import ray_pool
from tamp.benchmark.case import Case
from tamp.benchmark.ray_pool import RayPool
from tamp.errors import InputError
from tests.benchmark.toys import note, nothing, some


def test_without_ray_one_is_told_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(InputError, match=r"pip install 'tamp-planner\[ray\]'"):
        RayPool("auto", note, nothing)


@pytest.mark.parametrize(
    "address", ["127.0.0.1:1", "ray://127.0.0.1:1", "127.0.0.1:99999", "no.such.host.invalid:6379"]
)
def test_nobody_at_an_address_is_an_error_at_once(address: str) -> None:
    with pytest.raises(InputError, match=f"no Ray cluster at '{address}'"):
        RayPool(address, note, nothing)


@pytest.mark.slow
@pytest.mark.filterwarnings("default")
def test_no_cluster_at_an_address_is_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("RAY_TMPDIR", str(tmp_path))
    with pytest.raises(InputError, match="no Ray cluster at 'nonsense'"):
        RayPool("nonsense", note, nothing)


class TaskError(Exception):
    """What Ray raises when the work itself has raised."""

    cause = ModuleNotFoundError("No module named 'tamp'")


class Cluster:
    """Ray's module, of a cluster on which each task comes out as it is told."""

    exceptions = SimpleNamespace(RayTaskError=TaskError, RayError=Exception)

    def __init__(self, came_out: dict[int, object]) -> None:
        self.came_out = came_out
        self.cancelled: list[int] = []

    def init(self, **_: object) -> None:
        pass

    def cluster_resources(self) -> dict[str, float]:
        return {"CPU": 3.0}

    def remote(self, **_: object) -> Callable[..., SimpleNamespace]:
        return lambda work: SimpleNamespace(remote=lambda work, prepare, case: case.seed)

    def wait(self, under_way: list[int], **_: object) -> tuple[list[int], list[int]]:
        ready = [seed for seed in under_way if seed in self.came_out]
        return ready, [seed for seed in under_way if seed not in self.came_out]

    def get(self, seed: int, **_: object) -> object:
        found = self.came_out[seed]
        if isinstance(found, Exception):
            raise found
        return found

    def cancel(self, seed: int, **_: object) -> None:
        self.cancelled.append(seed)


@pytest.fixture
def pool_of(monkeypatch: pytest.MonkeyPatch) -> Callable[[Cluster], RayPool[Case]]:
    """A pool on such a cluster."""

    def make(cluster: Cluster) -> RayPool[Case]:
        monkeypatch.setitem(sys.modules, "ray", cluster)
        monkeypatch.setattr(ray_pool.guard, "listen", nothing)
        return RayPool("auto", note, nothing)

    return make


def test_a_lost_worker_and_a_run_that_hangs_come_back_as_none(
    pool_of: Callable[[Cluster], RayPool[Case]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ray_pool, "STARTING", -1e9)
    cluster = Cluster({0: {"seed": 0}, 1: OSError("the machine is gone")})
    pool = pool_of(cluster)
    cases = some(3)
    assert pool.size == 3
    for case in cases:
        pool.start(case)
    assert pool.finished() == [(cases[0], {"seed": 0}), (cases[1], None), (cases[2], None)]
    assert cluster.cancelled == [2]


def test_a_run_within_its_time_goes_on(pool_of: Callable[[Cluster], RayPool[Case]]) -> None:
    cluster = Cluster({})
    pool = pool_of(cluster)
    pool.start(some(1)[0])
    assert pool.finished() == [] and cluster.cancelled == []


def test_work_that_no_worker_there_can_do_is_an_error(
    pool_of: Callable[[Cluster], RayPool[Case]],
) -> None:
    pool = pool_of(Cluster({0: TaskError()}))
    pool.start(some(1)[0])
    with pytest.raises(InputError, match=r"No module named 'tamp'.*Is tamp installed there"):
        pool.finished()
