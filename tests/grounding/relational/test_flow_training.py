"""Training of the flow: what it returns is a flow, which learned where things were put."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import torch

from grounding.relational.coordinates import RelationalCoordinates
from grounding.relational.flow import AROUND, CONDITION, COORDINATES, Flow
from grounding.relational.flow_training import NARROW, FlowNet, FlowOptions, SceneBatch, train_flow
from grounding.relational.measures import Measures
from tests.grounding.relational.situations import bricks

FEW = FlowOptions(iterations=20, batch=16, hidden=16)


@pytest.fixture(scope="module")
def positive() -> list[Measures]:
    measured, holds = bricks(40)
    return [one for one, stands in zip(measured, holds, strict=True) if stands]


@pytest.fixture(scope="module")
def chart(positive: list[Measures]) -> RelationalCoordinates:
    return RelationalCoordinates.fit(positive)


def test_the_scale_is_the_size_of_each_coordinate_and_never_nothing(
    positive: list[Measures], chart: RelationalCoordinates
) -> None:
    """None of the bricks is tilted, and none above the table: those three are constant."""
    scale = train_flow(chart, positive, FEW)["scale"]
    coordinates = np.array([chart.encode(one).coordinates for one in positive])
    assert scale[[2, 3, 4]] == pytest.approx([NARROW] * 3)
    assert scale[:2] == pytest.approx(np.sqrt((coordinates[:, :2] ** 2).mean(axis=0)), rel=1e-5)
    assert scale[5] ** 2 + scale[6] ** 2 == pytest.approx(1.0, rel=1e-5)  # cosine and sine


def test_the_same_seed_gives_the_same_flow_and_torchs_own_numbers_are_left(
    positive: list[Measures], chart: RelationalCoordinates
) -> None:
    before = torch.get_rng_state()
    first, again = (train_flow(chart, positive, FEW) for _ in range(2))
    other = train_flow(chart, positive, replace(FEW, seed=1))
    assert torch.equal(torch.get_rng_state(), before)
    assert all(np.array_equal(first[name], again[name]) for name in first)
    assert any(not np.array_equal(first[name], other[name]) for name in first)


def test_it_learns_where_things_were_put(
    positive: list[Measures], chart: RelationalCoordinates
) -> None:
    """All bricks at one share of the room: so are those that are drawn."""
    place = np.array([0.5, -0.5, 0.0, 0.0, 0.0, 1.0, 0.0])
    face = np.array([int(positive[0].face[0])])
    there = [chart.decode(one.view, face, place[None]) for one in positive]
    said: list[tuple[int, int, float]] = []
    arrays = train_flow(
        chart, there, FlowOptions(iterations=300, batch=32, hidden=32),
        lambda *step: said.append(step),
    )  # fmt: skip
    assert [step for step, _, _ in said] == list(range(15, 301, 15)) and said[0][1] == 300
    assert said[-1][2] < 0.5 * said[0][2]
    drawn = Flow(chart, arrays).draw(positive[0].view, 200, np.random.default_rng(0))
    shares = [chart.encode(drawn.view.measure(pose[None])).coordinates[:2] for pose in drawn.poses]
    assert np.median(shares, axis=0) == pytest.approx([0.5, -0.5], abs=0.1)


def test_where_nothing_is_around_the_embedding_is_nothing() -> None:
    with torch.random.fork_rng():
        torch.manual_seed(0)
        net = FlowNet(8)
        x, time = torch.randn(2, COORDINATES), torch.rand(2, 1)
        known, one_way, other_way = (
            torch.randn(shape) for shape in ((2, CONDITION), (2, 2, AROUND), (2, 2, AROUND))
        )
    half = torch.ones(2, 2)
    missing = torch.tensor([[True, True], [False, True]])
    first, other = (SceneBatch(known, around, missing, half) for around in (one_way, other_way))
    with torch.no_grad():
        one, two = net(x, time, first), net(x, time, other)
    assert torch.equal(one[0], two[0]) and torch.isfinite(one).all()
    assert not torch.equal(one[1], two[1])


def test_some_scenes_of_a_batch() -> None:
    batch = SceneBatch(*(torch.arange(3.0)[:, None].expand(3, width) for width in (14, 6, 1, 2)))
    some = batch.take(torch.tensor([2, 0]))
    for part in (some.conditions, some.around, some.missing, some.half):
        assert part[:, 0].tolist() == [2.0, 0.0]
