"""Data sets: what physics says of every sample, the same bytes for the same seed, no leak from training to test."""

from __future__ import annotations

from pathlib import Path

import pytest

from grounding.dataset import Dataset, read_dataset
from grounding.demonstrations import KINDS, POSITIVE
from grounding.generate import Job, generate, kinds_of
from grounding.oracles import ItemOf, Verdict, drop_verdicts, paper_oracle
from grounding.paper.edge_negatives import EDGE_KINDS
from grounding.separation import Obstacles, separations
from tamp.errors import InputError
from tamp.simulation.engines import open_drops


@pytest.fixture(scope="module", params=["on", "inside"])
def data(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Dataset:
    return generate(
        Job(request.param, "train", 40), tmp_path_factory.mktemp("data") / "small.npz", workers=1
    )


def test_labels_are_what_physics_says(data: Dataset) -> None:
    items = ItemOf()
    with open_drops() as drops:
        for example in data:
            pose = example.situation.body.matrix[None]
            holds = drop_verdicts(example.situation, pose, drops, items)[0] is Verdict.HOLDS
            assert holds == example.holds == (example.kind in POSITIVE), example.kind
            assert not holds or paper_oracle(example.situation, pose)[0]
    assert data.holds.sum() == len(data) / 2


def test_kinds_have_the_papers_shares() -> None:
    for shares in (*KINDS.values(), *EDGE_KINDS.values()):
        kinds = kinds_of(shares, 400)
        assert sum(shares.values()) == pytest.approx(1.0)
        assert {kind: kinds.count(kind) / 400 for kind in shares} == pytest.approx(
            shares, abs=0.005
        )


def test_training_and_test_share_no_body(data: Dataset, tmp_path: Path) -> None:
    test = generate(Job(data.relation, "test", 4), tmp_path / "test.npz", workers=1)
    for card in ("objects", "supports"):
        assert (
            data.card[card] and test.card[card] and not set(data.card[card]) & set(test.card[card])
        )


def test_a_damaged_data_set_is_refused(data: Dataset, tmp_path: Path) -> None:
    path = tmp_path / "small.npz"
    generate(Job(data.relation, "train", 2), path, workers=1)
    path.write_bytes(path.read_bytes()[:1000])
    with pytest.raises(InputError, match="damaged"):
        read_dataset(path)
    with pytest.raises(InputError, match="no such data set"):
        read_dataset(tmp_path / "none.npz")


def test_separations_never_promise_too_much(data: Dataset) -> None:
    """They are lower bounds of the distances that the engine measures, and near to them for boxes."""
    compared, items = 0, ItemOf()
    with open_drops() as drops:
        for example in data:
            situation, pose = example.situation, example.situation.body.matrix
            drops.set_up(
                items(situation.body.form), [(items(o.form), o.matrix) for o in situation.others]
            )
            bounds = separations(situation.body.form, pose[None], Obstacles(situation.others))[0]
            for contact in drops.contacts(pose, 0.05):
                if contact.obstacle >= 0 and contact.distance > 0.0:
                    compared += 1
                    assert bounds[contact.obstacle] < contact.distance + 0.006
    assert compared > 3


def test_an_unknown_layout_is_named(tmp_path) -> None:
    with pytest.raises(InputError, match="unknown layout 'papre'"):
        generate(Job("on", "train", 4, layout="papre"), tmp_path / "x.npz", workers=1)


def test_negatives_at_the_edges_are_of_the_papers_layout_and_in_the_card(tmp_path: Path) -> None:
    path = tmp_path / "x.npz"
    with pytest.raises(InputError, match="'household' has no --edges"):
        generate(Job("on", "train", 40, edges=True), path, workers=1)
    job = Job("on", "train", 40, layout="paper", edges=True)
    data = generate(job, path, workers=1)
    assert data.card["edges"] is True and data.card["by type"]["beside"] == 4
    assert job.key != Job("on", "train", 40, layout="paper").key
    assert "edges" not in Job("on", "train", 40, layout="paper").card({})
