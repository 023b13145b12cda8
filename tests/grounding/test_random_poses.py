"""Random poses of bodies: at rest where they say, within their rectangle, rotations uniform."""

from __future__ import annotations

import math

import numpy as np
import pytest

from grounding.random_poses import (
    afloat,
    on_ground,
    pick,
    random_rest,
    random_scale,
    random_turn,
    solids,
    upright,
)
from grounding.relation_scene import Placed
from tamp.geometric.scene.scene import CONTACT_GAP
from tests.grounding.forms import at, box

FORM = box(0.1, 0.2, 0.3)
SIZE = np.array([0.6, 0.5, math.inf])


def corners(pose: np.ndarray) -> np.ndarray:
    return FORM.vertices @ pose[:3, :3].T + pose[:3, 3]


def rests(
    size: np.ndarray, overhang: bool, rng: np.random.Generator, count: int = 200
) -> list[np.ndarray]:
    found = [random_rest(FORM, size, overhang, rng) for _ in range(count)]
    return [pose for pose in found if pose is not None]


def test_at_rest_its_lowest_points_are_a_contacts_gap_above_the_region(
    rng: np.random.Generator,
) -> None:
    for pose in rests(SIZE, False, rng):
        low = np.sort(corners(pose)[:, 2])
        assert low[:4] == pytest.approx(np.full(4, CONTACT_GAP))  # a whole side of the box


def test_without_overhang_all_of_it_is_above_the_rectangle(rng: np.random.Generator) -> None:
    found = rests(SIZE, False, rng)
    assert len(found) == 200
    for pose in found:
        assert (np.abs(corners(pose)[:, :2]) <= SIZE[:2] / 2 + 1e-9).all()


def test_with_overhang_its_centre_is_two_centimetres_inside(rng: np.random.Generator) -> None:
    found = np.array(rests(SIZE, True, rng))
    assert (np.abs(found[:, :2, 3]) <= SIZE[:2] / 2 - 0.02 + 1e-9).all()
    beyond = [(np.abs(corners(pose)[:, :2]) > SIZE[:2] / 2).any() for pose in found]
    assert 0.1 < np.mean(beyond) < 0.9


def test_steadier_faces_come_more_often(rng: np.random.Generator) -> None:
    heights = np.round([np.ptp(corners(pose)[:, 2]) for pose in rests(SIZE, True, rng, 1500)], 3)
    counts = [int((heights == height).sum()) for height in (0.1, 0.2, 0.3)]
    assert counts[0] > counts[1] > counts[2] > 0 and sum(counts) == 1500


def test_what_does_not_fit_has_no_pose(rng: np.random.Generator) -> None:
    assert random_rest(FORM, (1.0, 1.0, 0.09), False, rng) is None  # no way under the ceiling
    low = rests(np.array([1.0, 1.0, 0.15]), False, rng, 50)
    assert {round(float(np.ptp(corners(pose)[:, 2])), 3) for pose in low} == {0.1}
    assert rests(np.array([0.05, 0.05, math.inf]), False, rng, 20) == []


def test_on_the_ground_it_stands_around_the_support(rng: np.random.Generator) -> None:
    stand = at(box(1.0, 0.6, 0.5), 3.0, -2.0, 0.25)
    for _ in range(50):
        pose = on_ground(FORM, stand, rng)
        assert pose is not None
        points = corners(pose)
        assert points[:, 2].min() == pytest.approx(CONTACT_GAP)
        assert (np.abs(points[:, :2] - [3.0, -2.0]) <= np.array([1.0, 0.8]) + 1e-9).all()


def test_in_the_air_it_is_around_and_above_the_support(rng: np.random.Generator) -> None:
    stand = at(box(1.0, 0.6, 0.5), 3.0, -2.0, 0.25)
    found = np.array([afloat(stand, rng)[:3, 3] for _ in range(300)])
    assert (found >= [2.0, -2.8, 0.15]).all() and (found <= [4.0, -1.2, 1.0]).all()
    assert np.ptp(found, axis=0) == pytest.approx([2.0, 1.6, 0.85], rel=0.1)


def test_random_turns_are_rotations_without_a_preferred_direction(rng: np.random.Generator) -> None:
    found = np.array([random_turn(rng) for _ in range(2000)])
    assert np.allclose(found[:, :3, :3] @ found[:, :3, :3].transpose(0, 2, 1), np.eye(3), atol=1e-9)
    assert (found[:, :3, 3] == 0.0).all()
    assert np.abs(found[:, :3, :3].mean(axis=0)).max() < 0.06
    # The angle of a uniform rotation has density (1 - cos a) / pi: its mean is pi / 2 + 2 / pi.
    angles = np.arccos(np.clip((np.trace(found[:, :3, :3], axis1=1, axis2=2) - 1) / 2, -1, 1))
    assert angles.mean() == pytest.approx(math.pi / 2 + 2 / math.pi, abs=0.05)


def test_upright_is_upright(rng: np.random.Generator) -> None:
    pose = upright(np.array([1.0, 2.0]), rng)
    assert pose[:3, 3].tolist() == [1.0, 2.0, 0.0] and pose[2, 2] == 1.0


def test_scales_come_in_steps_of_a_tenth_ends_included(rng: np.random.Generator) -> None:
    assert {random_scale((0.8, 1.2), rng) for _ in range(200)} == {0.8, 0.9, 1.0, 1.1, 1.2}


def test_names_are_picked_evenly(rng: np.random.Generator) -> None:
    picked = [pick({"a": 1, "b": 2, "c": 3}, rng) for _ in range(600)]
    assert all(150 < picked.count(name) < 250 for name in "abc")


def test_the_solids_of_a_support_stand_where_it_does() -> None:
    stand = at(FORM, 1.0, 2.0, 3.0, 0.5)
    (solid,) = solids(stand)
    assert isinstance(solid, Placed) and (solid.matrix == stand.matrix).all()
