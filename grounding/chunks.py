"""Data sets made by many processes, a chunk at a time: resumable, and the same bytes for the same
job.
"""

from __future__ import annotations

import io
import os
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from grounding.dataset import Dataset, write_dataset
from grounding.mesh_folder import MeshFolder
from grounding.objects import SPLITS, object_templates
from grounding.scenes import OTHERS, LabelledScene
from grounding.supports import FurnitureSupport
from tamp.errors import InputError
from tamp.system import guard
from tamp.system.files import write_whole
from tamp.system.outputs import UNFINISHED_NAME

CHUNK = 100
"""Scenes that one process makes before they are kept."""

LOOK = 0.2
"""Seconds between two looks whether somebody wants it to end."""

ROWS = 3 + max(most for _, most in OTHERS.values())
"""Bodies that a row has room for: the arguments, the other support, the others."""

RELATIONS = ("on", "inside")

Progress = Callable[[int, int], None]
"""Called with the scenes made so far and all."""


class ChunkJob(Protocol):
    """The specification of what is to be made; a process gets it as a whole, so it must be one that
    can be sent there.
    """

    @property
    def relation(self) -> str:
        """Return the relation, "on" or "inside"."""
        ...

    @property
    def split(self) -> str:
        """Return the split, "train" or "test"; they share no object and no support."""
        ...

    @property
    def count(self) -> int:
        """Return the number of scenes."""
        ...

    @property
    def seed(self) -> int:
        """Return the seed of all randomness."""
        ...

    @property
    def folder(self) -> MeshFolder | None:
        """Return the folder of one's own meshes."""
        ...

    @property
    def supports(self) -> Mapping[str, FurnitureSupport]:
        """Return the pieces of furniture by name."""
        ...

    @property
    def kinds(self) -> tuple[str, ...]:
        """Return the types of samples."""
        ...

    @property
    def key(self) -> str:
        """Return the key that chunks of an interrupted run must share to be used again, the number
        of scenes aside.
        """
        ...

    def chunk(self, number: int, start: int, size: int) -> Sequence[LabelledScene]:
        """Make `size` scenes of one chunk, which is the `number`-th and begins with scene `start`.

        They depend on nothing else but the job, and not on the size: it only says after how many to
        stop.
        """
        ...

    def card(self, arrays: dict[str, NDArray[Any]]) -> dict[str, Any]:
        """Return the card's own entries."""
        ...


def make_dataset(
    job: ChunkJob,
    out: Path,
    workers: int | None = None,
    progress: Progress = lambda done, total: None,
    ray: str | None = None,
) -> Dataset:
    """Make a data set and write it to `out` (.npz) and its card; what an interrupted run has made
    is used.

    Args:
        job: What to make.
        out: The file.
        workers: Processes; None for one a core.
        progress: Told how far it is.
        ray: The address of a Ray cluster that makes them, as `tamp.benchmark.ray_pool` takes it;
            None for this machine's own processes.

    Raises:
        InputError: An unknown relation or split, a count that is no count, a folder without meshes,
            no cluster, or one whose workers are lost again and again.
    """
    for found, choices in ((job.relation, RELATIONS), (job.split, SPLITS)):
        if found not in choices:
            raise InputError(f"unknown relation or split '{found}'", found=found, choices=choices)

    if job.count < 1:
        raise InputError(f"the number of scenes must be positive, not {job.count}")
    object_templates(job.split, job.folder)  # a bad mesh is said before processes start
    parts = out.with_name(f".{out.stem}.parts")
    _claim(parts, job.key)
    chunks = range((job.count + CHUNK - 1) // CHUNK)
    files = {number: parts / f"{number}_{_size(job, number)}.npz" for number in chunks}
    waiting = [number for number in chunks if not files[number].is_file()]
    done = len(chunks) - len(waiting)
    progress(min(done * CHUNK, job.count), job.count)
    for number, content in _results(job, waiting, workers, ray):
        write_whole(files[number], content)
        done += 1
        progress(min(done * CHUNK, job.count), job.count)

    data = _merged(job, [*files.values()])
    write_dataset(out, data)
    shutil.rmtree(parts)
    return data


def _size(job: ChunkJob, number: int) -> int:
    """Return the number of scenes of a chunk; the last one may be smaller."""
    return min(CHUNK, job.count - number * CHUNK)


def _claim(parts: Path, name: str) -> None:
    mark = parts / "job.json"
    if (
        parts.is_dir()
        and not mark.is_file()
        and any(UNFINISHED_NAME.match(one.name) is None for one in parts.iterdir())
    ):
        what = "this folder is in the way, and tamp-learn has not made it"
        raise InputError(what, file=parts, remedy="Move it, or choose another --out")
    if parts.is_dir() and (not mark.is_file() or mark.read_text() != name):
        shutil.rmtree(parts)
    write_whole(mark, name.encode())


def _results(
    job: ChunkJob, waiting: list[int], workers: int | None, ray: str | None
) -> Iterator[tuple[int, bytes]]:
    if ray is not None:
        from grounding.ray_chunks import ray_results

        yield from ray_results(partial(_packed, job), waiting, ray, workers)
        return
    count = min(workers or os.cpu_count() or 1, len(waiting))
    if count <= 1:
        yield from ((number, _packed(job, number)) for number in waiting)
        return
    from concurrent.futures import ProcessPoolExecutor
    from concurrent.futures import wait as wait_for
    from multiprocessing import active_children, get_context, resource_tracker

    resource_tracker.ensure_running()  # which would let signals through while it starts
    before = active_children()
    pool = ProcessPoolExecutor(
        count, mp_context=get_context("spawn"), initializer=guard.obey_only_parent
    )
    try:
        with guard.HeldSignals():
            futures = {pool.submit(_packed, job, number): number for number in waiting}
        while futures:
            if guard.asked():  # what it raised was dropped
                raise KeyboardInterrupt
            for future in wait_for(futures, LOOK, "FIRST_COMPLETED").done:
                yield futures.pop(future), future.result()
        pool.shutdown()
    except BaseException:  # the pool itself would wait for what is under way
        pool.shutdown(wait=False, cancel_futures=True)
        for process in active_children():
            if process not in before:
                process.kill()
        raise


def _packed(job: ChunkJob, number: int) -> bytes:
    """Make the scenes of one chunk, and serialize them as the bytes of an npz."""
    objects = object_templates(job.split, job.folder)
    names = {name: row for row, name in enumerate([*job.supports, *objects])}
    scenes = job.chunk(number, number * CHUNK, _size(job, number))
    arrays: dict[str, Any] = _arrays(scenes, names, job.kinds)
    buffer = io.BytesIO()
    np.savez(buffer, allow_pickle=False, **arrays)
    return buffer.getvalue()


def _arrays(
    made: Sequence[LabelledScene], names: dict[str, int], kinds: tuple[str, ...]
) -> dict[str, NDArray[Any]]:
    count = len(made)
    arrays: dict[str, NDArray[Any]] = {
        "holds": np.array([one.holds for one in made]),
        "kind": np.array([kinds.index(one.kind) for one in made], dtype=np.int8),
        "feasible": np.array([one.feasible for one in made]),
        "body": np.full((count, ROWS), -1, dtype=np.int16),
        "scale": np.ones((count, ROWS)),
        "pose": np.tile(np.eye(4), (count, ROWS, 1, 1)),
        "hollow": np.array([one.support.region.hollow for one in made]),
        "region": np.stack([one.support.region.matrix for one in made]),
        "size": np.stack([one.support.region.size for one in made]),
        "box": np.stack([one.support.region.box for one in made]),
    }
    arrays |= {name: np.array([one.columns[name] for one in made]) for name in made[0].columns}
    for row, one in enumerate(made):
        bodies = len(one.names)
        arrays["body"][row, :bodies] = [names[name] for name in one.names]
        arrays["scale"][row, :bodies] = one.scales
        arrays["pose"][row, :bodies] = one.poses

    return arrays


def _merged(job: ChunkJob, files: Sequence[Path]) -> Dataset:
    loaded = []
    for file in files:
        with np.load(file, allow_pickle=False) as archive:
            loaded.append({name: archive[name] for name in archive.files})

    arrays = {name: np.concatenate([one[name] for one in loaded]) for name in loaded[0]}
    objects = object_templates(job.split, job.folder)
    card = {
        "relation": job.relation,
        "split": job.split,
        "seed": job.seed,
        "count": job.count,
        "objects": list(objects),
        "supports": list(job.supports),
        "by type": {kind: int((arrays["kind"] == row).sum()) for row, kind in enumerate(job.kinds)},
        "feasible": float(arrays["feasible"].mean()),
        **job.card(arrays),
    }
    templates = {**{name: support.parts for name, support in job.supports.items()}, **objects}
    return Dataset(arrays, templates, job.kinds, card)
