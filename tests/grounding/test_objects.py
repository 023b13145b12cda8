"""The objects that data are made with: no object in two splits, the same each time, of a hand's size."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from grounding import objects as module
from grounding.household import SHAPES, YCB
from grounding.mesh_folder import MeshFolder
from grounding.objects import HOUSEHOLD, SPLITS, object_templates
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Part

made_anew = object_templates.__wrapped__
"""Without what was kept of an earlier call."""


def test_no_object_is_in_both_splits() -> None:
    train, test = (object_templates(split) for split in SPLITS)
    assert train and test and not {*train} & {*test}
    assert {*YCB} <= {*test}
    for name in SHAPES:
        made = [
            sum(one.startswith(f"{name}_{split}_") for one in object_templates(split))
            for split in SPLITS
        ]
        assert made == [HOUSEHOLD["train"], HOUSEHOLD["test"]]


def sizes(split: str) -> dict[str, tuple[float, ...]]:
    return {
        name: tuple(np.ptp(bounds(parts, Pose()), axis=0))
        for name, parts in made_anew(split).items()
    }


def test_each_time_they_are_the_same_and_of_a_hands_size() -> None:
    first = sizes("test")
    assert sizes("test") == first
    assert len({*first.values()}) > 0.9 * len(first)  # and hardly two are alike
    assert all(0.01 < max(size) < 0.5 for size in first.values())


def test_what_no_data_can_be_made_with_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    huge = (Part(Box((3.0, 3.0, 3.0))),)
    fine = (Part(Box((0.1, 0.1, 0.1))),)
    monkeypatch.setattr(module, "YCB", {"huge": huge, "fine": fine})
    found = made_anew("test")
    assert "fine" in found and "huge" not in found


def test_ones_own_meshes_join_the_others(tmp_path: Path) -> None:
    trimesh.creation.box((0.06, 0.08, 0.1)).export(tmp_path / "my_box.obj")
    household, joined = object_templates("train"), made_anew("train", MeshFolder(tmp_path))
    assert {*joined} == {*household, "my_box"}
