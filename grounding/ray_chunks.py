"""Chunks of a data set made on a Ray cluster, which may lose workers on the way."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial

from tamp.benchmark.ray_pool import RayPool
from tamp.benchmark.scheduler import ATTEMPTS, dispatch
from tamp.errors import InputError
from tamp.system import guard

TIME = 3600.0
"""Seconds after which a chunk is given up; a hundred scenes take a few."""


@dataclass(frozen=True)
class ChunkRun:
    """A chunk as a cluster's worker is given it.

    Attributes:
        number: Which chunk.
        time: Its budget, seconds.
    """

    number: int
    time: float = TIME


def ray_results(
    make: Callable[[int], bytes], numbers: Sequence[int], address: str, workers: int | None
) -> Iterator[tuple[int, bytes]]:
    """Make chunks on a cluster, each once; yields them as they come.

    Args:
        make: Makes the chunk of a number; it is sent to the workers.
        numbers: Of the chunks.
        address: Of the cluster, see RayPool.
        workers: Chunks at a time; as many as the cluster has cores when not given.

    Raises:
        InputError: Ray is not installed, no cluster is there, a chunk cannot be made there, or its
            worker was lost each time.
    """
    if not numbers:
        return
    with closing(RayPool[ChunkRun](address, partial(_made, make), _nothing, workers)) as pool:
        for run, content, _ in dispatch([ChunkRun(number) for number in numbers], pool):
            if guard.asked():  # what it raised was dropped
                raise KeyboardInterrupt
            if content is None:
                what = f"the workers of chunk {run.number} were lost {ATTEMPTS} times"
                raise InputError(what, remedy="The same command goes on with what is there")
            yield run.number, content


def _made(make: Callable[[int], bytes], run: ChunkRun) -> bytes:
    return make(run.number)


def _nothing() -> None:
    """Prepare nothing."""
