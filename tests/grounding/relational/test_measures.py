"""A body at a pose, measured in its region's frame: each length worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from grounding.relation_scene import Placed, Region, RelationScene
from grounding.relational.measures import (
    SURROUNDINGS_M,
    RegionFrame,
    inverse,
    resting,
    turns,
    upright,
)
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Box, Part
from tests.grounding.forms import TOP, at, box, can, on_table, turned

SIZE = (0.1, 0.06, 0.04)


def standing(x: float = 0.1, y: float = -0.05, z: float = 0.02) -> Array:
    return Pose((x, y, z)).matrix[None]


def view(*others: Placed, height: float = math.inf) -> RegionFrame:
    return RegionFrame(on_table(at(box(*SIZE), 0.0, 0.0, 1.0), *others, height=height))


def test_a_body_beside_the_middle() -> None:
    found = view().measure(standing())
    assert found.low[0] == pytest.approx([0.05, -0.08, 0.0])
    assert found.high[0] == pytest.approx([0.15, -0.02, 0.04])
    assert found.centre[0] == pytest.approx([0.1, -0.05, 0.02])
    assert found.sides[0] == pytest.approx([0.4 - 0.15, 0.3 - 0.08])
    assert found.balance[0] == pytest.approx([0.4 - 0.1, 0.3 - 0.05])


def test_a_body_over_the_edge_sticks_out_and_may_still_be_balanced() -> None:
    found = view().measure(standing(x=0.37))
    assert found.sides[0, 0] == pytest.approx(-0.02)
    assert found.balance[0, 0] == pytest.approx(0.03)


def test_the_room_above_is_a_metre_where_nothing_is_above() -> None:
    assert view().measure(standing()).ceiling[0] == 1.0
    assert view(height=0.3).measure(standing()).ceiling[0] == pytest.approx(0.26)
    assert view(height=0.03).measure(standing()).ceiling[0] == pytest.approx(-0.01)


def test_tilt_and_yaw_are_told_apart() -> None:
    """Turned by 0.7 about the vertical and then by 0.2 about x: up is at sin 0.2 along the tilted axes."""
    leaning = turned(0.2, 0.0, 0.0) @ turned(0.0, 0.0, 0.7)
    found = view().measure(np.stack([leaning, turned(0.0, 0.0, 0.7)]))
    assert np.linalg.norm(found.tilt, axis=1) == pytest.approx([math.sin(0.2), 0.0], abs=1e-9)
    assert found.yaw[1] - found.yaw[0] == pytest.approx(0.0, abs=1e-9)
    further = view().measure(turned(0.0, 0.0, 0.9)[None])
    assert further.yaw[0] - found.yaw[1] == pytest.approx(0.2)


def test_the_face_is_the_one_that_is_nearest_to_being_down() -> None:
    frame = view()
    flat, side = frame.measure(
        np.stack([turned(0.1, 0.0, 0.0), turned(math.pi / 2 + 0.1, 0.0, 0.0)])
    ).face
    assert frame.rotations[flat] @ [0.0, 0.0, -1.0] == pytest.approx([0.0, 0.0, -1.0], abs=1e-6)
    assert frame.rotations[side] @ [0.0, -1.0, 0.0] == pytest.approx([0.0, 0.0, -1.0], abs=1e-6)


def test_what_is_moved_is_measured_where_it_is() -> None:
    frame = view(at(box(0.1, 0.1, 0.1), 0.3, 0.0, TOP + 0.05))
    poses = np.stack([turned(0.3, 0.1, 0.5), turned(0.0, 0.0, 1.0)])
    places = np.array([[0.1, 0.2, 0.05], [-0.1, 0.0, 0.3]])
    moved = frame.measure(poses).moved(places)
    anew = frame.measure(moved.poses)
    assert (moved.poses[:, :3, 3] == places).all()
    for name in ("low", "high", "centre", "face", "tilt", "yaw", "sides", "nearest"):
        assert getattr(moved, name) == pytest.approx(getattr(anew, name)), name


def test_what_is_next_to_it_is_as_near_as_the_gap() -> None:
    other = at(box(0.1, 0.1, 0.1), 0.23, -0.05, TOP + 0.05)
    assert view(other).measure(standing()).nearest[0] == pytest.approx(0.23 - 0.05 - 0.15)
    assert view().measure(standing()).nearest[0] == SURROUNDINGS_M


def test_bodies_far_from_the_region_are_left_out() -> None:
    """What counts is the sphere around a body; that of a cube of 0.1 m has the radius 0.087 m."""
    for beyond, seen in ((0.08, 1), (0.095, 0)):
        other = at(box(0.1, 0.1, 0.1), 0.4 + SURROUNDINGS_M + beyond, 0.0, TOP + 0.1)
        assert view(other).obstacles.count == seen


def test_walls_are_in_the_way_and_what_is_below_the_plane_is_not() -> None:
    floor = Part(Box((0.4, 0.4, 0.02)), Pose((0.0, 0.0, 0.01)))
    wall = Part(Box((0.02, 0.4, 0.1)), Pose((0.19, 0.0, 0.07)))
    region = Region(
        True, Pose((0.0, 0.0, 0.02)).matrix, np.array([0.36, 0.4, 0.1]),
        np.array([[-0.2, -0.2, 0.0], [0.2, 0.2, 0.12]]),
    )  # fmt: skip
    crate = at(box(1.0, 1.0, 1.0), 1.0, 2.0, 0.0, yaw=0.5)
    crate = Placed(type(crate.form)((floor, wall)), crate.matrix)
    frame = RegionFrame(RelationScene(crate, region, at(box(*SIZE), 0.0, 0.0, 1.0), ()))
    assert frame.obstacles.count == 1
    assert frame.measure(standing(0.0, 0.0)).nearest[0] == pytest.approx(0.18 - 0.05)


def test_a_bricks_flat_face_withstands_most() -> None:
    """It tips over the nearer edge, 0.03 m away, with its centre 0.02 m high."""
    faces = resting(box(*SIZE))
    assert len(faces) == 6
    best = int(np.argmax(faces.steadiness))
    assert faces.steadiness[best] == pytest.approx(math.atan2(0.03, 0.02), abs=0.02)
    assert faces.descriptors[best] == pytest.approx(
        [faces.steadiness[best], 0.0, 0.0, math.log(0.04 / 0.06)], abs=1e-3
    )


def test_a_can_of_scale_two_has_the_faces_of_scale_one() -> None:
    form = can(0.03, 0.1)
    frame = RegionFrame(on_table(at(form.scaled(2.0), 0.0, 0.0, 1.0)))
    assert frame.faces is resting(form)
    assert frame.size == pytest.approx(np.log([0.12, 0.12, 0.2]), abs=0.01)


@pytest.mark.parametrize("tilt", [(0.0, 0.0), (0.3, 0.0), (0.0, -0.4), (0.3, 0.5)])
def test_a_tilted_up_is_turned_up_the_shortest_way(tilt: tuple[float, float]) -> None:
    (found,) = upright(np.array([tilt]))
    up = np.array([*tilt, math.sqrt(1 - tilt[0] ** 2 - tilt[1] ** 2)])
    assert found @ up == pytest.approx([0.0, 0.0, 1.0])
    assert found @ found.T == pytest.approx(np.eye(3)) and np.linalg.det(found) == pytest.approx(1)
    assert (np.trace(found) - 1) / 2 == pytest.approx(up[2])  # by no larger angle than up is off


def test_a_turn_about_the_vertical_and_a_transform_there_and_back() -> None:
    (quarter,) = turns(np.zeros(1), np.ones(1))
    assert quarter @ [1.0, 0.0, 0.0] == pytest.approx([0.0, 1.0, 0.0])
    pose = turned(0.3, -0.2, 0.9, (0.1, 0.2, 0.3))
    assert inverse(pose) @ pose == pytest.approx(np.eye(4))
