"""Training of the ranker: it learns what is to be seen, the same from the same seed, and keeps its best."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import torch

from grounding.relational.ranker import PAIR, POSE, Ranker
from grounding.relational.training import RankerNet, RankerOptions, train_ranker
from tests.grounding.relational.situations import bricks

FEW = RankerOptions(iterations=40, batch=32, hidden=16, pooled=4)


def test_what_is_not_there_does_not_count() -> None:
    with torch.random.fork_rng():
        torch.manual_seed(0)
        net, pose, pair = RankerNet(16, 4), torch.randn(3, POSE), torch.randn(3, 4, PAIR)
    missing = torch.tensor([[False, False, True, True]] * 3)
    other = pair.clone()
    other[:, 2:] = 100.0
    with torch.no_grad():
        assert torch.equal(net(pose, pair, missing), net(pose, other, missing))
        assert not torch.equal(net(pose, pair, missing), net(pose, other, missing & False))


def test_it_learns_what_stands_and_what_hangs() -> None:
    measured, holds = bricks(80)
    arrays, accuracy = train_ranker(measured, holds, replace(FEW, iterations=150))
    assert accuracy == 1.0
    unseen, truth = bricks(40, seed=1)
    ranker = Ranker(arrays)
    assert [float(ranker.logits(one)[0]) > 0.0 for one in unseen] == truth.tolist()


@pytest.mark.parametrize("count", [20, 60])
def test_the_same_seed_gives_the_same_ranker_and_torchs_own_numbers_are_left(count: int) -> None:
    measured, holds = bricks(count)
    before = torch.get_rng_state()
    first, again = (train_ranker(measured, holds, FEW)[0] for _ in range(2))
    other = train_ranker(measured, holds, replace(FEW, seed=1))[0]
    assert torch.equal(torch.get_rng_state(), before)
    assert all(np.array_equal(first[name], again[name]) for name in first)
    assert any(not np.array_equal(first[name], other[name]) for name in first)


def test_what_is_kept_is_the_best_that_was_looked_at() -> None:
    """Labels of chance and large steps: it is better after three of the twenty looks than at the end."""
    measured, _ = bricks(30)
    holds = np.random.default_rng(0).random(30) < 0.5
    seen: list[float] = []
    steps: list[tuple[int, int]] = []

    def progress(step: int, total: int, accuracy: float) -> None:
        steps.append((step, total))
        seen.append(accuracy)

    arrays, accuracy = train_ranker(measured, holds, replace(FEW, rate=0.03, batch=4), progress)
    assert steps == [(step, 40) for step in range(2, 41, 2)]
    assert accuracy == max(seen) > seen[-1]
    ranker = Ranker(arrays)
    right = [
        (float(ranker.logits(one)[0]) > 0.0) == truth
        for one, truth in zip(measured, holds, strict=True)
    ]
    assert np.mean(right) == pytest.approx(accuracy)


@pytest.mark.parametrize(("count", "among"), [(49, 49), (50, 5)])
def test_of_few_labels_none_is_spared(count: int, among: int) -> None:
    """Of 49 scenes all choose the checkpoint; of 50 a tenth does, five of them."""
    measured, _ = bricks(count)
    holds = np.random.default_rng(count).random(count) < 0.5
    seen: list[float] = []
    train_ranker(measured, holds, FEW, lambda step, total, accuracy: seen.append(accuracy))
    right = np.array(seen) * among
    assert right == pytest.approx(np.round(right), abs=1e-4)
    assert ((right > 0) & (right < among)).any()  # else any number would do
