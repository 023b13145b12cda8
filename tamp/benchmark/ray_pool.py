"""Runs on a Ray cluster (`pip install 'tamp-planner[ray]'`).

Every machine of it needs this environment, tamp installed. It stays beside the process pool, which
knows one machine only, because it costs one file, an extra, and nothing where it is not asked for.
"""

from __future__ import annotations

import os
import socket
import time
from collections.abc import Callable
from functools import cache
from typing import Any, Generic

from tamp.benchmark.worker_pool import GRACE, R
from tamp.errors import InputError
from tamp.system import guard
from tamp.system.distribution import install_command

LOCAL = "local"
"""The address that starts a Ray of this machine's own."""

REMEDY = "Start one with 'ray start --head', or say --ray local"

ANSWERING = 10.0
"""Seconds that a cluster may take to take up a connection."""

STARTING = 300.0
"""Seconds that a cluster may take to find a place for a run."""


class RayPool(Generic[R]):
    """Tasks on a Ray cluster, one a core.

    Args:
        address: Of the cluster ("auto", "ray://host:10001", "host:6379"), or "local".
        work: What they do; never None comes out.
        prepare: Called in each worker's process before its first run.
        size: Runs at a time; as many as the cluster has cores when not given.

    Raises:
        InputError: Ray is not installed, or there is no cluster at this address.
    """

    def __init__(
        self,
        address: str,
        work: Callable[[R], Any],
        prepare: Callable[[], None],
        size: int | None = None,
    ) -> None:
        _check_somebody_listens(address)
        os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")  # nobody else is told
        os.environ.setdefault("RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO", "0")
        try:
            import ray
        except ImportError:
            raise InputError(
                "--ray needs Ray, which is not installed", remedy=install_command("ray")
            ) from None

        self._ray: Any = ray
        quiet = {"log_to_driver": False, "logging_level": "error"}

        try:
            if address == LOCAL:
                ray.init(address=LOCAL, num_cpus=size, include_dashboard=False, **quiet)
            else:
                ray.init(address=address, **quiet)
        except Exception as error:  # Ray says it in many ways
            said = str(error).strip().splitlines() or [type(error).__name__]
            raise InputError(f"no Ray cluster at '{address}': {said[0]}", remedy=REMEDY) from None

        guard.listen()  # Ray has taken SIGTERM for itself
        self.size = size or max(1, int(ray.cluster_resources().get("CPU", 1)))
        # A lost run is given out again by whoever leads, who knows what was written down: Ray does
        # not retry.
        self._do: Any = ray.remote(num_cpus=1, max_retries=0)(_prepared_work)
        self._job = (work, prepare)
        self._under_way: dict[Any, tuple[R, float]] = {}

    def start(self, case: R) -> None:
        """Hand a run to the cluster."""
        self._under_way[self._do.remote(*self._job, case)] = case, time.monotonic()

    def finished(self) -> list[tuple[R, Any]]:
        """Return runs that have ended since, with what came out, None for a lost worker; waits for
        a fifth of a second at most.
        """
        ready, pending = self._ray.wait(list(self._under_way), num_returns=1, timeout=0.2)
        ended: list[tuple[R, Any]] = []
        for reference in ready:
            case, _ = self._under_way.pop(reference)
            try:
                ended.append((case, self._ray.get(reference, timeout=GRACE)))
            except (
                self._ray.exceptions.RayTaskError
            ) as error:  # not lost: it cannot be done there at all
                said = str(error.cause)
                raise InputError(
                    f"a worker of the cluster failed: {said}", remedy="Is tamp installed there?"
                ) from None
            except (
                self._ray.exceptions.RayError
            ):  # its process, its machine or the way to it is gone
                ended.append((case, None))

        for reference in pending:
            case, since = self._under_way[reference]
            if time.monotonic() - since > case.time + GRACE + STARTING:
                self._ray.cancel(reference, force=True)
                del self._under_way[reference]
                ended.append((case, None))

        return ended

    def close(self) -> None:
        """Leave the cluster; one of our own ends. In a command that was asked to end, all of that
        is who guards it.
        """
        if not guard.asked():
            self._ray.shutdown()


def _check_somebody_listens(address: str) -> None:
    """Check that a cluster answers: Ray itself tries for minutes before it says that nobody is
    there.
    """
    host, _, port = address.removeprefix("ray://").rpartition(":")
    if not host or not port.isdigit():
        return
    try:
        socket.create_connection((host, int(port)), timeout=ANSWERING).close()
    except (OSError, OverflowError) as error:
        raise InputError(f"no Ray cluster at '{address}': {error}", remedy=REMEDY) from None


def _prepared_work(work: Callable[[R], Any], prepare: Callable[[], None], case: R) -> Any:
    _prepare_once(prepare)
    return work(case)


@cache
def _prepare_once(prepare: Callable[[], None]) -> None:
    """Prepare the process, once for each."""
    prepare()
