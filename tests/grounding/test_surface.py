"""The engineer's sampler as a model: flush on a stable face within the region, and judged by geometry."""

from __future__ import annotations

import math

import numpy as np
import pytest

from grounding.relation_scene import relation_scene_of
from grounding.runtime import Grounding
from grounding.surface import DEPTH, SurfaceModel
from tamp.geometric.scene.scene import CONTACT_GAP, Box, Scene
from tests.geometric.making import body, crate, scene
from tests.grounding.forms import STANDS, with_brick


def holds(made: Scene, place: str = "table") -> float:
    return Grounding(SurfaceModel()).classify(made, ("brick", place))


@pytest.mark.parametrize(
    ("made", "yes"),
    [
        (with_brick(), True),
        (with_brick(x=0.49), True),  # half of it over the edge, its centre is not
        (with_brick(x=0.51), False),
        (with_brick(y=-0.31), False),
        (with_brick(z=STANDS + 0.2), False),  # in the air
        (with_brick(z=STANDS - 0.2), False),  # in the table
        (with_brick(roll=math.radians(45)), False),
        (with_brick(z=STANDS - 0.05, roll=math.radians(90)), True),  # it lies
        (with_brick(beside=0.07), True),
        (with_brick(beside=0.06 - 2 * DEPTH), False),  # another brick is in it
    ],
)
def test_what_is_on_a_table(made: Scene, yes: bool) -> None:
    assert holds(made) == float(yes)


def test_inside_is_all_of_it_within_the_walls_and_under_the_ceiling() -> None:
    floor = 0.02 + CONTACT_GAP + 0.1
    assert holds(with_brick(2.0, 0.0, floor), "crate_inside") == 1.0
    assert holds(with_brick(2.15, 0.0, floor), "crate_inside") == 1.0
    assert (
        holds(with_brick(2.18, 0.0, floor), "crate_inside") == 0.0
    )  # one centimetre over the edge
    low = body("brick", Box((0.06, 0.1, 0.31)), (2.0, 0.0, 0.02 + CONTACT_GAP + 0.155))
    assert holds(scene(crate(), low), "crate_inside") == 0.0


@pytest.mark.parametrize("place", ["table", "crate_inside"])
def test_what_it_proposes_it_accepts_where_nothing_is_around(place: str) -> None:
    situation = relation_scene_of(with_brick(), ("brick", place))
    model = SurfaceModel()
    poses = model.propose(situation, 50, np.random.default_rng(0))
    assert poses.shape == (50, 4, 4)
    assert model.classify(situation, poses) == pytest.approx(np.ones(50))


def test_nothing_is_proposed_under_too_low_a_ceiling_or_of_no_number() -> None:
    huge = body("brick", Box((0.35, 0.35, 0.35)), (0.2, 0.1, 0.7))
    situation = relation_scene_of(scene(crate(), huge), ("brick", "crate_inside"))
    assert SurfaceModel().propose(situation, 5, np.random.default_rng(0)).shape == (0, 4, 4)
    fine = relation_scene_of(with_brick(), ("brick", "table"))
    assert SurfaceModel().propose(fine, 0, np.random.default_rng(0)).shape == (0, 4, 4)
