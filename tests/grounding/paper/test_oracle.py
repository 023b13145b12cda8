"""The published oracle: own boxes, no physics, a tolerance of its own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from grounding.dataset import Dataset
from grounding.oracles import paper_oracle
from grounding.paper.oracle import in_place, own_box, published_oracle


def test_inside_is_labelled_by_the_published_test_and_half_turned_by_nothing(
    laid_out: Dataset,
) -> None:
    if laid_out.relation == "on":
        return
    unturned: list[bool] = []
    for example in laid_out:
        pose = example.situation.body.matrix
        if example.kind != "colliding":
            assert in_place(example.situation, pose[None])[0] == example.holds, example.kind
        if example.holds:
            unturned.append(bool(np.abs(pose[:3, :3] - np.eye(3)).max() < 0.05))
    assert 0.25 <= np.mean(unturned) <= 0.75


def test_the_published_oracle_is_the_stricter_one_on_what_rests(laid_out: Dataset) -> None:
    ours = theirs = 0
    for example in laid_out:
        pose = example.situation.body.matrix[None]
        judged = published_oracle(example.situation, pose)[0]
        ours += paper_oracle(example.situation, pose)[0]
        theirs += judged
        if not example.holds and example.kind != "colliding" and example.kind != "sticking out":
            assert not judged, example.kind
    assert 0 < theirs <= ours


def test_the_tolerance_is_the_published_oracles_own(laid_out: Dataset) -> None:
    example = next(example for example in laid_out if example.kind == "alone")
    situation = replace(example.situation, others=())
    pose = situation.body.matrix[None].copy()
    low = own_box(situation.body.form).corners[0]
    assert low == pytest.approx(situation.body.form.corners[0])
    pose[0, 2, 3] += 0.045
    if laid_out.relation == "on":
        assert not published_oracle(situation, pose)[0]
        assert published_oracle(situation, pose, near=0.06)[0]
