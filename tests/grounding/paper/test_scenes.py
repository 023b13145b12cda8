"""Scenes as the paper lays them out: upright, on its supports, half of them with nothing else there."""

from __future__ import annotations

import numpy as np

from grounding.dataset import Dataset
from grounding.demonstrations import KINDS, POSITIVE
from grounding.oracles import ItemOf, Verdict, drop_verdicts
from tamp.simulation.engines import open_drops


def test_labels_are_what_physics_says_and_kinds_have_their_shares(laid_out: Dataset) -> None:
    items = ItemOf()
    with open_drops() as drops:
        for example in laid_out:
            pose = example.situation.body.matrix[None]
            holds = drop_verdicts(example.situation, pose, drops, items)[0] is Verdict.HOLDS
            assert holds == example.holds == (example.kind in POSITIVE), example.kind
    assert laid_out.card["layout"] == "paper"
    assert set(laid_out.kinds) == set(KINDS[laid_out.relation])


def test_bodies_stand_upright_on_the_papers_supports(laid_out: Dataset) -> None:
    upright = [
        abs(example.situation.body.matrix[2, 2]) > 0.999 for example in laid_out if example.holds
    ]
    assert np.mean(upright) >= (0.8 if laid_out.relation == "on" else 0.4)
    names = {"table", "chest"} if laid_out.relation == "on" else {"square_box", "long_box"}
    assert set(laid_out.card["supports"]) == names


def test_half_of_the_scenes_have_nothing_else_on_the_support(laid_out: Dataset) -> None:
    alone = 0
    for example in laid_out:
        situation = example.situation
        half = situation.region.size[:2] / 2
        inner = [np.linalg.inv(situation.T_world_region) @ o.matrix[:, 3] for o in situation.others]
        alone += not any((np.abs(p[:2]) <= half).all() and 0 < p[2] < 1.0 for p in inner)
    assert 0.3 * len(laid_out) <= alone <= 0.7 * len(laid_out)
