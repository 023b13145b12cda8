"""Data sets made by many processes, a chunk at a time: resumable, and the same bytes for the same seed."""

from __future__ import annotations

import json
import os
import shutil
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grounding.dataset import Dataset, write_dataset
from grounding.demonstrations import KINDS, OTHERS, POSITIVE, Made, Maker
from grounding.objects import SPLITS, object_templates
from grounding.supports import support_templates
from tamp.data import write_whole
from tamp.errors import InputError
from tamp.simulation.drop import Drops

CHUNK = 100
"""Scenes that one process makes before they are kept."""

ROWS = 3 + max(most for _, most in OTHERS.values())
"""Bodies that a row has room for: the arguments, the other support, the others."""


@dataclass(frozen=True)
class Job:
    """What is to be generated.

    Attributes:
        relation: "on" or "inside".
        split: "train" or "test"; they share no object and no support.
        count: Scenes, half of them positive.
        seed: Of all randomness.
        folder: Of one's own meshes, one a subfolder.
    """

    relation: str
    split: str
    count: int
    seed: int = 0
    folder: Path | None = None


def generate(
    job: Job,
    out: Path,
    workers: int | None = None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Dataset:
    """Make a data set and write it to `out` (.npz) and its card; what an interrupted run has made is used.

    Args:
        job: What to make.
        out: The file.
        workers: Processes; None for one a core.
        progress: Called with the scenes made so far and all.

    Raises:
        InputError: An unknown relation or split, a count that is no count, a folder without meshes.
    """
    for found, choices in ((job.relation, KINDS), (job.split, SPLITS)):
        if found not in choices:
            raise InputError(f"unknown relation or split '{found}'", found=found, choices=choices)
    if job.count < 1:
        raise InputError(f"the number of scenes must be positive, not {job.count}")
    object_templates(job.split, job.folder)  # a bad mesh is said before processes start
    parts = out.with_name(f".{out.stem}.parts")
    name = json.dumps([job.relation, job.split, job.seed, str(job.folder)])
    _claim(parts, name)
    chunks = range((job.count + CHUNK - 1) // CHUNK)
    waiting = [number for number in chunks if not (parts / f"{number}.npz").is_file()]
    done = len(chunks) - len(waiting)
    progress(min(done * CHUNK, job.count), job.count)
    for number, content in _results(job, waiting, workers):
        write_whole(parts / f"{number}.npz", content)
        done += 1
        progress(min(done * CHUNK, job.count), job.count)
    data = _merged(job, parts, len(chunks))
    write_dataset(out, data)
    shutil.rmtree(parts)
    return data


def kinds_of(relation: str, count: int) -> list[str]:
    """The type of each of `count` scenes: their shares hold in every run of 40, positives and negatives in turn."""
    shares = KINDS[relation]
    sides = [[kind for kind in shares if (kind in POSITIVE) == positive] for positive in (True, False)]
    owed: Counter[str] = Counter()
    chosen: list[str] = []
    for number in range(count):
        side = sides[number % 2]
        for kind in side:
            owed[kind] += 2 * shares[kind]  # type: ignore[assignment]
        kind = max(side, key=lambda kind: (round(owed[kind], 9), -side.index(kind)))
        owed[kind] -= 1
        chosen.append(kind)
    return chosen


def _claim(parts: Path, name: str) -> None:
    mark = parts / "job.json"
    if parts.is_dir() and (not mark.is_file() or mark.read_text() != name):
        shutil.rmtree(parts)
    write_whole(mark, name.encode())


def _results(job: Job, waiting: list[int], workers: int | None) -> Iterator[tuple[int, bytes]]:
    count = min(workers or os.cpu_count() or 1, len(waiting))
    if count <= 1:
        yield from ((number, _chunk(job, number)) for number in waiting)
        return
    from concurrent.futures import ProcessPoolExecutor, as_completed
    from multiprocessing import get_context

    with ProcessPoolExecutor(count, mp_context=get_context("spawn")) as pool:
        futures = {pool.submit(_chunk, job, number): number for number in waiting}
        for future in as_completed(futures):
            yield futures[future], future.result()


@lru_cache(maxsize=2)
def _maker(relation: str, split: str, folder: Path | None) -> Maker:
    return Maker(relation, split, Drops(), folder)


def _chunk(job: Job, number: int) -> bytes:
    """The scenes of one chunk, as the bytes of an npz."""
    import io

    maker = _maker(job.relation, job.split, job.folder)
    kinds = kinds_of(job.relation, (number + 1) * CHUNK)[number * CHUNK :]
    rng = np.random.default_rng([job.seed, SPLITS.index(job.split), tuple(KINDS).index(job.relation), number])
    buffer = io.BytesIO()
    names = _names(job)
    arrays: dict[str, Any] = _arrays([maker.make(kind, rng) for kind in kinds], names, tuple(KINDS[job.relation]))
    np.savez(buffer, allow_pickle=False, **arrays)
    return buffer.getvalue()


def _names(job: Job) -> dict[str, int]:
    tables = {**support_templates(job.relation, job.split), **support_templates("on", job.split)}
    return {name: row for row, name in enumerate([*tables, *object_templates(job.split, job.folder)])}


def _arrays(made: list[Made], names: dict[str, int], kinds: tuple[str, ...]) -> dict[str, NDArray[Any]]:
    count = len(made)
    arrays: dict[str, NDArray[Any]] = {
        "holds": np.array([one.kind in POSITIVE for one in made]),
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
    for row, one in enumerate(made):
        bodies = len(one.names)
        arrays["body"][row, :bodies] = [names[name] for name in one.names]
        arrays["scale"][row, :bodies] = one.scales
        arrays["pose"][row, :bodies] = one.poses
    return arrays


def _merged(job: Job, parts: Path, chunks: int) -> Dataset:
    loaded = []
    for number in range(chunks):
        with np.load(parts / f"{number}.npz", allow_pickle=False) as archive:
            loaded.append({name: archive[name] for name in archive.files})
    arrays = {name: np.concatenate([one[name] for one in loaded])[: job.count] for name in loaded[0]}
    kinds = tuple(KINDS[job.relation])
    supports = {**support_templates(job.relation, job.split), **support_templates("on", job.split)}
    objects = object_templates(job.split, job.folder)
    card = {
        "relation": job.relation,
        "split": job.split,
        "seed": job.seed,
        "count": job.count,
        "objects": list(objects),
        "supports": list(support_templates(job.relation, job.split)),
        "by type": {kind: int((arrays["kind"] == row).sum()) for row, kind in enumerate(kinds)},
        "feasible": float(arrays["feasible"].mean()),
    }
    templates = {**{name: support.parts for name, support in supports.items()}, **objects}
    return Dataset(arrays, templates, kinds, card)
