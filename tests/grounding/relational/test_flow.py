"""The flow's velocity in numpy is torch's; what it looks at is worked out by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import torch

from grounding.dataset import Dataset
from grounding.relational.coordinates import RelationalCoordinates
from grounding.relational.flow import (
    AROUND,
    CONDITION,
    COORDINATES,
    PAIR,
    Flow,
    condition,
    levelled,
    pair_features,
    surroundings,
)
from grounding.relational.flow_training import FlowNet, SceneBatch
from grounding.relational.measures import RegionFrame
from grounding.train import measure
from tests.grounding.forms import TOP, at, box, on_table
from tests.grounding.relational.situations import bricks


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


def test_what_physics_leaves_of_a_height_or_a_tilt_is_nothing() -> None:
    coordinates = np.zeros((4, COORDINATES))
    coordinates[:, 2] = [0.0029, -0.0029, 0.0031, 0.0]
    coordinates[:, 3:5] = [[0.03, 0.03], [0.04, 0.04], [0.0, -0.06], [0.049, 0.0]]
    found = levelled(coordinates)
    assert found[:, 2].tolist() == [0.0, 0.0, 0.0031, 0.0]
    assert found[:, 3:5].tolist() == [[0.0, 0.0], [0.04, 0.04], [0.0, -0.06], [0.0, 0.0]]


def test_what_is_around_is_a_box_in_the_regions_frame() -> None:
    other = at(box(0.1, 0.2, 0.3), 0.2, -0.1, TOP + 0.15)
    view = RegionFrame(on_table(at(box(0.1, 0.06, 0.04), 0.0, 0.0, 1.0), other))
    assert surroundings(view)[0] == pytest.approx([0.2, -0.1, 0.05, 0.1, 0.0, 0.3], abs=1e-6)
    alone = RegionFrame(on_table(at(box(0.1, 0.06, 0.04), 0.0, 0.0, 1.0)))
    assert surroundings(alone).shape == (0, AROUND)


def test_a_pair_is_told_by_how_far_its_boxes_are_apart() -> None:
    """A body of 0.1 x 0.06 m at (0.1, 0); beside it, at x = 0.3, what reaches 0.05 m to each side."""
    known = np.zeros((1, CONDITION))
    known[0, 4:7] = 4 * np.array([0.1, 0.06, 0.04])
    around = np.array([[0.3, 0.0, 0.05, 0.05, 0.0, 0.2]])
    found = np.concatenate(pair_features(np.array([[0.1, 0.0]]), known, around), axis=2)
    assert found.shape == (1, 1, PAIR)
    away, gap, half = [0.2, 0.0], [0.1, -0.08], [0.05, 0.03]
    expected = [*(4 * v for v in away), *(8 * v for v in gap), *(8 * v for v in half)]
    assert found[0, 0, :6] == pytest.approx(expected)
    assert found[0, 0, 6:] == pytest.approx([0.4, 0.4, 0.0, 1.6])


def test_what_is_known_of_a_face_is_its_extents_and_the_region() -> None:
    view = RegionFrame(on_table(at(box(0.1, 0.06, 0.04), 0.0, 0.0, 1.0), height=2.0))
    known = condition(view)
    assert known.shape == (6, CONDITION)
    assert known[:, 6] / 4 == pytest.approx(
        [np.ptp(view.form.vertices @ turn[2]) for turn in view.rotations], abs=1e-6
    )
    assert sorted({round(float(height) / 4, 3) for height in known[:, 6]}) == [0.04, 0.06, 0.1]
    assert known[:, 7:10] == pytest.approx(np.tile(np.log([0.04, 0.06, 0.1]) / 3 + 1, (6, 1)))
    assert known[:, 10:] == pytest.approx(np.tile([0.0, 0.8, 0.6, 1.5], (6, 1)))


@pytest.mark.parametrize("scale", [np.ones(6), np.zeros(COORDINATES), np.full(COORDINATES, np.nan)])
def test_a_scale_that_is_none_is_refused(scale: np.ndarray) -> None:
    chart = RelationalCoordinates.fit(bricks(1)[0])
    with pytest.raises(ValueError, match="not one of 7 coordinates"):
        Flow(chart, {**FlowNet(8).arrays(), "scale": scale.astype(np.float32)})


def test_only_steady_faces_are_drawn_and_the_steadiest_where_none_is() -> None:
    """A plate stands on its rim less steadily than it lies."""
    view = RegionFrame(on_table(at(box(0.2, 0.2, 0.04), 0.0, 0.0, 1.0)))
    flat = view.steadiness.max()
    lying = {*np.flatnonzero(view.steadiness == flat).tolist()}
    assert 0 < len(lying) < len(view.faces)
    chart = RelationalCoordinates.fit(bricks(1)[0])
    arrays = {**FlowNet(8).arrays(), "scale": np.ones(COORDINATES, np.float32)}
    for steadiness, faces in ((0.5 * flat, lying), (2.0 * flat, lying), (0.0, {*range(6)})):
        flow = Flow(replace(chart, steadiness=float(steadiness)), arrays)
        drawn = flow.draw(view, 300, np.random.default_rng(0))
        assert drawn.poses.shape == (300, 4, 4)
        assert {*drawn.face.tolist()} == faces
        again = flow.draw(view, 300, np.random.default_rng(0))
        assert np.array_equal(drawn.poses, again.poses)
