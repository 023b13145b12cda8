"""The ceiling of what sees no surroundings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grounding.dataset import Dataset
from grounding.oracles import paper_oracle
from grounding.paper.blind_ceiling import BlindModel, CornerModel, blind_ceiling
from grounding.paper.oracle import published_oracle


def test_an_ideal_generator_fails_by_the_surroundings_alone(laid_out: Dataset) -> None:
    rng = np.random.default_rng(0)
    model = BlindModel("upright", 0.5)
    seen = with_none = 0.0
    for example in laid_out:
        situation = example.situation
        poses = model.propose(situation, 4, rng)
        seen += paper_oracle(situation, poses).mean()
        with_none += paper_oracle(replace(situation, others=()), poses).mean()
    assert seen < with_none
    if laid_out.relation == "on":
        assert with_none == len(laid_out)  # nothing but other bodies makes it fail
    assert np.isnan(model.classify(laid_out[0].situation, poses)).all()
    ceiling = blind_ceiling(laid_out, range(len(laid_out)), 4, 0)
    assert 0.4 < ceiling.published <= ceiling.mca < 1.0
    assert ceiling.corner > ceiling.published


def test_who_goes_to_a_corner_fails_by_what_is_there_or_does_not_fit(laid_out: Dataset) -> None:
    rng = np.random.default_rng(0)
    for example in laid_out:
        situation = replace(example.situation, others=())
        region, form = situation.region, situation.body.form
        poses = CornerModel().propose(situation, 8, rng)
        inner = np.linalg.inv(situation.T_world_region) @ poses
        low, high = form.corners
        middles = inner[:, :2, 3] + (inner[:, :3, :3] @ (low + high) / 2)[:, :2]
        assert len(np.unique(np.sign(middles), axis=0)) > 1  # more than one of the corners
        edges, box = np.sort(high - low), np.sort(np.ptp(region.box[:, :2], axis=0))
        height = region.box[1, 2] - region.matrix[2, 3]
        room = min(height - edges[0], *(box - edges[1:])) if region.hollow else np.inf
        if abs(room) > 0.01:
            assert published_oracle(situation, poses).all() == (room > 0)
