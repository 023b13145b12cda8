"""Hand-made generators: `surface` keeps bodies above the region, `uniform` fills the grown box evenly."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp.geometric.samplers.placements import (
    BOX_GROWTH_SHARE,
    KEEP_FACE,
    SurfacePlacements,
    UniformPlacements,
    position_inside,
)
from tamp.geometric.scene.scene import Box, Scene
from tamp.geometric.stability.placement import Placement, placed_pose
from tamp.geometric.stability.stable_poses import stable_faces_of
from tests.geometric.making import body, crate, scene, table

BRICK = body("brick", Box((0.06, 0.1, 0.2)), (0.0, 0.0, 0.6))
SCENE = scene(table(at=(1.0, -0.5)), crate(), BRICK)


def drawn(where: Scene, region: str, count: int = 300, name: str = "brick") -> list[Placement]:
    return SurfacePlacements().propose(where, (name, region), count, np.random.default_rng(0))


@pytest.mark.parametrize(("region", "size"), [("table", (1.0, 0.6)), ("crate_inside", (0.4, 0.4))])
def test_every_placement_keeps_the_whole_outline_above_the_region(
    region: str, size: tuple[float, float]
) -> None:
    faces = stable_faces_of(BRICK)
    for placement in drawn(SCENE, region):
        face = faces.ways[placement.face]
        c, s = math.cos(placement.yaw), math.sin(placement.yaw)
        outline = face.outline @ np.array([[c, s], [-s, c]]) + [placement.x, placement.y]
        assert placement.region == region
        assert (np.abs(outline) <= np.array(size) / 2 + 1e-9).all()


def test_the_face_that_is_down_is_kept_mostly() -> None:
    kept = np.mean([placement.face == 0 for placement in drawn(SCENE, "table", 2000)])
    # Of the six faces four withstand the tilt or more; the first comes up among the others too.
    steady = len(stable_faces_of(BRICK).faces)
    assert kept == pytest.approx(KEEP_FACE + (1 - KEEP_FACE) / steady, abs=0.03)


def test_under_a_low_ceiling_only_low_faces_are_proposed() -> None:
    tall = body("tall", Box((0.1, 0.1, 0.35)), (0.0, 0.0, 0.7))
    ways = stable_faces_of(tall).ways
    heights = [
        ways[placed.face].extent
        for placed in drawn(scene(crate(), tall), "crate_inside", 50, "tall")
    ]
    assert heights == pytest.approx([0.1] * 50)
    huge = body("huge", Box((0.31, 0.31, 0.31)), (0.0, 0.0, 0.7))
    assert drawn(scene(crate(), huge), "crate_inside", 50, "huge") == []


def test_placements_cover_the_region_and_all_yaws() -> None:
    placements = drawn(SCENE, "table", 1000)
    xs, yaws = np.array([p.x for p in placements]), np.array([p.yaw for p in placements])
    assert xs.min() < -0.4 and xs.max() > 0.4 and abs(xs.mean()) < 0.03
    quarters = np.histogram(yaws, 4, (-math.pi, math.pi))[0] / 1000
    assert quarters == pytest.approx(np.full(4, 0.25), abs=0.05)


def test_one_seed_one_proposal_and_poses_rest_on_the_surface() -> None:
    assert drawn(SCENE, "table", 5) == drawn(SCENE, "table", 5)
    T = SCENE.world_pose(SCENE.region("table"))
    for placement in drawn(SCENE, "table", 20):
        pose = placed_pose(stable_faces_of(BRICK), placement, T)
        low = pose.position[2] - stable_faces_of(BRICK).ways[placement.face].height
        assert low == pytest.approx(0.5 + 0.001, abs=1e-6)  # the table's top and the contact gap


def test_a_body_larger_than_the_region_has_its_centre_above_it() -> None:
    plank = body("plank", Box((1.5, 0.1, 0.05)), (0.0, 0.0, 0.6))
    face = stable_faces_of(plank).faces[0]
    rng = np.random.default_rng(1)
    for yaw in rng.uniform(-math.pi, math.pi, 100):
        x, y = position_inside(face, yaw, (1.0, 0.6), rng)
        assert (
            abs(x) <= 0.5 + 1e-9 and abs(y) <= 0.3 + 1e-9
        )  # its centre of mass is its frame's origin


def test_uniform_poses_fill_the_grown_box_of_the_regions_body() -> None:
    poses = UniformPlacements().propose(SCENE, ("brick", "table"), 3000, np.random.default_rng(0))
    positions = np.array([pose.position for pose in poses])
    # The table is 1 x 0.6 x 0.5 m about (1, -0.5, 0.25); it grows by half of half a metre on each side.
    grown = BOX_GROWTH_SHARE * 0.5
    low, high = np.array([0.5, -0.8, 0.0]) - grown, np.array([1.5, -0.2, 0.5]) + grown
    assert (positions >= low).all() and (positions <= high).all()
    assert positions.mean(axis=0) == pytest.approx((low + high) / 2, abs=0.03)
    assert np.ptp(positions, axis=0) == pytest.approx(high - low, rel=0.01)


def test_uniform_rotations_have_no_preferred_direction() -> None:
    poses = UniformPlacements().propose(SCENE, ("brick", "table"), 3000, np.random.default_rng(0))
    mean = np.mean([pose.rotation for pose in poses], axis=0)
    assert np.abs(mean).max() < 0.05  # the mean of uniform rotations is zero
    ups = np.array([pose.rotation[2, 2] for pose in poses])
    assert np.histogram(ups, 4, (-1.0, 1.0))[0] / 3000 == pytest.approx(
        np.full(4, 0.25), abs=0.04
    )  # Archimedes
