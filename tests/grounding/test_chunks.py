"""Data sets made chunk by chunk: resumed to the same bytes, refused before anything is made."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from grounding import chunks as module
from grounding.chunks import ROWS, _arrays, make_dataset
from grounding.dataset import read_dataset
from grounding.generate import Job, generate
from grounding.scenes import LabelledScene
from grounding.supports import FurnitureSupport
from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose
from tests.grounding.forms import at, box, on_table


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


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"relation": "under"}, "unknown relation or split 'under'"),
        ({"split": "tset"}, "Did you mean 'test'"),
        ({"count": 0}, "must be positive, not 0"),
        ({"count": -3}, "must be positive, not -3"),
    ],
)
def test_what_cannot_be_made_is_said_before_anything_is(
    change: dict[str, object], message: str, tmp_path: Path
) -> None:
    job = replace(Job("on", "train", 4), **change)
    with pytest.raises(InputError, match=message):
        make_dataset(job, tmp_path / "x.npz", workers=1)
    assert [*tmp_path.iterdir()] == []


def test_a_folder_that_is_somebody_elses_stays(tmp_path: Path) -> None:
    (tmp_path / ".x.parts").mkdir()
    (tmp_path / ".x.parts" / "thesis.txt").write_text("mine")
    with pytest.raises(InputError, match="this folder is in the way"):
        make_dataset(Job("on", "train", 4), tmp_path / "x.npz", workers=1)
    assert (tmp_path / ".x.parts" / "thesis.txt").read_text() == "mine"


def test_what_another_job_left_is_not_taken_up(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A job of another seed was stopped after its first chunk."""
    monkeypatch.setattr(module, "CHUNK", 2)
    job, out = Job("on", "train", 4, seed=1), tmp_path / "x.npz"

    def stop(done: int, total: int) -> None:
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        make_dataset(replace(job, seed=2), out, workers=1, progress=stop)
    seen: list[int] = []
    make_dataset(job, out, workers=1, progress=lambda done, total: seen.append(done))
    assert seen == [0, 2, 4]
    assert sorted(one.name for one in tmp_path.iterdir()) == ["x.json", "x.npz"]


def test_scenes_become_rows_and_what_is_not_there_is_minus_one() -> None:
    situation = on_table(at(box(0.1, 0.1, 0.1), 0.0, 0.0, 1.0))
    support = FurnitureSupport(situation.support.form.parts, situation.region)

    def scene(names: list[str], kind: str, holds: bool) -> LabelledScene:
        poses = [Pose((float(number), 0.0, 0.0)).matrix for number in range(len(names))]
        scales = [1.0 + number for number in range(len(names))]
        return LabelledScene(names, scales, poses, support, kind, holds, not holds, {"draw": 5})

    scenes = [
        scene(["table", "can", "jar"], "alone", True),
        scene(["table", "jar"], "above", False),
    ]
    arrays = _arrays(scenes, {"table": 0, "can": 1, "jar": 2}, ("alone", "above"))
    assert arrays["holds"].tolist() == [True, False] and arrays["kind"].tolist() == [0, 1]
    assert arrays["feasible"].tolist() == [False, True] and arrays["draw"].tolist() == [5, 5]
    absent = [-1] * (ROWS - 3)
    assert arrays["body"].tolist() == [[0, 1, 2, *absent], [0, 2, -1, *absent]]
    assert arrays["scale"][0].tolist() == [1.0, 2.0, 3.0] + [1.0] * (ROWS - 3)
    assert arrays["pose"][0, 2, 0, 3] == 2.0 and (arrays["pose"][1, 2] == np.eye(4)).all()
    assert arrays["size"][0].tolist() == [0.8, 0.6, np.inf] and not arrays["hollow"].any()
