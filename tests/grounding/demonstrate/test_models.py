"""Bodies to show relations with: every kind has some, and a hand can hold them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from grounding.demonstrate.models import ANY, HAND, MODELS, sample_body, sample_furniture
from grounding.demonstrate.relation import (
    KINDS,
)
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tests.geometric.making import drafts


def test_every_kind_but_surfaces_has_bodies(rng) -> None:
    for kind in KINDS[:-1]:
        chosen, entry = sample_body(kind, rng)
        assert chosen in MODELS and entry


DRAWS = 30


def test_a_hand_can_take_a_box_a_can_and_a_stick(rng) -> None:
    for _ in range(DRAWS):
        assert min(MODELS["box"](rng)["box"]) <= HAND
        assert 2 * MODELS["can"](rng)["cylinder"]["radius"] <= HAND + 1e-3  # as it is rounded
        assert sorted(MODELS["stick"](rng)["box"])[1] <= HAND


def test_an_object_is_any_of_those_that_may_be_one(rng) -> None:
    found = {sample_body("object", rng)[0] for _ in range(100)}
    assert found == {*ANY} and "plate" not in found
    assert {sample_body("plate", rng)[0] for _ in range(5)} == {"plate"}


def test_meshes_come_in_few_sizes(rng) -> None:
    """Each new one takes half a second to be read."""
    for name, low, high in (("cup", 0.65, 0.9), ("bowl", 0.75, 1.25), ("bottle", 0.7, 1.15)):
        scales = np.array([MODELS[name](rng)["scale"] for _ in range(200)])
        assert scales.min() >= low and scales.max() <= high
        assert scales * 20 == pytest.approx(np.round(scales * 20))
        assert len({*scales}) == round((high - low) * 20) + 1


def test_furniture_has_the_surface_that_is_named(rng, tmp_path: Path) -> None:
    kinds = set()
    for _ in range(DRAWS):
        name, entry, surface = sample_furniture(rng)
        text = json.dumps({name: {**entry, "at": [0, 0, 0]}})  # which is YAML, too
        body = drafts(tmp_path, text)[name].body
        assert surface in {one.name for one in body.surfaces}
        low, high = bounds(body.parts, Pose())
        assert high - low == pytest.approx(entry["size"], abs=1e-6)
        kinds.add(name)
    assert kinds == {"table", "bench", "cupboard"}
