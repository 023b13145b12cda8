"""Exploration: labels are what happened, the same bytes for the same seed, and a grounding can be learned from it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from grounding import chunks
from grounding.cli import BAD_INPUT, DONE, run
from grounding.dataset import Dataset
from grounding.exploration import KINDS, RESTED, STAYED, Exploration, Explorer, explore, moved
from grounding.model import RelationModel
from grounding.oracles import ItemOf, Verdict, drop_verdicts
from grounding.registry import load_model
from grounding.relation_scene import RelationScene
from grounding.scenes import SceneSampler
from grounding.separation import Obstacles, separations
from grounding.train import train
from grounding.weights import write_weights
from tamp.errors import InputError
from tamp.geometric.scene.pose import Array
from tamp.simulation.engines import open_drops


@pytest.fixture(scope="module", params=["on", "inside"])
def data(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Dataset:
    return explore(
        Exploration(request.param, 30), tmp_path_factory.mktemp("explored") / "small.npz", workers=1
    )


def test_labels_are_what_happened(data: Dataset) -> None:
    items = ItemOf()
    with open_drops() as drops:
        for example in data:
            verdict = drop_verdicts(
                example.situation, example.situation.body.matrix[None], drops, items
            )[0]
            assert (verdict is Verdict.HOLDS) == example.holds == (example.kind in (STAYED, RESTED))
            assert example.holds or verdict == example.kind
            pose, others = example.situation.body, Obstacles(example.situation.others)
            assert (
                not example.holds or (separations(pose.form, pose.matrix[None], others) > 0.0).all()
            )
    assert data.holds.tolist() == [True, False] * 15
    assert data.kinds == KINDS and sum(data.card["by type"].values()) == 30
    assert data.card["trials"] >= 30 * 12 and data.card["drawn by"] == "random"
    assert data.card["by type"][RESTED] and data.card["by type"][STAYED]


def test_a_grounding_learned_from_it_proposes(tmp_path: Path) -> None:
    """What it proposes holds far more often than random poses, of which next to none do; and it can explore on."""
    data = explore(Exploration("on", 16), tmp_path / "first.npz", workers=1)
    weights = train(data, "transfer")
    path = tmp_path / "on.safetensors"
    write_weights(path, weights)
    model, rng, held = load_model(path), np.random.default_rng(0), 0
    scenes, items = SceneSampler("on", "train"), ItemOf()
    with open_drops() as drops:
        for _ in range(12):
            situation = scenes.draw(rng).situation(np.eye(4))
            held += (
                drop_verdicts(situation, model.propose(situation, 1, rng), drops, items)[0]
                is Verdict.HOLDS
            )
    assert held >= 6
    again = explore(Exploration("on", 4, weights=path), tmp_path / "second.npz", workers=1)
    assert again.card["drawn by"]["model"] == "transfer" and again.card["drawn by"]["samples"] == 16
    with pytest.raises(InputError, match="weights for 'on', not 'inside'"):
        explore(Exploration("inside", 4, weights=path), tmp_path / "third.npz", workers=1)


class Nowhere(RelationModel):
    """Counts how often it is asked, and proposes what cannot hold."""

    asked = 0

    def propose(self, situation: RelationScene, count: int, rng: np.random.Generator) -> Array:
        self.asked += 1
        below = np.eye(4)
        below[2, 3] = -9.0
        return np.tile(below, (count, 1, 1))

    def classify(self, situation: RelationScene, poses: Array) -> Array:
        return np.zeros(len(poses))


def test_a_bad_grounding_costs_no_more_than_its_half() -> None:
    model = Nowhere()
    with open_drops() as drops:
        explorer = Explorer(SceneSampler("on", "train"), drops, model)
        made = explorer.make(True, np.random.default_rng(1))
    assert model.asked and made.holds and made.kind in (STAYED, RESTED)


def test_poses_are_moved_rigidly_and_by_any_measure() -> None:
    rng, far = np.random.default_rng(0), []
    for _ in range(200):
        pose = moved(np.eye(4), rng)
        assert np.allclose(pose[:3, :3] @ pose[:3, :3].T, np.eye(3)) and pose[3].tolist() == [
            0,
            0,
            0,
            1,
        ]
        far.append(np.linalg.norm(pose[:3, 3]))
    assert min(far) < 0.006 and 0.2 < max(far) < 0.3 + 1e-9


def test_same_seed_same_bytes_also_after_an_interruption(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(chunks, "CHUNK", 2)
    job, whole, resumed = (
        Exploration("on", 4, seed=3),
        tmp_path / "whole.npz",
        tmp_path / "resumed.npz",
    )
    explore(job, whole, workers=1)

    def stop(done: int, total: int) -> None:
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        explore(job, resumed, workers=1, progress=stop)
    seen: list[int] = []
    explore(job, resumed, workers=2, progress=lambda done, total: seen.append(done))
    assert seen == [2, 4] and whole.read_bytes() == resumed.read_bytes()


def test_from_the_command_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(["explore", "inside", "--count", "4", "--workers", "1"]) == DONE
    assert "data/inside_explored.npz written: 4 scenes of" in capsys.readouterr().out
    assert run(["train", "inside", "--data", "data/inside_explored.npz"]) == DONE
    command = "explore inside --count 2 --workers 1 --model weights/inside_transfer.safetensors --out data/more.npz"
    assert run(command.split()) == DONE
    capsys.readouterr()
    assert run(["explore", "on", "--model", "weights/inside_transfer.safetensors"]) == BAD_INPUT
    assert "weights for 'inside', not 'on'" in capsys.readouterr().err
    assert run(["explore", "on", "--model", "none.safetensors"]) == BAD_INPUT
    assert "none.safetensors: no such weight file" in capsys.readouterr().err
    assert run(["explore", "on", "--out", "weights/on.safetensors"]) == BAD_INPUT


def test_fewer_scenes_are_the_first_of_more(tmp_path: Path) -> None:
    """What a chunk begins with does not depend on how many are wanted."""
    few, more = (
        explore(Exploration("on", count, seed=5), tmp_path / f"{count}.npz", workers=1)
        for count in (2, 5)
    )
    assert all(np.array_equal(few.arrays[name], more.arrays[name][:2]) for name in few.arrays)
