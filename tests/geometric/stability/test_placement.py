"""Placements: what a sampler says is what is certified, and a pose is read back to the same numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import CONTACT_GAP, Body, Box, Cavity, Cylinder, Part, Surface
from tamp.geometric.stability.placement import (
    SNAP_HEIGHT_M,
    Placement,
    certified_pose,
    placed_pose,
    placement_on,
    snap_to_region,
)
from tamp.geometric.stability.stable_poses import StableFaces, stable_faces_of
from tamp.stream import Rejection, RejectionKind

T_WORLD_TOP = Pose.from_xyz_yaw(1.0, -2.0, 0.7, 0.4)
TOP = Surface("top", "table", Pose(), (0.4, 0.3), clearance=0.25)
BIN = Cavity("bin", "table", Pose(), (0.4, 0.3, 0.25))
BRICK = Body("brick", (Part(Box((0.06, 0.1, 0.2))),), Pose((0.0, 0.0, 1.0)), movable=True)
FACES = stable_faces_of(BRICK)


def reason(found: Pose | Placement | Rejection) -> tuple[str, RejectionKind]:
    assert isinstance(found, Rejection)
    return found.reason, found.kind


@pytest.mark.parametrize("face", range(len(FACES.ways)))
def test_a_pose_is_read_back_to_the_placement_that_it_was_made_of(face: int) -> None:
    said = Placement("top", face, 0.03, -0.02, 2.5)
    pose = certified_pose(FACES, said, TOP, T_WORLD_TOP)
    assert isinstance(pose, Pose)
    read = snap_to_region(FACES, pose, TOP, T_WORLD_TOP)
    assert isinstance(read, Placement) and (read.region, read.face) == ("top", face)
    assert (read.x, read.y, read.yaw) == pytest.approx((0.03, -0.02, 2.5), abs=1e-12)


def test_the_frames_of_a_placement_are_the_regions() -> None:
    upright = FACES.nearest(np.eye(3))
    assert upright == 0  # the way up that it has at the start
    pose = placed_pose(FACES, Placement("top", upright, 0.1, 0.05, 0.3), T_WORLD_TOP)
    assert pose.yaw == pytest.approx(0.4 + 0.3)
    assert T_WORLD_TOP.inverse().apply(np.array([pose.position]))[0] == pytest.approx(
        [0.1, 0.05, 0.1 + CONTACT_GAP]
    )


def test_tilt_and_height_within_the_limits_are_taken_away() -> None:
    said = Placement("top", 0, 0.03, -0.02, 0.5)
    flush = placed_pose(FACES, said, T_WORLD_TOP)
    above = Pose(
        (flush.position[0], flush.position[1], flush.position[2] + 0.9 * SNAP_HEIGHT_M),
        flush.quaternion,
    )
    leaning = above @ Pose.from_xyz_rpy((0.0, 0.0, 0.0), (math.radians(5.0), 0.0, 0.0))
    read = snap_to_region(FACES, leaning, TOP, T_WORLD_TOP)
    assert isinstance(read, Placement)
    assert (read.face, read.x, read.y) == (0, pytest.approx(0.03), pytest.approx(-0.02))
    assert certified_pose(FACES, read, TOP, T_WORLD_TOP) == placed_pose(FACES, read, T_WORLD_TOP)


def test_what_does_not_rest_is_rejected_with_its_kind() -> None:
    flush = placed_pose(FACES, Placement("top", 0, 0.0, 0.0, 0.0), T_WORLD_TOP)
    x, y, z = flush.position
    high, low = (
        Pose((x, y, z + side * 1.1 * SNAP_HEIGHT_M), flush.quaternion) for side in (1.0, -1.0)
    )
    on_edge = flush @ Pose.from_xyz_rpy((0.0, 0.0, 0.0), (math.radians(45.0), 0.0, 0.0))
    assert reason(snap_to_region(FACES, high, TOP, T_WORLD_TOP)) == (
        "too high",
        RejectionKind.UNSTABLE,
    )
    assert reason(snap_to_region(FACES, low, TOP, T_WORLD_TOP)) == (
        "too low",
        RejectionKind.UNSTABLE,
    )
    assert reason(snap_to_region(FACES, on_edge, TOP, T_WORLD_TOP))[0] == "stands on no stable face"

    shallow = Surface("top", "table", Pose(), (0.4, 0.3), clearance=0.15)
    tall = certified_pose(FACES, Placement("top", 0, 0.0, 0.0, 0.0), shallow, T_WORLD_TOP)
    assert reason(tall) == ("too tall (0.20 m, room for 0.15 m)", RejectionKind.TOO_LARGE)


def test_a_surface_carries_an_overhang_that_balances_and_a_cavity_holds_all() -> None:
    def at(x: float, region: Surface | Cavity) -> Pose | Rejection:
        return certified_pose(FACES, Placement(region.name, 0, x, 0.0, 0.0), region, T_WORLD_TOP)

    assert isinstance(at(0.17, TOP), Pose) and isinstance(at(0.17, BIN), Pose)  # the edge is at 0.2
    assert isinstance(at(0.18, TOP), Pose)  # 1 cm over it, 2 cm from it to the centre of mass
    assert reason(at(0.18, BIN)) == ("protrudes", RejectionKind.TOO_LARGE)
    assert reason(at(0.19, TOP)) == ("overhangs", RejectionKind.UNSTABLE)


def test_a_placement_in_another_region_is_not_reinterpreted() -> None:
    said = certified_pose(FACES, Placement("bin", 0, 0.0, 0.0, 0.0), TOP, T_WORLD_TOP)
    assert reason(said) == ("placed in bin", RejectionKind.FAULT)


def test_the_face_that_is_said_is_kept_where_another_is_nearer() -> None:
    """Of a pose only the nearest face can be read; a placement says which is meant."""
    other = next(number for number, face in enumerate(FACES.ways) if abs(face.rotation[2, 2]) < 0.5)
    nearly_upright = Pose()
    assert FACES.nearest(nearly_upright.rotation) != other
    said = placement_on(other, FACES.ways[other], nearly_upright, "top")
    pose = certified_pose(FACES, said, TOP, T_WORLD_TOP)
    assert isinstance(pose, Pose) and FACES.nearest(pose.rotation) == other


def test_a_face_is_found_again_by_its_rotation() -> None:
    again = StableFaces(BRICK)
    assert [again.index_of(face.rotation) for face in FACES.ways] == list(range(6))
    assert again.index_of(np.full((3, 3), 0.5)) is None


CAN = stable_faces_of(
    Body("can", (Part(Cylinder(0.03, 0.2)),), Pose((0.0, 0.0, 1.0)), movable=True)
)
LOW = Surface("board", "shelf", Pose(), (0.4, 0.3), clearance=0.15)


@pytest.mark.parametrize("face", CAN.under(LOW.clearance))
def test_what_can_only_lie_under_a_ceiling_is_laid_on_its_curved_side(face: int) -> None:
    pose = certified_pose(CAN, Placement("board", face, 0.03, -0.02, 2.5), LOW, T_WORLD_TOP)
    assert isinstance(pose, Pose)
    assert abs(pose.rotation[2, 2]) < 1e-9 and pose.position[2] == pytest.approx(
        0.7 + 0.03 + CONTACT_GAP
    )
    read = snap_to_region(CAN, pose, LOW, T_WORLD_TOP)
    assert isinstance(read, Placement)
    assert read.face == face and (read.x, read.y, read.yaw) == pytest.approx(
        (0.03, -0.02, 2.5), abs=1e-9
    )


def test_where_it_can_stand_it_is_not_laid_down() -> None:
    lying = Pose.from_xyz_rpy((1.0, -2.0, 0.73), (math.pi / 2, 0.0, 0.0))
    assert CAN.under(TOP.clearance) == (0, 1)
    assert reason(snap_to_region(CAN, lying, TOP, T_WORLD_TOP))[0] == "stands on no stable face"


def test_a_curved_side_that_overhangs_with_its_middle_is_refused() -> None:
    face = CAN.under(LOW.clearance)[0]
    said = certified_pose(CAN, Placement("board", face, 0.19, 0.0, 0.0), LOW, T_WORLD_TOP)
    assert reason(said)[0] == "overhangs"
