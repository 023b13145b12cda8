"""Furniture to stand on or in: its region is on or in it, and no piece is in two splits."""

from __future__ import annotations

import math

import pytest

from grounding.supports import PIECES, household_supports, scaled_region, support_templates
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose


@pytest.mark.parametrize("relation", ["on", "inside"])
def test_supports_carry_their_region_and_splits_share_none(relation: str) -> None:
    train, test = (support_templates(relation, split) for split in ("train", "test"))
    assert len(train) / PIECES["train"] == len(test) / PIECES["test"]
    assert train.keys().isdisjoint(test.keys())
    for support in (*train.values(), *test.values()):
        region = support.region
        assert region.hollow == (relation == "inside")
        assert region.matrix[2, 2] == pytest.approx(1.0) and (region.size > 0.05).all()
        low, high = bounds(support.parts, Pose())
        middle = region.matrix[:3, 3]
        assert (middle[:2] >= low[:2]).all() and (middle[:2] <= high[:2]).all()
        assert low[2] - 1e-9 <= middle[2] <= high[2] + 1e-9
        assert math.isfinite(region.size[2]) or relation == "on"


def test_a_scaled_region_is_larger_about_its_supports_origin() -> None:
    region = next(iter(support_templates("inside", "test").values())).region
    scaled = scaled_region(region, 2.0)
    assert scaled.matrix[:3, 3] == pytest.approx(2.0 * region.matrix[:3, 3])
    assert (scaled.matrix[:3, :3] == region.matrix[:3, :3]).all()
    assert scaled.size == pytest.approx(2.0 * region.size) and scaled.box == pytest.approx(
        2.0 * region.box
    )
    assert scaled.hollow


def test_a_household_scene_has_the_relations_pieces_first_and_tables_too() -> None:
    inside, tables = support_templates("inside", "test"), support_templates("on", "test")
    found = household_supports("inside", "test")
    assert [*found] == [*inside, *tables] and found[next(iter(inside))] is inside[
        next(iter(inside))
    ]
    assert [*household_supports("on", "test")] == [*tables]
