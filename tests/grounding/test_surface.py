"""The engineer's sampler as a model: flush on a stable face within the region, and judged by geometry."""

from __future__ import annotations

import math

import numpy as np
import pytest

from grounding.relation_scene import relation_scene_of
from grounding.runtime import Grounding, laid
from grounding.surface import DEPTH, SurfaceModel
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import CONTACT_GAP, Box, Scene
from tamp.geometric.stability.placement import Placement
from tamp.geometric.stability.stable_poses import stable_faces_of
from tests.geometric.making import body, crate, scene, table

STANDS = 0.5 + CONTACT_GAP + 0.1


def with_brick(
    x: float = 0.2, y: float = 0.1, z: float = STANDS, roll: float = 0.0, *, beside: float = 0.0
) -> Scene:
    """A brick of 0.06 x 0.1 x 0.2 m on a table half a metre high, another one `beside` metres along x."""
    brick = body("brick", Box((0.06, 0.1, 0.2)), (x, y, z))
    pose = Pose.from_xyz_rpy((x, y, z), (roll, 0.0, 0.0))
    bodies = [table(), crate(), type(brick)(**{**vars(brick), "pose": pose})]
    return scene(
        *bodies, *([body("other", Box((0.06, 0.1, 0.2)), (x + beside, y, z))] if beside else [])
    )


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


def test_a_pose_near_the_region_becomes_a_placement_on_its_face() -> None:
    made = with_brick()
    faces = stable_faces_of(made.bodies["brick"])
    rotation, pose = faces.ways[0].rotation, made.bodies["brick"].pose
    found = laid(made, ("brick", "table"), rotation, pose.matrix)
    assert isinstance(found, Placement) and (found.region, found.face) == ("table", 0)
    assert (found.x, found.y) == pytest.approx((0.2, 0.1))
    high = Pose((0.2, 0.1, 2.0))
    assert laid(made, ("brick", "table"), rotation, high.matrix) == high
    assert laid(
        made, ("brick", "table"), np.eye(3)[[1, 2, 0]] * 0.5, pose.matrix
    ) == Pose.from_matrix(pose.matrix)
