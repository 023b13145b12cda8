"""Drop tests in MuJoCo: which obstacles are near, how a body comes to rest."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Part, Sphere
from tamp.simulation.drops import Item
from tamp.simulation.mujoco_drop import MujocoDrops

CUBE = Item((Part(Box((0.1, 0.1, 0.1))),))
SLAB = Item((Part(Box((1.0, 1.0, 0.2))),))
POST = Item((Part(Box((0.1, 0.1, 1.0))),))


@pytest.fixture
def drops() -> Iterator[MujocoDrops]:
    """A slab whose top is at 0.5, and a post with a side at x = 0.45 whose end is at 1.5."""
    made = MujocoDrops()
    made.set_up(CUBE, [(SLAB, Pose((0.0, 0.0, 0.4)).matrix), (POST, Pose((0.5, 0.0, 1.0)).matrix)])
    yield made
    made.close()


def near(drops: MujocoDrops, x: float, z: float, reach: float = 0.005) -> dict[int, float]:
    found = drops.contacts(Pose((x, 0.0, z)).matrix, reach)
    return {contact.obstacle: contact.distance for contact in found}


def test_obstacles_within_reach_are_told_with_their_distance() -> None:
    drops = MujocoDrops()
    ball = Item((Part(Sphere(0.05)),))
    drops.set_up(ball, [(SLAB, Pose((0.0, 0.0, 0.4)).matrix), (POST, Pose((0.5, 0.0, 1.0)).matrix)])
    assert near(drops, 0.0, 0.553) == pytest.approx({0: 0.003}, abs=1e-5)
    assert near(drops, 0.0, 0.548) == pytest.approx({0: -0.002}, abs=1e-5)
    assert near(drops, 0.0, 0.556) == {}
    assert near(drops, 0.0, 0.556, reach=0.01) == pytest.approx({0: 0.006}, abs=1e-5)
    assert near(drops, 0.398, 0.551) == pytest.approx({0: 0.001, 1: 0.002}, abs=1e-5)
    # beside the top edge of the post: near in x and in z, but not across the corner
    assert near(drops, 0.415, 1.536, reach=0.005) == pytest.approx(
        {1: math.hypot(0.035, 0.036) - 0.05}, abs=1e-5
    )
    assert near(drops, 0.41, 1.54, reach=0.005) == {}  # 6.6 mm across the corner


def test_the_floor_is_told_by_the_lowest_point(drops: MujocoDrops) -> None:
    turned = Pose.from_xyz_rpy((3.0, 0.0, 0.0), (math.pi / 4, 0.0, 0.0)).matrix.copy()
    down = 0.05 * math.sqrt(2)
    for height, distance in ((down + 0.002, 0.002), (down - 0.001, -0.001), (down + 0.006, None)):
        turned[2, 3] = height
        found = {one.obstacle: one.distance for one in drops.contacts(turned)}
        assert found == ({} if distance is None else {-1: pytest.approx(distance)})


def test_a_body_stays_where_it_stands_and_falls_where_it_does_not(drops: MujocoDrops) -> None:
    standing = Pose((0.0, 0.0, 0.551)).matrix
    assert drops.drop(standing, 1.0) == pytest.approx(standing, abs=2e-3)
    beside = drops.drop(Pose((-0.54, 0.0, 0.551)).matrix, 2.0)  # its middle is beyond the edge
    assert beside[2, 3] < 0.3


def test_it_falls_as_long_as_it_is_let(drops: MujocoDrops) -> None:
    """After t seconds by g t^2 / 2, at rest before: each drop begins anew."""
    high = Pose((-2.0, 0.0, 3.0)).matrix
    for seconds in (0.2, 0.4, 0.2):
        fallen = 3.0 - drops.drop(high, seconds)[2, 3]
        assert fallen == pytest.approx(9.81 * seconds**2 / 2, rel=0.03)


def test_a_drop_ends_when_it_has_come_to_rest(drops: MujocoDrops) -> None:
    """An hour's drop of a body that stands is over at once, the engine's clock says."""
    drops.drop(Pose((0.0, 0.0, 0.5502)).matrix, 3600.0)
    assert drops._world is not None
    assert drops._world._data.time < 10.0


def test_each_scene_replaces_the_one_before(drops: MujocoDrops) -> None:
    drops.set_up(CUBE, [(POST, Pose((0.0, 0.0, 0.5)).matrix)])
    assert near(drops, 0.0, 1.052) == pytest.approx({0: 0.002}, abs=1e-5)
    assert near(drops, 0.4, 0.552) == {}


def test_a_slippery_body_slides_where_another_one_holds() -> None:
    """On a slope of 0.3 rad: tan is 0.31; friction of a pair is the product of both."""
    slope = Pose.from_xyz_rpy((0.0, 0.0, 0.5), (0.0, 0.3, 0.0)).matrix
    on = slope.copy()
    on[:3, 3] += 0.1501 * slope[:3, 2]
    moved = {}
    for friction in (0.1, 0.9):
        drops = MujocoDrops()
        drops.set_up(Item(CUBE.parts, friction=friction), [(Item(SLAB.parts, friction=1.0), slope)])
        moved[friction] = float(np.linalg.norm(drops.drop(on, 0.4)[:3, 3] - on[:3, 3]))
    assert moved[0.9] < 0.01 < 0.05 < moved[0.1]


def test_without_a_scene_there_is_nothing_to_drop() -> None:
    with pytest.raises(ValueError, match="no scene"):
        MujocoDrops().drop(np.eye(4), 1.0)
