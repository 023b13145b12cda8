"""Data sets on a Ray cluster: a killed worker loses no chunk and doubles none, the bytes are those of one process."""

from __future__ import annotations

import os
import signal
import sys
from functools import partial
from pathlib import Path

import pytest

from grounding.cli import BAD_INPUT, run
from grounding.generate import Job, generate
from grounding.ray_chunks import ray_results
from tamp.errors import InputError

WHOLE = 6


def traced(number: int, folder: Path, deadly: int) -> bytes:
    """Leave a trace of every try; the first `deadly` ones of chunk 1 have their process killed."""
    tries = len(list(folder.glob(f"{number}.*")))
    (folder / f"{number}.{tries}").touch()
    if number == 1 and tries < deadly:
        os.kill(os.getpid(), signal.SIGKILL)
    return f"chunk {number}".encode()


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # Ray's own
def test_a_killed_worker_loses_no_chunk_and_doubles_none(tmp_path: Path) -> None:
    make = partial(traced, folder=tmp_path, deadly=1)
    found = list(ray_results(make, range(WHOLE), "local", 2))
    assert sorted(found) == [(number, f"chunk {number}".encode()) for number in range(WHOLE)]
    tries = {number: len(list(tmp_path.glob(f"{number}.*"))) for number in range(WHOLE)}
    assert tries == {number: 2 if number == 1 else 1 for number in range(WHOLE)}


@pytest.mark.slow
@pytest.mark.filterwarnings("default")
def test_a_chunk_that_kills_every_worker_is_said_and_the_others_are_kept(tmp_path: Path) -> None:
    make = partial(traced, folder=tmp_path, deadly=99)
    found: list[int] = []
    with pytest.raises(InputError, match="workers of chunk 1 were lost 3 times"):
        found.extend(number for number, _ in ray_results(make, range(3), "local", 2))
    assert len(list(tmp_path.glob("1.*"))) == 3 and not list(tmp_path.glob("2.1"))


@pytest.mark.slow
@pytest.mark.timeout(300)
@pytest.mark.filterwarnings("default")
def test_a_cluster_makes_the_bytes_of_one_process(tmp_path: Path) -> None:
    job = Job("on", "train", 120, seed=5)
    generate(job, tmp_path / "alone.npz", workers=1)
    generate(job, tmp_path / "ray.npz", workers=2, ray="local")
    for suffix in (".npz", ".json"):
        alone, ray = ((tmp_path / f"{name}{suffix}").read_bytes() for name in ("alone", "ray"))
        assert alone == ray


def test_what_a_cluster_is_not_given(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "on.npz"
    assert run(f"generate on --count 4 --ray 127.0.0.1:1 --out {out}".split()) == BAD_INPUT
    assert "no Ray cluster at '127.0.0.1:1'" in capsys.readouterr().err
    monkeypatch.setitem(sys.modules, "ray", None)
    assert run(f"generate on --count 4 --ray local --out {out}".split()) == BAD_INPUT
    assert "tamp-planner[ray]" in capsys.readouterr().err
    assert not out.exists()
