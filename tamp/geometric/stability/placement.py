"""Placements: a body laid on one of its faces in a region, from a sampler's word to the certified
pose.

A sampler that knows the face says so; one that knows a pose only has it snapped to the region,
once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import CONTACT_GAP, Cavity, Surface
from tamp.geometric.stability.stable_poses import Face, StableFaces, is_under
from tamp.stream import Rejection, RejectionKind

SNAP_HEIGHT_M = 0.03
"""A proposal whose lowest point is this near to the surface is put onto it (the paper's tolerance
for `on`), metres."""

WIDER_M = 5e-4
"""Metres by which a width must exceed another one to be called larger."""

BALANCE_MARGIN_M = 0.015
"""How far inside the supported part of an overhanging base the centre of mass must lie, metres."""


@dataclass(frozen=True)
class Placement:
    """A body on one of its stable faces in a region: all that the pose at rest is made of.

    Attributes:
        region: Name of the surface or the cavity.
        face: Which way up: an index that the body's `StableFaces.face` knows.
        x: Of the body's frame along the region frame's x axis, metres.
        y: The same along its y axis, metres.
        yaw: Turn about the region's normal, radians, after the face's rotation.
    """

    region: str
    face: int
    x: float
    y: float
    yaw: float


def snap_to_region(
    faces: StableFaces, T_world_body: Pose, region: Surface | Cavity, T_world_region: Pose
) -> Placement | Rejection:
    """Lay a proposed pose onto the stable face that is nearly down and the region that is nearly
    under it, or say why that cannot be. Where no stable face fits, onto a curved side.
    """
    index = faces.nearest(T_world_body.rotation, room_above(region))
    if index is None:
        return Rejection("stands on no stable face", kind=RejectionKind.UNSTABLE)
    face = faces.face(index)
    if (refused := _too_tall(face, region)) is not None:
        return refused

    T_region_body = T_world_region.inverse() @ T_world_body
    bottom = T_region_body.position[2] - face.height
    if abs(bottom) > SNAP_HEIGHT_M:
        return Rejection("too high" if bottom > 0 else "too low", kind=RejectionKind.UNSTABLE)

    return placement_on(index, face, T_region_body, region.name)


def placement_of(
    faces: StableFaces, proposal: Placement | Pose, region: Surface | Cavity, T_world_region: Pose
) -> Placement | Rejection:
    """Return the placement that a proposal means: itself, or the one that a pose T_world_body is
    nearest to, see `snap_to_region`.
    """
    if isinstance(proposal, Placement):
        return proposal
    return snap_to_region(faces, proposal, region, T_world_region)


def placement_on(index: int, face: Face, T_region_body: Pose, region: str) -> Placement:
    """Read the placement on a face that is known off a pose; its height and tilt are dropped.

    Args:
        index: Of the face, as the body's `StableFaces.face` knows it.
        face: It.
        T_region_body: The body's pose in the region's frame.
        region: Its name.
    """
    x, y, _ = T_region_body.position
    return Placement(region, index, x, y, _yaw_between(face.rotation, T_region_body.rotation))


def certified_pose(
    faces: StableFaces, placement: Placement, region: Surface | Cavity, T_world_region: Pose
) -> Pose | Rejection:
    """Return T_world_body of a placement that rests; rejected when it is too tall, overhangs the
    surface or protrudes from the cavity, or means another region.

    The body touches the region (up to CONTACT_GAP) with a stable face whose support lies inside the
    region.
    """
    if placement.region != region.name:
        return Rejection(f"placed in {placement.region}", kind=RejectionKind.FAULT)
    face = faces.face(placement.face)
    if (refused := _too_tall(face, region)) is not None:
        return refused

    turn, shift = _rotation(placement.yaw), (placement.x, placement.y)
    half = np.array(region.size[:2]) / 2
    outline = face.outline @ turn.T + shift
    if isinstance(region, Cavity):
        if (np.abs(outline) > half).any():
            return Rejection("protrudes", kind=RejectionKind.TOO_LARGE)
    else:
        base = face.base @ turn.T + shift
        centre = turn @ face.centre + shift
        if (np.abs(base) > half).any() and not _balanced(base, centre, half):
            return Rejection("overhangs", kind=RejectionKind.UNSTABLE)

    return placed_pose(faces, placement, T_world_region)


def room_above(region: Surface | Cavity) -> float:
    """Return how high things in a region can be, metres."""
    return region.clearance if isinstance(region, Surface) else region.size[2]


def placed_pose(faces: StableFaces, placement: Placement, T_world_region: Pose) -> Pose:
    """Return T_world_body where a placement puts the body, whether or not it rests there."""
    face = faces.face(placement.face)
    return T_world_region @ resting_pose(face, placement.yaw, placement.x, placement.y)


def resting_pose(face: Face, yaw: float, x: float, y: float) -> Pose:
    """Compute the body's pose in the region's frame, on `face`, turned by `yaw` radians, its frame
    above (x, y) metres.
    """
    matrix = np.eye(4)
    turn = np.eye(3)
    turn[:2, :2] = _rotation(yaw)
    matrix[:3, :3] = turn @ face.rotation
    matrix[:3, 3] = (x, y, face.height + CONTACT_GAP)
    return Pose.from_matrix(matrix)


def _yaw_between(reference: Array, rotation: Array) -> float:
    """Compute the turn about z, radians, that brings `reference` (3, 3) nearest to `rotation`."""
    relative = rotation @ reference.T
    return math.atan2(relative[1, 0] - relative[0, 1], relative[0, 0] + relative[1, 1])


def _rotation(yaw: float) -> Array:
    """Return the rotation of the plane by `yaw` radians, shape (2, 2)."""
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c, -s], [s, c]])


def _too_tall(face: Face, region: Surface | Cavity) -> Rejection | None:
    """Say by how much the body on this face is too tall for the room above the region."""
    room = room_above(region)
    if is_under(face, room):
        return None
    what = f"too tall ({face.extent:.2f} m, room for {room:.2f} m)"
    return Rejection(what, kind=RejectionKind.TOO_LARGE)


def _balanced(base: Array, centre: Array, half: Array) -> bool:
    """Check whether the centre of mass lies well inside both the base and the surface."""
    if (np.abs(centre) > half - BALANCE_MARGIN_M).any():
        return False
    edges = np.roll(base, -1, axis=0) - base
    lengths = np.linalg.norm(edges, axis=1)
    offsets = centre - base
    distances = (edges[:, 0] * offsets[:, 1] - edges[:, 1] * offsets[:, 0]) / np.maximum(
        lengths, 1e-12
    )
    return bool((distances > BALANCE_MARGIN_M).all())
