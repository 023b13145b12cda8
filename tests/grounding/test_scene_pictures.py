"""Sheets of scenes: which are chosen, where they stand, in which colours; refused outputs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from grounding.cli import BAD_INPUT, DONE, run
from grounding.dataset import Dataset
from grounding.generate import Job, generate
from grounding.scene_pictures import TILE, scene_picture, scenes_to_show
from tamp.errors import InputError


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("scenes") / "on.npz"
    generate(Job("on", "train", 20, layout="paper"), path, workers=1)
    return path


@pytest.fixture(scope="module")
def data(path: Path) -> Dataset:
    from grounding.dataset import read_dataset

    return read_dataset(path)


def test_each_type_has_its_share(data: Dataset) -> None:
    chosen = scenes_to_show(data, 10, 3)
    assert len(set(chosen)) == 10 and sum(data.holds[chosen]) == 5
    kinds = [data.kinds[kind] for kind in data.arrays["kind"][chosen]]
    assert kinds.count("among others") == 4 and kinds.count("alone") == 1
    assert chosen == scenes_to_show(data, 10, 3) != scenes_to_show(data, 10, 4)
    assert len(scenes_to_show(data, 60, 0)) == 20
    with pytest.raises(InputError, match="--scenes 61: a sheet has room for 60"):
        scenes_to_show(data, 61, 0)


def test_the_body_is_green_where_the_relation_holds_else_red(data: Dataset) -> None:
    alone = [*data.kinds].index("alone")
    afloat = [*data.kinds].index("afloat")
    for kind, channel in ((alone, 1), (afloat, 0)):
        index = int(np.flatnonzero(data.arrays["kind"] == kind)[0])
        picture = np.asarray(scene_picture(data, index)).astype(int)
        assert picture.shape == (TILE[1], TILE[0], 3)
        strong = picture[:, :, channel] - np.delete(picture, channel, axis=2).max(axis=2) > 40
        other = picture[:, :, 1 - channel] - np.delete(picture, 1 - channel, axis=2).max(axis=2)
        assert strong.sum() > 10 and not (other > 40).any()


def test_the_command(path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "sheet.png"
    assert run(f"show {path} --scenes 6 --out {out}".split()) == DONE
    assert capsys.readouterr().out == f"{out} written: 6 scenes\n"
    with Image.open(out) as picture:
        assert picture.size == (4 * TILE[0], 2 * TILE[1])

    before = path.read_bytes()
    for line, said in (
        (f"show {path} --out {path}", "must end in .png"),
        (f"show {tmp_path / 'none.npz'} --out {out}", "none.npz"),
        (f"show {path} --scenes 0 --out {out}", "--scenes must be positive"),
    ):
        assert run(line.split()) == BAD_INPUT
        assert said in capsys.readouterr().err
    assert path.read_bytes() == before
