"""Data sets made chunk by chunk: resumed to the same bytes, refused before anything is made."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from grounding import chunks as module
from grounding.dataset import read_dataset
from grounding.generate import Job, generate


def test_same_seed_same_bytes_also_after_an_interruption(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "CHUNK", 4)
    job, whole, resumed = (
        Job("on", "train", 8, seed=3),
        tmp_path / "whole.npz",
        tmp_path / "resumed.npz",
    )
    generate(job, whole, workers=1)

    def stop(done: int, total: int) -> None:
        if done == 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        generate(job, resumed, workers=1, progress=stop)
    assert not resumed.exists()
    seen: list[int] = []
    generate(job, resumed, workers=1, progress=lambda done, total: seen.append(done))
    assert seen == [4, 8] and whole.read_bytes() == resumed.read_bytes()
    again = read_dataset(whole)
    assert all(
        np.array_equal(again.arrays[name], read_dataset(resumed).arrays[name])
        for name in again.arrays
    )
