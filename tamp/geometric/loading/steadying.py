"""Static stability at the start: bodies are settled, or refused with the reason."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.loading.bodies import UnplacedBody
from tamp.geometric.loading.footing import (
    SUPPORT_PENETRATION_M,
    Footing,
    Ground,
    body_points,
    outside,
)
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.centre_of_mass import centre_of_mass
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body, Cavity, Surface

if TYPE_CHECKING:
    from jaxtyping import Float

MAX_TIP_RAD = math.radians(20.0)
"""A body that does not stand as it was given is tipped at most this far onto the face beside,
radians.
"""

TOUCHING_HEIGHT_M = 0.0005
"""Metres: points no higher than this above the lowest are down."""

MAX_ROLLS = 60
"""Edges over which a body is rolled, at most."""


def steady(
    bodies: Mapping[str, Body], drafts: Mapping[str, UnplacedBody]
) -> tuple[dict[str, Body], tuple[str, ...]]:
    """Compare how movable bodies stand with what the problem says, by the judge's rule.

    A body given by `on:` that would tip over a little is laid onto the face beside; one given by
    its pose gets the bodies that carry it, and a warning when nothing does.

    Returns:
        The bodies in their order, and warnings.

    Raises:
        InputError: A body given by `on:` does not stand there, with the reason.
    """
    steadied, ground, warnings = dict(bodies), Ground(bodies), list[str]()
    for name, body in bodies.items():
        if not body.movable:
            continue

        footing = ground.footing(body)
        entries = drafts[name].entries

        if "on" in entries:
            if footing.on and footing.why:
                body, footing = _tipped(body, footing, ground, warnings)
            why = _why_not(body, footing, bodies)
            if why:
                remedy = "Move it ('at:'), turn it ('yaw:', 'rpy:'), or put it onto something else"
                raise entries["on"].error(
                    f"{name} does not stand on '{entries['on'].text()}': {why}", remedy=remedy
                )
        elif footing.why:
            say = "hangs in the air" if not footing.on else "does not stand still"
            warnings.append(f"{name} {say}: {footing.why} (say 'on:', or 'fixed: true')")
            body = replace(body, support=None)

        carriers = tuple(other for other in bodies if other in footing.on and bodies[other].movable)
        steadied[name] = replace(body, carriers=() if footing.why else carriers)

    return steadied, tuple(warnings)


def _why_not(body: Body, footing: Footing, bodies: Mapping[str, Body]) -> str | None:
    """Explain why a body does not stand where the problem says; None when it does."""
    place = _place(body.support, bodies)
    if place is None:  # the floor, or a movable body
        return footing.why

    T_place_body = (bodies[place.body].pose @ place.pose).inverse() @ body.pose
    if isinstance(place, Cavity):
        points, half = T_place_body.apply(body_points(body)), np.array(place.size[:2]) / 2
        low, high = np.array([-half[0], -half[1], 0.0]), np.array([half[0], half[1], place.size[2]])
        beyond = float(np.maximum(low - points.min(axis=0), points.max(axis=0) - high).max())
        return (
            f"it protrudes by {1000 * beyond:.1f} mm"
            if beyond > SUPPORT_PENETRATION_M - 1e-5
            else footing.why
        )

    if place.body not in footing.on:
        below = ", ".join(sorted(footing.on)) or "nothing within 10 mm"
        return f"under it is {below}; the surface '{place.name}' is in the air there"
    centre = T_place_body.apply(centre_of_mass(body)[None])[0]
    beyond = float((np.abs(centre[:2]) - np.array(place.size) / 2).max())
    if beyond > 0.0:
        return f"its centre of mass is {1000 * beyond:.1f} mm beyond the surface's edge"
    return footing.why


def _place(support: str | None, bodies: Mapping[str, Body]) -> Surface | Cavity | None:
    places = (place for body in bodies.values() for place in (*body.surfaces, *body.cavities))
    return next((place for place in places if place.name == support), None)


def _tipped(
    body: Body, footing: Footing, ground: Ground, warnings: list[str]
) -> tuple[Body, Footing]:
    """Return the body on the face that it tips onto if that is near and carries it, else itself."""
    turn = tip(body)
    if turn is None:
        return body, footing
    R = turn @ body.pose.rotation
    angle = math.acos(min(1.0, (float(np.trace(turn)) - 1) / 2))
    low, _ = bounds(body.parts, body.pose)
    turned = replace(body, pose=Pose.from_matrix(_matrix(R, np.array(body.pose.position))))
    down, _ = bounds(turned.parts, turned.pose)
    x, y, z = turned.pose.position
    at = np.array([x, y, z + float(low[2] - down[2])])
    tipped = replace(body, pose=Pose.from_matrix(_matrix(R, at)))
    found = ground.footing(tipped)
    if found.why:
        return body, footing
    warnings.append(
        f"{body.name} is tipped by {math.degrees(angle):.1f} deg onto its nearest face: "
        f"{footing.why}"
    )
    return tipped, found


def tip(body: Body) -> Float[Array, "3 3"] | None:
    """Compute the rotation (3, 3), in the world, by which a body on a plane rolls until it lies
    still; None beyond MAX_TIP_RAD.
    """
    points = body.pose.rotation @ body_points(body).T
    centre = body.pose.rotation @ centre_of_mass(body)

    turn = np.eye(3)
    for _ in range(MAX_ROLLS):
        P, c = turn @ points, turn @ centre
        low = float(P[2].min())
        down = P[2] < low + TOUCHING_HEIGHT_M
        feet = P[:2, down].T
        if outside(c[:2], feet) <= 0.0:
            break

        pivot, axis = _edge(c[:2], feet)
        # Turning about the axis through the pivot moves the centre of mass outward and down.
        above = P[:, ~down] - np.array([[pivot[0]], [pivot[1]], [low]])
        ahead = np.array([axis[1], -axis[0]]) @ above[:2]
        angles = np.where(ahead > 1e-9, np.arctan2(above[2], ahead), np.inf)
        angle = float(angles.min(initial=np.inf))
        if not angle < MAX_TIP_RAD:
            return None

        turn = _about(axis, max(angle, 1e-6)) @ turn
        if math.acos(min(1.0, (float(np.trace(turn)) - 1) / 2)) > MAX_TIP_RAD:
            return None
    else:
        return None

    return turn


def _edge(centre: Array, feet: Array) -> tuple[Array, Array]:
    """Find the point (2,) of the feet about which the body tips, and the axis (2,): along the line
    that separates most.
    """
    angles = np.linspace(0.0, 2 * np.pi, 720, endpoint=False)
    directions = np.stack([np.cos(angles), np.sin(angles)])
    beyond = centre @ directions - (feet @ directions).max(axis=0)
    out = directions[:, int(np.argmax(beyond))]
    return feet[int(np.argmax(feet @ out))], np.array([-out[1], out[0]])


def _about(axis: Array, angle: float) -> Array:
    """Return the rotation (3, 3) by an angle about a horizontal unit vector (2,)."""
    x, y = axis
    K = np.array([[0.0, 0.0, y], [0.0, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + math.sin(angle) * K + (1 - math.cos(angle)) * K @ K


def _matrix(R: Array, position: Array) -> Array:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, position
    return T
