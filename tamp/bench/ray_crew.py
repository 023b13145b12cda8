"""Runs on a Ray cluster (`pip install tamp[ray]`). Every machine of it needs this environment, tamp installed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from tamp.bench.case import Case
from tamp.bench.crew import GRACE, Work
from tamp.errors import InputError

LOCAL = "local"
"""The address that starts a Ray of this machine's own."""


class RayCrew:
    """Tasks on a Ray cluster, one a core.

    Args:
        address: Of the cluster ("auto", "ray://host:10001", "host:6379"), or "local".
        work: What they do.
        prepare: Called in each worker's process before its first run.
        size: Runs at a time; as many as the cluster has cores when not given.

    Raises:
        InputError: Ray is not installed, or there is no cluster at this address.
    """

    def __init__(self, address: str, work: Work, prepare: Callable[[], None], size: int | None = None) -> None:
        try:
            import ray
        except ImportError:
            raise InputError("--ray needs Ray, which is not installed", remedy="pip install 'tamp[ray]'") from None
        self._ray = ray
        try:
            if address == LOCAL:
                ray.init(num_cpus=size, include_dashboard=False, log_to_driver=False)
            else:
                ray.init(address=address, log_to_driver=False)
        except Exception as error:  # Ray says it in many ways
            what = f"no Ray cluster at '{address}': {error}".splitlines()[0]
            raise InputError(what, remedy="Start one with 'ray start --head', or say --ray local") from None
        self.size = size or int(ray.cluster_resources().get("CPU", 1))
        # A lost run is given out again by whoever leads, who knows what was written down: Ray does not retry.
        self._do = ray.remote(num_cpus=1, max_retries=0)(_Prepared(work, prepare).call)
        self._under_way: dict[Any, Case] = {}

    def start(self, case: Case) -> None:
        """Hand a run to the cluster."""
        self._under_way[self._do.remote(case)] = case

    def finished(self) -> list[tuple[Case, dict[str, Any] | None]]:
        """Runs that have ended since; waits a fifth of a second at most."""
        ready, _ = self._ray.wait(list(self._under_way), num_returns=1, timeout=0.2)
        ended: list[tuple[Case, dict[str, Any] | None]] = []
        for reference in ready:
            case = self._under_way.pop(reference)
            try:
                ended.append((case, self._ray.get(reference, timeout=GRACE)))
            except self._ray.exceptions.RayTaskError:
                raise
            except self._ray.exceptions.RayError:  # its worker, its machine or the way to it is gone
                ended.append((case, None))
        return ended

    def close(self) -> None:
        """Leave the cluster; one of our own ends."""
        self._ray.shutdown()


class _Prepared:
    """The work, after each process has prepared itself once."""

    def __init__(self, work: Work, prepare: Callable[[], None]) -> None:
        self._work, self._prepare = work, prepare

    def call(self, case: Case) -> dict[str, Any]:
        """Do a run."""
        raise NotImplementedError
