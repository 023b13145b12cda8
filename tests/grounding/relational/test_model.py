"""Relational groundings: proposals that hold, the best first, and weights that are none."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from grounding.body_geometry import geometry_of
from grounding.dataset import Dataset
from grounding.oracles import ItemOf, Verdict, drop_verdicts
from grounding.registry import load_model
from grounding.relational.coordinates import RelationalCoordinates
from grounding.relational.measures import RegionFrame
from grounding.relational.model import HOPELESS, RelationalModel, relational_weights
from grounding.relational.proposals import Transfer
from grounding.train import TRAINERS, TrainArgs
from grounding.weights import Weights, write_weights
from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Part, Sphere
from tamp.simulation.engines import open_drops
from tests.grounding.forms import TOP, at, box, on_table
from tests.grounding.relational.situations import bricks

Trained = dict[tuple[str, str], Weights]


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


@pytest.fixture(scope="module")
def standing() -> RelationalModel:
    """What 20 standing bricks say, without a ranker."""
    measured, holds = bricks(40)
    shown = [one for one, stands in zip(measured, holds, strict=True) if stands]
    chart = RelationalCoordinates.fit(shown)
    proposals = Transfer.of(chart, [chart.encode(one) for one in shown])
    card = {"model": "transfer", "ranks": False, "classifies": False}
    return RelationalModel(relational_weights(chart, proposals, {}, card))


def test_without_a_ranker_it_holds_where_all_is_kept(standing: RelationalModel) -> None:
    """The brick stands with its middle 0.02 m above the table; off by more than 0.03 m it does not hold."""
    situation = on_table(at(box(0.1, 0.06, 0.04), 0.0, 0.0, 1.0))
    heights = (0.02, 0.045, 0.055, -0.015)
    poses = np.stack([Pose((0.0, 0.0, TOP + height)).matrix for height in heights])
    assert standing.classify(situation, poses) == pytest.approx([1.0, 1.0, 0.0, 0.0])
    over = standing.classify(situation, Pose((0.45, 0.0, TOP + 0.02)).matrix[None])
    assert over[0] < 1e-3
    assert standing.classify(situation, poses[:0]).shape == (0,)


def test_what_keeps_what_all_have_kept_is_proposed_first(standing: RelationalModel) -> None:
    cube = at(box(0.2, 0.2, 0.2), 0.0, 0.0, TOP + 0.1)
    situation = on_table(at(box(0.1, 0.06, 0.04), 0.0, 0.0, 1.0), cube)
    poses = standing.propose(situation, 10, np.random.default_rng(0))
    view = RegionFrame(situation)
    measured = view.measure(view.T_region_world @ poses)
    assert len(poses) == 10 and (measured.nearest >= -0.001).all()
    assert (standing._scores(measured) > HOPELESS).all()
    _, downs = standing.propose_on_faces(situation, 3, np.random.default_rng(0))
    assert downs.shape == (3, 3, 3)


def test_what_misses_a_bound_is_behind_all_that_misses_none(standing: RelationalModel) -> None:
    """Over the edge by 0.1 and by 0.2 m, where no demonstration was; the farther, the worse."""
    view = RegionFrame(on_table(at(box(0.1, 0.06, 0.04), 0.0, 0.0, 1.0)))
    poses = np.stack([Pose((x, 0.0, 0.02)).matrix for x in (0.0, 0.45, 0.55)])
    kept, over, farther = standing._scores(view.measure(poses))
    assert kept > 0.0 > HOPELESS - 50.0 > over > farther


def test_what_rests_on_no_face_is_not_proposed_and_does_not_hold(standing: RelationalModel) -> None:
    ball = geometry_of((Part(Sphere(0.05)),))
    assert ball.faces == ()
    situation = on_table(at(ball, 0.0, 0.0, TOP + 0.05))
    assert standing.propose(situation, 5, np.random.default_rng(0)).shape == (0, 4, 4)
    assert standing.classify(situation, situation.body.matrix[None]).tolist() == [0.0]
