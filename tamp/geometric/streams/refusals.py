"""Reasons why a body cannot be grasped or put somewhere at all; a proof only where every other way
was looked at.

What is not proven is said as well, but as given up: a run that ends with it claims nothing.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from tamp.geometric.context import Context
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import (
    Body,
    Box,
    Cavity,
    Cylinder,
    Part,
    Sphere,
    Surface,
)
from tamp.geometric.stability.hulls import body_hull, part_mesh
from tamp.geometric.stability.placement import WIDER_M, room_above
from tamp.geometric.stability.slices import cut, distances
from tamp.geometric.stability.stable_poses import Face, facets, fits
from tamp.geometric.streams.hand_fit import FRICTION_CONE_RAD
from tamp.geometric.streams.reach import within_reach
from tamp.stream import Rejection, RejectionKind

SURE_SHARE_OF_WIDTH = 0.97
"""Of a width measured on the polyhedron that stands for a curved body, so much is certain."""

MOST_FACETS = 300
"""Ways up that are looked at for a proof; a body with more is taken for a curved one, of which
nothing is proven."""

PLACE_SPACING_M = 0.004
"""Spacing of the places that are looked at for a proof that all are taken, metres,"""

MAX_PLACES = 40_000
"""and how many they are at most: in a larger region they are farther apart."""

JUST_ABOVE = 0.002
"""Height above a region at which a body on it and what is in its way are cut, metres."""

GRASP_HEADROOM_M = 2.0
"""Metres above a surface up to which a body on it may be grasped."""


def no_grasp(body: Body, opening: float) -> Rejection:
    """Say why a body gave no grasp, by a hand that opens so wide, metres."""
    width = narrowest(body)
    if width is None:
        least = _least_width(body)
        wide = (
            f": no side of {body.name} is under {100 * least:.1f} cm, "
            f"the hand opens {100 * opening:.0f} cm"
        )
        return Rejection(
            f"no grasp was found{wide if least > opening else ''}",
            given_up=True,
            kind=RejectionKind.NO_GRASP,
        )

    if width > opening + WIDER_M:
        what = f"no grasp: every width is over the hand's {opening * 100:.0f} cm"
        return Rejection(what, kind=RejectionKind.TOO_LARGE)

    return Rejection(
        f"no grasp was found ({100 * width:.1f} cm wide, the hand opens {100 * opening:.0f} cm)",
        given_up=True,
        kind=RejectionKind.NO_GRASP,
    )


def narrowest(body: Body) -> float | None:
    """Compute the least distance between two contacts that hold a body of one simple shape, metres;
    None for other bodies.

    On a curved side friction holds what is grasped beside its middle, where it is a little
    narrower.
    """
    if len(body.parts) != 1:
        return None
    shape = body.parts[0].shape
    if isinstance(shape, Box):
        return min(shape.size)
    if isinstance(shape, Cylinder):
        return min(shape.height, 2 * shape.radius * math.cos(FRICTION_CONE_RAD))
    return 2 * shape.radius * math.cos(FRICTION_CONE_RAD) if isinstance(shape, Sphere) else None


def no_room(context: Context, body: str, region: Surface | Cavity) -> Rejection | None:
    """Say why a body can be placed nowhere in a region; None where it may."""
    if context.scene.bodies[region.body].movable:
        what = (
            f"{region.name} is on {region.body}, which may be moved; "
            "only fixed bodies can be put things on in this domain: 'domain: carriers' can"
        )
        return Rejection(what, given_up=True, kind=RejectionKind.UNSTABLE, bodies=(region.body,))
    refused = no_fit(context, body, region)
    if refused is not None:
        return refused
    room = room_above(region)
    return _out_of_reach(context, body, region, room)


def no_fit(context: Context, body: str, region: Surface | Cavity) -> Rejection | None:
    """Say why a body can be placed nowhere in a region, wherever that is; None where it may."""
    room = room_above(region)
    shape = context.scene.bodies[body]
    stable = context.stable_faces(body)
    if not (stable.ways or stable.curved):
        ball = all(isinstance(part.shape, Sphere) for part in shape.parts)
        reason = (
            f"a sphere rests on no stable face ({body})"
            if ball
            else f"{body} rests on no stable face"
        )
        return Rejection(reason, given_up=True, kind=RejectionKind.UNSTABLE)

    low = [stable.face(number) for number in stable.under(room)]
    if not low:
        least = min(face.extent for face in (*stable.ways, *stable.curved))
        what = f"protrudes ({body} is {least:.2f} m tall, {region.name} has room for {room:.2f} m)"
        may = _could_fit(shape, room, None)
        return Rejection(what, given_up=may, kind=RejectionKind.TOO_LARGE)

    if isinstance(region, Cavity) and not any(fits(face, region.size) for face in low):
        size, space = (
            " x ".join(f"{length:.2f}" for length in box) for box in (_extents(low[0]), region.size)
        )
        what = f"protrudes ({body} takes {size} m, {region.name} has {space} m)"
        may = _could_fit(shape, room, region)
        return Rejection(what, given_up=may, kind=RejectionKind.TOO_LARGE)

    return None


def covered(context: Context, body: str, region: Surface | Cavity) -> Rejection | None:
    """Say why a body of one convex part finds no free place among the fixed bodies in a region;
    None unless proven.

    Wherever it rests, its centre of mass is over the region and well inside the side that is down;
    so a disc around it, just above the region, must be free.
    """
    shape, stable = context.scene.bodies[body], context.stable_faces(body)
    low = [stable.face(number) for number in stable.under(room_above(region))]
    if len(shape.parts) != 1 or not low:
        return None
    ways = (*stable.ways, *low)

    radius = min(_room_around(face) * max(0.0, 1.0 - 4 * JUST_ABOVE / face.extent) for face in ways)
    cell = max(PLACE_SPACING_M, math.sqrt(region.size[0] * region.size[1] / MAX_PLACES))
    if radius <= cell:
        return None

    x, y = (np.arange(-side / 2, side / 2 + cell, cell) for side in region.size[:2])
    grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    T_world_region = context.scene.world_pose(region)
    places = T_world_region.apply(np.column_stack([grid, np.zeros(len(grid))]))
    if np.ptp(places[:, 2]) > WIDER_M:
        return None

    least, names = np.full(len(grid), np.inf), list[str]()
    for name in context.scene.fixed:
        other = context.scene.bodies[name]
        before = least.copy()
        for part in other.parts:
            vertices, triangles = part_mesh(part)
            corners = cut(other.pose.apply(vertices), triangles, float(places[0, 2]) + JUST_ABOVE)
            if corners is not None:
                np.minimum(least, distances(places[:, :2], corners), out=least)
        if (least < np.minimum(before, radius)).any():
            names.append(name)

    if not (least < radius - cell).all():
        return None
    return Rejection.hits(*names, who="every place there")


def _room_around(face: Face) -> float:
    """Compute how far the centre of mass is from the edges of the side that is down, metres; zero
    where it is not inside.
    """
    edges = np.roll(face.base, -1, axis=0) - face.base
    to = face.centre - face.base
    across = edges[:, 0] * to[:, 1] - edges[:, 1] * to[:, 0]
    return max(0.0, float((across / np.maximum(np.linalg.norm(edges, axis=1), 1e-12)).min()))


def _out_of_reach(
    context: Context, body: str, region: Surface | Cavity, room: float
) -> Rejection | None:
    """Say why the arm gets nowhere near the region; the body may stand out over the edge of a
    surface.
    """
    beyond = 2 * context.radius(body) if isinstance(region, Surface) else 0.0
    height = min(room, GRASP_HEADROOM_M)
    box = Part(
        Box((region.size[0] + beyond, region.size[1] + beyond, height)),
        Pose((0.0, 0.0, height / 2)),
    )
    reachable = within_reach(context, *bounds((box,), context.scene.world_pose(region)))
    return (
        replace(reachable, reason=f"{region.name} is {reachable.reason}")
        if isinstance(reachable, Rejection)
        else None
    )


def _could_fit(body: Body, room: float, cavity: Cavity | None) -> bool:
    """Check whether the body might rest under so low a ceiling after all, on a side that is not
    steady; or nobody knows.
    """
    sides = facets(body, MOST_FACETS)
    if sides is None:
        return True
    low = [side for side in sides if SURE_SHARE_OF_WIDTH * side.extent - WIDER_M <= room]
    return any(
        cavity is None or fits(side, [length / SURE_SHARE_OF_WIDTH for length in cavity.size])
        for side in low
    )


def _least_width(body: Body) -> float:
    """Compute the least of the body's widths square to a facet, metres."""
    vertices, triangles = body_hull(body)
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    normals = normals[lengths > 1e-12] / lengths[lengths > 1e-12, None]
    widths: Array = np.ptp(vertices @ normals.T, axis=0)
    return float(widths.min())


def _extents(face: Face) -> tuple[float, float, float]:
    width, depth = np.ptp(face.outline, axis=0)
    return float(width), float(depth), face.extent
