"""Placements on and in movable bodies: their places move with them, so each is of one pose of the
body below.

What stands on a body that stands on others weighs on all of them: its centre of mass must be over
every base and every place below it, or the tower would fall.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.context import Context
from tamp.geometric.scene.centre_of_mass import centre_of_mass
from tamp.geometric.scene.outline import outline
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import LEVEL_COSINE, Cavity, Surface
from tamp.geometric.stability.hulls import body_hull
from tamp.geometric.stability.placement import (
    BALANCE_MARGIN_M,
    Placement,
    certified_pose,
    placement_of,
)
from tamp.geometric.stability.stable_poses import Face
from tamp.geometric.streams.proposal_stream import certified_poses
from tamp.geometric.streams.refusals import no_fit
from tamp.stream import Call, Rejection, RejectionKind

if TYPE_CHECKING:
    from jaxtyping import Float

STACK_MARGIN_M = 0.008
"""Metres by which a centre of mass must be inside of all bases and places below it."""

CENTRED_SHARE = 0.25
"""Share of its way from the middle that a body keeps which is larger than the place under it: a
tower stands the better the less its bodies are beside each other."""

BASE_CORNER_HEIGHT_M = 0.001
"""Metres above the lowest point of a body up to which its corners belong to its base."""


def sample_on_movable(
    context: Context, body: str, surface: str, below: str, below_pose: Pose, call: Call
) -> Iterator[Pose | Rejection]:
    """Sample poses at rest on a surface of a movable body that stands at a pose."""
    region = context.scene.surfaces[surface]
    return _placements(context, "on", body, region, below, below_pose, call)


def sample_inside_movable(
    context: Context, body: str, container: str, below: str, below_pose: Pose, call: Call
) -> Iterator[Pose | Rejection]:
    """Sample poses at rest on the floor of a cavity of a movable body that stands at a pose, all of
    the body within the cavity.
    """
    region = context.scene.cavities[container]
    return _placements(context, "inside", body, region, below, below_pose, call)


def shift(
    context: Context,
    body: str,
    pose: Pose,
    place: str,
    below: str,
    was: Pose,
    now: Pose,
    call: Call,
) -> Iterator[Pose]:
    """Return where a body is that stood on another one, when that has been carried elsewhere."""
    region = context.scene.region(place)
    shifted = now @ was.inverse() @ pose
    here = _corners(region, now @ region.pose)
    under = footing(context, below, now)
    context.footings[body, shifted] = (*under, here, base(context, body, shifted))
    yield shifted


def _placements(
    context: Context, relation: str, body: str, region: Surface | Cavity, below: str,
    below_pose: Pose, call: Call,
) -> Iterator[Pose | Rejection]:  # fmt: skip
    T_world_region = below_pose @ region.pose
    faces = context.stable_faces(body)
    refusal = _no_room(context, body, region, T_world_region)
    if refusal is not None:
        yield refusal
        return

    def judge(proposal: Placement | Pose) -> Pose | Rejection:
        placement = placement_of(faces, proposal, region, T_world_region)
        if isinstance(placement, Rejection):
            return placement

        placement = _centred(faces.ways[placement.face], placement, region)
        pose = certified_pose(faces, placement, region, T_world_region)
        if isinstance(pose, Rejection):
            return pose

        hit = context.collisions.between(body, pose, {})
        if hit is not None:
            return Rejection.hits(hit)
        return stood_on(context, body, pose, region, below, below_pose)

    mixture = context.mixtures[relation]
    at = {below: below_pose}
    yield from certified_poses(context, relation, mixture, (body, region.name), judge, call, at)


def stood_on(
    context: Context, body: str, pose: Pose, region: Surface | Cavity, below: str, below_pose: Pose
) -> Pose | Rejection:
    """Return a pose at rest in a place of a movable body that is at a pose, or say that this would
    tip; what may stand on the body there is kept for `footing`.
    """
    under = footing(context, below, below_pose)
    centre = pose.apply(centre_of_mass(context.scene.bodies[body])[None])[0, :2]
    if min(inside(centre, polygon) for polygon in under) < STACK_MARGIN_M:
        what = f"would tip {below}, or what that stands on"
        return Rejection(what, kind=RejectionKind.UNSTABLE, bodies=(below,))

    here = _corners(region, below_pose @ region.pose)
    context.footings[body, pose] = (*under, here, base(context, body, pose))
    return pose


def _no_room(
    context: Context, body: str, region: Surface | Cavity, T_world_region: Pose
) -> Rejection | None:
    """Say why a body can be placed nowhere in a region that is there; None where it may."""
    refused = no_fit(context, body, region)
    if refused is not None:
        return refused

    ways = context.stable_faces(body).ways
    if isinstance(region, Surface) and not any(_carries(face, region) for face in ways):
        size = " x ".join(f"{100 * side:.1f}" for side in region.size)
        what = f"{region.name} is too small to carry {body} ({size} cm)"
        return Rejection(what, given_up=True, kind=RejectionKind.UNSTABLE, bodies=(region.body,))

    if T_world_region.rotation[2, 2] < LEVEL_COSINE:
        what = f"{region.name} is not level: {region.body} lies on another side"
        return Rejection(what, given_up=True, kind=RejectionKind.UNSTABLE, bodies=(region.body,))
    return None


def _carries(face: Face, surface: Surface) -> bool:
    """Check whether a body on this face can stand on a surface, within it or balanced over it."""
    from_middle = np.linalg.norm(face.base - face.centre, axis=1).max()
    return min(surface.size) / 2 > min(BALANCE_MARGIN_M, float(from_middle))


def _centred(face: Face, placement: Placement, region: Surface | Cavity) -> Placement:
    """Bring a body that is larger than the surface nearer to its middle."""
    if isinstance(region, Cavity):
        return placement
    c, s = math.cos(placement.yaw), math.sin(placement.yaw)
    turn, shift = np.array([[c, -s], [s, c]]), np.array([placement.x, placement.y])
    corners = face.base @ turn.T + shift
    if (np.abs(corners) <= np.array(region.size) / 2).all():
        return placement
    x, y = shift - (1.0 - CENTRED_SHARE) * (turn @ face.centre + shift)
    return replace(placement, x=float(x), y=float(y))


def footing(context: Context, body: str, pose: Pose) -> tuple[Float[Array, "n 2"], ...]:
    """Return the convex polygons (n, 2), metres, over all of which whatever stands on a body at a
    pose must have its centre of mass: its base, the places and bases below it.
    """
    cached = context.footings.get((body, pose))
    if cached is not None:
        return cached

    polygons = [base(context, body, pose)]
    scene, start = context.scene, context.scene.bodies[body]
    place = scene.surfaces.get(start.support or "")
    if pose == start.pose:
        if place is not None:
            owner = scene.bodies[place.body]
            polygons.append(_corners(place, owner.pose @ place.pose))
        under = start.support if place is None else place.body
        carriers = {*start.carriers, under} & set(scene.movable) - {body}
        if len(carriers) == 1:
            (carrier,) = carriers
            polygons += footing(context, carrier, scene.bodies[carrier].pose)
    else:
        polygons += [
            _corners(surface, there)
            for surface in scene.surfaces.values()
            if surface.body in scene.fixed
            and _stands(context, body, pose, surface, there := scene.world_pose(surface))
        ]

    context.footings[body, pose] = tuple(polygons)
    return context.footings[body, pose]


def _stands(context: Context, body: str, pose: Pose, surface: Surface, there: Pose) -> bool:
    """Check whether a body's base is at a surface's height, its centre of mass above it."""
    vertices, _ = body_hull(context.scene.bodies[body])
    low = float(pose.apply(vertices)[:, 2].min())
    centre = pose.apply(centre_of_mass(context.scene.bodies[body])[None])[0, :2]
    height = abs(low - there.position[2])
    return height < 3 * BASE_CORNER_HEIGHT_M and inside(centre, _corners(surface, there)) >= 0.0


def base(context: Context, body: str, pose: Pose) -> Float[Array, "n 2"]:
    """Compute the outline (n, 2) of what a body at a pose stands on, counterclockwise, metres."""
    vertices, _ = body_hull(context.scene.bodies[body])
    placed = pose.apply(vertices)
    return outline(placed[placed[:, 2] < placed[:, 2].min() + BASE_CORNER_HEIGHT_M, :2])


def _corners(region: Surface | Cavity, T_world_region: Pose) -> Float[Array, "4 2"]:
    """Return the corners of a level region seen from above, counterclockwise, metres."""
    x, y = region.size[0] / 2, region.size[1] / 2
    corners = np.array([(-x, -y, 0.0), (x, -y, 0.0), (x, y, 0.0), (-x, y, 0.0)])
    return T_world_region.apply(corners)[:, :2]


def inside(point: Float[Array, " 2"], polygon: Float[Array, "n 2"]) -> float:
    """Measure by how much a point is inside of a convex polygon (n, 2), counterclockwise, metres;
    negative outside.
    """
    if len(polygon) < 3:
        return -math.inf
    edges = np.roll(polygon, -1, axis=0) - polygon
    to = point - polygon
    across = edges[:, 0] * to[:, 1] - edges[:, 1] * to[:, 0]
    return float((across / np.maximum(np.linalg.norm(edges, axis=1), 1e-12)).min())
