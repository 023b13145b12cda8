"""Relational coordinates: fitted to what was shown, there and back, kept in a card."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from grounding.dataset import Dataset, read_dataset
from grounding.registry import load_model
from grounding.relational.coordinates import RelationalCoordinates
from grounding.relational.measures import Measures, RegionFrame
from grounding.train import measure, train
from grounding.weights import Weights, write_weights
from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import CONTACT_GAP
from tests.grounding.forms import at, box, on_table
from tests.grounding.relational.situations import bricks
from tests.grounding.shown import demonstrations


@pytest.mark.parametrize("name", ["level", "anchor", "offset", "contained", "ceiling", "sides"])
@pytest.mark.parametrize("value", ["text", [], 9.5, -4, True, None])
def test_a_chart_that_is_none(name: str, value: Any, stored: Path) -> None:
    weights = train(read_dataset(stored), "transfer")
    entries = dict(weights.card)
    entries["chart"] = {**entries["chart"], name: value}
    path = stored.with_name("w.safetensors")
    write_weights(path, Weights(weights.arrays, entries))
    fits = {"contained": value is True, "ceiling": value in (9.5, -4, None) and value is not True}
    if fits.get(name, name in ("offset", "sides") and value in (9.5, -4) and value is not True):
        load_model(path)
        return
    with pytest.raises(InputError, match="no weights of 'transfer'"):
        load_model(path)


def test_what_was_shown_at_one_height_is_done_at_another(tmp_path: Path) -> None:
    """Where the plane of the place and the ground keep their distance, it is the plane that counts."""
    data = demonstrations(tmp_path, height=0.7)
    model = load_model(written(tmp_path, train(data, "transfer")))
    (tmp_path / "lower").mkdir()
    lower = demonstrations(tmp_path / "lower", height=0.45)[0].situation
    poses = model.propose(lower, 5, np.random.default_rng(0))
    assert len(poses) == 5
    feet = [(lower.body.form.vertices @ pose[:3, :3].T + pose[:3, 3])[:, 2].min() for pose in poses]
    assert np.abs(np.array(feet) - 0.45).max() < 0.01


def written(folder: Path, weights: Weights) -> Path:
    write_weights(folder / "m.safetensors", weights)
    return folder / "m.safetensors"


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


@pytest.fixture(scope="module")
def standing() -> list[Measures]:
    measured, holds = bricks(40)
    return [one for one, stands in zip(measured, holds, strict=True) if stands]


def test_what_stands_keeps_its_foot_on_the_plane(standing: list[Measures]) -> None:
    """Its height is noise, so it is the gap of a contact; the sides are the least room that any left."""
    chart = RelationalCoordinates.fit(standing)
    assert (chart.level, chart.anchor, chart.offset) == (0, 0, CONTACT_GAP)
    assert chart.contained and chart.ceiling == 1.0
    assert chart.sides == min(one.sides.min() for one in standing)
    assert not np.concatenate([chart.constraint_violation(one) for one in standing]).any()


def test_what_hangs_below_a_ceiling_keeps_its_distance_from_there() -> None:
    """Boards of all heights, whose tops are 0.05 m below the ceilings of shelves of all heights."""
    rng, shown = np.random.default_rng(0), []
    for _ in range(12):
        height, thick = rng.uniform(0.3, 0.9), rng.uniform(0.02, 0.2)
        view = RegionFrame(on_table(at(box(0.1, 0.1, thick), 0.0, 0.0, 1.0), height=height))
        shown.append(view.measure(Pose((0.0, 0.0, height - 0.05 - thick / 2)).matrix[None].copy()))
    chart = RelationalCoordinates.fit(shown)
    assert (chart.level, chart.anchor) == (2, 1) and chart.offset == pytest.approx(-0.05)
    assert chart.ceiling == pytest.approx(0.05)


@pytest.mark.parametrize("over", [0, 1, 2])
def test_who_mostly_stays_within_the_sides_is_contained(
    over: int, standing: list[Measures]
) -> None:
    """Of 20, one over the edge is 5 %, which is still for all; two are not."""
    shown = [
        one.moved(one.poses[:, :3, 3] + [0.4, 0.0, 0.0]) if row < over else one
        for row, one in enumerate(standing)
    ]
    far = [one.moved(np.array([[0.4, 0.0, 0.1]])) for one in standing[:over]]
    assert RelationalCoordinates.fit([*far, *shown[over:]]).contained is (over < 2)


def test_coordinates_are_a_share_of_the_room_that_is_left(standing: list[Measures]) -> None:
    chart = RelationalCoordinates.fit(standing)
    view = RegionFrame(on_table(at(box(0.1, 0.06, 0.04), 0.0, 0.0, 1.0)))
    face = np.array([int(np.argmax(view.steadiness))])
    found = chart.decode(view, face, np.array([[0.5, -0.5, 0.01, 0.0, 0.0, 2.0, 0.0]]))
    extent = (found.high - found.low)[0]
    middle = (found.high + found.low)[0] / 2
    assert sorted(extent) == pytest.approx([0.04, 0.06, 0.1])
    assert middle[:2] == pytest.approx([0.5, -0.5] * (np.array([0.4, 0.3]) - extent[:2] / 2))
    assert found.low[0, 2] == pytest.approx(CONTACT_GAP + 0.01)
    assert found.yaw[0] == pytest.approx(0.0)
    of_the_centre = replace(chart, contained=False).decode(
        view, face, np.array([[0.5, -2.0, 0.0, 0.0, 0.0, 0.0, 1.0]])
    )
    assert of_the_centre.centre[0, :2] == pytest.approx([0.2, -0.3])  # no farther than the side
    assert of_the_centre.yaw[0] == pytest.approx(math.pi / 2)


def test_no_more_tilt_is_proposed_than_the_widest(standing: list[Measures]) -> None:
    chart, view = RelationalCoordinates.fit(standing), standing[0].view
    found = chart.decode(
        view, np.zeros(2, int), np.array([[0, 0, 0, 0.5, -0.1, 1, 0], [0, 0, 0, 0.1, 0.05, 1, 0]])
    )
    assert found.tilt == pytest.approx(np.array([[0.12, -0.1], [0.1, 0.05]]))


def test_a_card_says_it_all_and_json_knows_no_infinite_ceiling(standing: list[Measures]) -> None:
    chart = replace(RelationalCoordinates.fit(standing), ceiling=math.inf)
    assert chart.card["ceiling"] is None
    assert RelationalCoordinates.from_card(chart.card) == chart
    for wrong in ({"level": 3}, {"anchor": 4}, {"level": -1}):
        with pytest.raises(ValueError, match="the chart has level"):
            RelationalCoordinates.from_card({**chart.card, **wrong})
