"""Relational coordinates: fitted to what was shown, there and back, kept in a card."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from grounding.dataset import Dataset, read_dataset
from grounding.registry import load_model
from grounding.relational.coordinates import RelationalCoordinates
from grounding.train import measure, train
from grounding.weights import Weights, write_weights
from tamp.errors import InputError
from tests.grounding.shown import demonstrations


@pytest.mark.parametrize("name", ["level", "anchor", "offset", "contained", "ceiling", "sides"])
@pytest.mark.parametrize("value", ["text", [], 9.5, -4, True, None])
def test_a_chart_that_is_none(name: str, value: Any, stored: Path) -> None:
    weights = train(read_dataset(stored), "transfer")
    entries = dict(weights.card)
    entries["chart"] = {**entries["chart"], name: value}
    path = stored.with_name("w.safetensors")
    write_weights(path, Weights(weights.arrays, entries))
    fits = {"contained": value is True, "ceiling": value in (9.5, -4, None) and value is not True}
    if fits.get(name, name in ("offset", "sides") and value in (9.5, -4) and value is not True):
        load_model(path)
        return
    with pytest.raises(InputError, match="no weights of 'transfer'"):
        load_model(path)


def test_what_was_shown_at_one_height_is_done_at_another(tmp_path: Path) -> None:
    """Where the plane of the place and the ground keep their distance, it is the plane that counts."""
    data = demonstrations(tmp_path, height=0.7)
    model = load_model(written(tmp_path, train(data, "transfer")))
    (tmp_path / "lower").mkdir()
    lower = demonstrations(tmp_path / "lower", height=0.45)[0].situation
    poses = model.propose(lower, 5, np.random.default_rng(0))
    assert len(poses) == 5
    feet = [(lower.body.form.vertices @ pose[:3, :3].T + pose[:3, 3])[:, 2].min() for pose in poses]
    assert np.abs(np.array(feet) - 0.45).max() < 0.01


def written(folder: Path, weights: Weights) -> Path:
    write_weights(folder / "m.safetensors", weights)
    return folder / "m.safetensors"


@pytest.mark.parametrize("relation", ["on", "inside"])
def test_a_chart_finds_poses_again(scenes: dict[str, Dataset], relation: str) -> None:
    measured = [measure(example) for example in scenes[relation] if example.holds]
    chart = RelationalCoordinates.fit(measured)
    found = []
    for one in measured:
        again = chart.decode(one.view, one.face, chart.encode(one).coordinates[None])
        assert again.low == pytest.approx(one.view.measure(again.poses).low, abs=1e-12)
        turn = again.poses[0, :3, :3].T @ one.poses[0, :3, :3]
        moved = np.abs(again.poses[0, :3, 3] - one.poses[0, :3, 3]).max()
        found.append(moved < 0.01 and np.arccos(np.clip((np.trace(turn) - 1) / 2, -1, 1)) < 0.06)
    assert (
        np.mean(found) > 0.85
    )  # what leans on a wall, or stands on an edge of many, is proposed upright
    assert chart.contained is (relation == "inside")
