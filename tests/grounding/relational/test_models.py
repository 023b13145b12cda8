"""Relational groundings: coordinates there and back, proposals that fit, the runtime and torch, damaged weights."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import torch

from grounding.dataset import Dataset
from grounding.layers import dense, layers_of
from grounding.oracles import ItemOf, Verdict, drop_verdicts
from grounding.registry import load_model
from grounding.relational.coordinates import RelationalCoordinates
from grounding.relational.flow import COORDINATES, Flow, condition, surroundings
from grounding.relational.flow_training import FlowNet, SceneBatch
from grounding.relational.measures import RegionFrame
from grounding.relational.model import RelationalModel
from grounding.relational.ranker import Ranker, features
from grounding.relational.training import RankerNet
from grounding.torch_layers import arrays_of
from grounding.train import TRAINERS, TrainArgs, measure
from grounding.weights import Weights, write_weights
from tamp.errors import InputError
from tamp.simulation.engines import open_drops

Trained = dict[tuple[str, str], Weights]


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


@pytest.mark.parametrize("model", ["transfer", "flow"])
@pytest.mark.parametrize("relation", ["on", "inside"])
def test_what_is_proposed_holds_in_physics(
    scenes: dict[str, Dataset], trained: Trained, relation: str, model: str
) -> None:
    grounding, rng, held, items = (
        RelationalModel(trained[relation, model]),
        np.random.default_rng(0),
        [],
        ItemOf(),
    )
    with open_drops() as drops:
        for index in range(40):  # scenes that it was trained on: does it work at all?
            situation = scenes[relation][index].situation
            poses = grounding.propose(situation, 1, rng)
            held.append(
                len(poses) == 1
                and drop_verdicts(situation, poses, drops, items)[0] is Verdict.HOLDS
            )
    assert np.mean(held) > 0.6


def test_the_ranker_classifies(scenes: dict[str, Dataset], trained: Trained) -> None:
    grounding = RelationalModel(trained["on", "transfer"])
    right = [
        (grounding.classify(example.situation, example.situation.body.matrix[None])[0] > 0.5)
        == example.holds
        for example in scenes["on"]
    ]
    assert np.mean(right) > 0.9


def test_same_draws_same_poses_the_best_first(scenes: dict[str, Dataset], trained: Trained) -> None:
    for weights in trained.values():
        grounding, situation = RelationalModel(weights), scenes["on"][0].situation
        first, again = (grounding.propose(situation, 8, np.random.default_rng(3)) for _ in range(2))
        assert np.array_equal(first, again)
        view = RegionFrame(situation)
        scores = grounding._scores(view.measure(view.T_region_world @ first))
        assert np.all(np.diff(scores) <= 1e-9)


@pytest.mark.parametrize("model", ["transfer", "flow"])
def test_same_seed_same_weights(scenes: dict[str, Dataset], trained: Trained, model: str) -> None:
    again = TRAINERS[model](scenes["inside"], TrainArgs(samples=40))
    for name, array in trained["inside", model].arrays.items():
        assert np.array_equal(array, again.arrays[name]), name


def test_numpy_ranks_as_torch_does(scenes: dict[str, Dataset]) -> None:
    net = RankerNet(64, 16)
    ranker = Ranker(net.arrays())
    for example in scenes["on"].take(range(20)):
        view = RegionFrame(example.situation)
        poses = np.repeat(view.T_region_world @ example.situation.body.matrix[None], 5, axis=0)
        poses[:, :2, 3] += np.random.default_rng(0).normal(scale=0.1, size=(5, 2))
        measured = view.measure(poses)
        pose, pair = (torch.tensor(array) for array in features(measured))
        with torch.no_grad():
            logits = net(pose, pair, torch.zeros(pair.shape[:2], dtype=torch.bool)).numpy()
        assert ranker.logits(measured) == pytest.approx(logits, abs=1e-5)


def test_numpy_flows_as_torch_does(scenes: dict[str, Dataset]) -> None:
    net, rng = FlowNet(32), np.random.default_rng(0)
    chart = RelationalCoordinates.fit(
        [measure(example) for example in scenes["on"] if example.holds]
    )
    flow = Flow(chart, {**net.arrays(), "scale": np.ones(COORDINATES, np.float32)})
    for example in scenes["on"].take(range(20)):
        view = RegionFrame(example.situation)
        known = np.repeat(condition(view)[:1], 3, axis=0)
        around, half = surroundings(view), np.asarray(view.region.size[:2] / 2, np.float32)
        x, time = (
            rng.normal(size=(3, COORDINATES)).astype(np.float32),
            np.full((3, 1), 0.5, np.float32),
        )
        padded = np.zeros((1, len(around) + 1, 6), np.float32)
        padded[0, : len(around)] = around
        missing = np.arange(len(around) + 1) == len(around)
        several = SceneBatch(
            torch.tensor(known), torch.tensor(padded).expand(3, -1, -1), torch.tensor(missing).expand(3, -1),
            torch.tensor(half).expand(3, -1),
        )  # fmt: skip
        with torch.no_grad():
            expected = net(torch.tensor(x), torch.tensor(time), several).numpy()
        assert flow.velocity(x, time, known, around, half) == pytest.approx(expected, abs=1e-5)


def test_dense_layers_are_checked() -> None:
    net = torch.nn.ModuleList([torch.nn.Linear(3, 4), torch.nn.Linear(4, 2)])
    arrays = arrays_of(net=net)
    x = np.random.default_rng(0).normal(size=(5, 3)).astype(np.float32)
    with torch.no_grad():
        expected = net[1](torch.relu(net[0](torch.tensor(x)))).numpy()
    assert dense(layers_of(arrays, "net", 3, 2), x) == pytest.approx(expected, abs=1e-6)
    for wrong in ({"inputs": 2}, {"outputs": 3}):
        with pytest.raises(ValueError, match="net"):
            layers_of(arrays, "net", **wrong)
    with pytest.raises(ValueError, match=r"net\.1"):
        layers_of({**arrays, "net.1.weight": arrays["net.0.weight"]}, "net")


def test_weights_that_are_no_such_grounding(tmp_path: Path, trained: Trained) -> None:
    weights, path = trained["inside", "transfer"], tmp_path / "some.safetensors"
    write_weights(path, weights)
    assert isinstance(load_model(path), RelationalModel)
    data = path.read_bytes()
    card = dict(weights.card)
    for damaged in (data[: len(data) // 2], b"", b"\x00" * 100):
        path.write_bytes(damaged)
        with pytest.raises(InputError, match="damaged"):
            load_model(path)
    for wrong in (
        Weights({"sizes": weights.arrays["sizes"]}, card),
        Weights({**weights.arrays, "faces": np.zeros((3, 2))}, card),
        Weights(weights.arrays, {**card, "chart": {"level": 1}}),
        Weights(
            {**trained["on", "flow"].arrays, "flow.face.0.weight": np.zeros((2, 2), np.float32)},
            card,
        ),
    ):
        write_weights(path, wrong)
        with pytest.raises(InputError, match="no weights of 'transfer'"):
            load_model(path)
    write_weights(path, Weights(weights.arrays, {**card, "model": "transfr"}))
    with pytest.raises(InputError, match="transfer"):
        load_model(path)
    with pytest.raises(InputError, match="no such"):
        load_model(tmp_path / "none.safetensors")


def test_the_runtime_needs_no_torch(tmp_path: Path, trained: Trained) -> None:
    path = tmp_path / "on.safetensors"
    write_weights(path, trained["on", "flow"])
    code = (
        "import sys; from pathlib import Path; from grounding.registry import load_grounding;"
        f"load_grounding(Path({str(path)!r})); print('torch' in sys.modules)"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "False"
