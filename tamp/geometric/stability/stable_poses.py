"""Stable poses: which ways up a body can rest."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.centre_of_mass import centre_of_mass
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import CONTACT_GAP, Body, Sphere
from tamp.geometric.stability.facets import facet_normals, rotation_to_down, tipping_angle
from tamp.geometric.stability.hulls import body_hull, outline
from tamp.geometric.stability.shapes import once_a_shape

if TYPE_CHECKING:
    from jaxtyping import Float

SNAP_TILT_RAD = math.radians(15.0)
"""A proposal tilted less than this from a stable face, or than the face withstands, is laid onto
that face."""

FACE_HEIGHT_M = 0.0005
"""Vertices within this height of the lowest one belong to the face that is down, metres."""

WIDTH_SLACK_M = 0.002
"""What half a degree can change of a body's width, metres."""

STABLE_TILT_RAD = math.radians(8.0)
"""A face is stable when the body must be tilted at least this much before it tips over the face's
edge."""


CURVED_HEIGHT_M = 0.0015
"""Points this little above the lowest one count as touching where a body lies on a curved side,
metres."""

CURVED_MARGIN_M = 0.002
"""By so much a curved side carries beyond its lowest points: meshes have few of them, metres."""

CURVED_SIDE_ANGLE_RAD = math.radians(40.0)
"""Curved sides that a body might lie on are at least so far apart: of a can every one is like the
next."""

MOST_CURVED = 300
"""Sides of a body's hull that are looked at for curved ones: the largest."""


@lru_cache(maxsize=512)
def stable_faces_of(body: Body) -> StableFaces:
    """Return the ways in which a body can rest, worked out once for each body."""
    return StableFaces(body)


@dataclass(frozen=True, eq=False)
class Face:
    """A way to rest.

    Attributes:
        rotation: Turns the body so that the face is down; shape (3, 3).
        height: Of the body's frame above the support, metres.
        extent: Height of the body resting so, metres.
        outline: The body's vertices seen from above in the turned frame, (n, 2).
        base: Corners of the face itself in the turned frame, (k, 2), counterclockwise.
        angle: The tilt that it withstands, radians.
        centre: The centre of mass seen from above, (2,).
    """

    rotation: Array
    height: float
    extent: float
    outline: Array
    base: Array
    angle: float
    centre: Array


class StableFaces:
    """The stable faces of one body, the one it rests on at the start first.

    The centre of mass is that of the convex hull of all parts, which is exact for one convex part.
    """

    def __init__(self, body: Body) -> None:
        self.body = body

    @cached_property
    def faces(self) -> tuple[Face, ...]:
        """Return all ways to rest that withstand a tilt of STABLE_TILT_RAD: the present one, then
        the steadiest.
        """
        down = -self.body.pose.rotation[2]
        faces = stable_faces(self.body)
        faces.sort(
            key=lambda face: (
                -round(float(-face.rotation[2] @ down) > math.cos(SNAP_TILT_RAD)),
                -face.angle,
            )
        )
        return tuple(faces)

    @cached_property
    def lying(self) -> Face | None:
        """Return the curved side that the body lies on at the start; None where that is a stable
        face, or it is a ball.

        What lies there can lie so elsewhere, though a touch may roll it: a way to rest where there
        is no better one.
        """
        down = -self.body.pose.rotation[2]
        if self.body.support is None or all(
            isinstance(part.shape, Sphere) for part in self.body.parts
        ):
            return None
        if any(float(-face.rotation[2] @ down) > math.cos(SNAP_TILT_RAD) for face in self.faces):
            return None
        return curved_face(self.body, self.body.pose.rotation)

    @cached_property
    def ways(self) -> tuple[Face, ...]:
        """Return the stable faces, and the curved side that it lies on."""
        return self.faces if self.lying is None else (*self.faces, self.lying)

    @cached_property
    def curved(self) -> tuple[Face, ...]:
        """Return curved sides that the body might be laid on, though it stands now, the lowest
        first; none of a ball.

        They are a way to rest only where no other one fits under the ceiling.
        """
        if all(isinstance(part.shape, Sphere) for part in self.body.parts):
            return ()
        return curved_faces(self.body, self.ways)

    def face(self, index: int) -> Face:
        """Return the face with this index: of `ways`, and beyond these of `curved`."""
        steady = len(self.ways)
        return self.ways[index] if index < steady else self.curved[index - steady]

    def under(self, room: float) -> tuple[int, ...]:
        """List the faces on which the body fits under a ceiling `room` metres above its support:
        stable ones, where there are none the curved side that it lies on, and last any curved one.
        """
        ways = [number for number, face in enumerate(self.ways) if is_under(face, room)]
        steady = tuple(number for number in ways if number < len(self.faces))
        if steady or ways:
            return steady or tuple(ways)
        first = len(self.ways)
        return tuple(n for n, face in enumerate(self.curved, first) if is_under(face, room))

    def nearest(self, rotation: Float[Array, "3 3"], room: float = math.inf) -> int | None:
        """Find the way onto which the body, let go under this rotation (3, 3), tips back: an index
        of `ways`, or of a curved side where nothing else fits under a ceiling `room` metres above;
        None when it may tip over.
        """
        numbers = range(len(self.ways))
        if (low := self.under(room)) and low[0] >= len(self.ways):
            numbers = low
        if not numbers:
            return None
        best = max(numbers, key=lambda number: float(self.face(number).rotation[2] @ rotation[2]))
        face = self.face(best)
        cosine = float(face.rotation[2] @ rotation[2])
        return best if cosine >= math.cos(max(SNAP_TILT_RAD, face.angle)) else None

    def index_of(self, rotation: Float[Array, "3 3"]) -> int | None:
        """Find the way that this rotation (3, 3) turns down, exactly: an index of `ways`."""
        for number, face in enumerate(self.ways):
            if (face.rotation == rotation).all():
                return number
        return None


def is_under(face: Face, room: float) -> bool:
    """Check whether the body on this face is lower than a ceiling `room` metres above."""
    return face.extent + 2 * CONTACT_GAP <= room


def fits(face: Face, size: Sequence[float]) -> bool:
    """Check whether the body on this face fits `size` x, y at some turn, to half a degree."""
    angles = np.linspace(0.0, math.pi, 361)
    directions = np.stack([np.cos(angles), np.sin(angles)])
    widths = np.ptp(face.outline @ directions, axis=0)
    depths = np.ptp(face.outline @ np.stack([-directions[1], directions[0]]), axis=0)
    return bool(((widths <= size[0] + WIDTH_SLACK_M) & (depths <= size[1] + WIDTH_SLACK_M)).any())


def stable_faces(body: Body) -> list[Face]:
    """List the ways in which a body rests and withstands a tilt of STABLE_TILT_RAD, the largest
    facets first.
    """
    return list(_faces(body))


@once_a_shape
def _faces(body: Body) -> tuple[Face, ...]:
    vertices, triangles = body_hull(body)
    centre_of_mass_ = centre_of_mass(body)
    faces: list[Face] = []
    for normal in facet_normals(vertices, triangles):
        rotation = rotation_to_down(normal)
        turned = vertices @ rotation.T
        low = float(turned[:, 2].min())
        touching = turned[turned[:, 2] < low + FACE_HEIGHT_M, :2]
        centre = rotation @ centre_of_mass_

        # Within the base no edge is farther from the centre of mass than the base's box: most
        # facets end here.
        room = float(
            np.minimum(centre[:2] - touching.min(axis=0), touching.max(axis=0) - centre[:2]).min()
        )
        if room < math.tan(STABLE_TILT_RAD) * max(float(centre[2]) - low, 1e-6) - FACE_HEIGHT_M:
            continue

        base = outline(touching)
        if len(base) < 3:
            continue

        angle = tipping_angle(base, centre[:2], float(centre[2]) - low)
        if angle < STABLE_TILT_RAD:
            continue

        extent = float(np.ptp(turned[:, 2]))
        faces.append(
            Face(rotation, -low, extent, outline(turned[:, :2]), base, angle, centre[:2].copy())
        )

    return tuple(faces)


def facets(body: Body, most: int) -> list[Face] | None:
    """List every side of the hull, even unsteady, as a way to rest; None when more than `most`."""
    vertices, triangles = body_hull(body)
    normals = facet_normals(vertices, triangles)
    if len(normals) > most:
        return None
    faces: list[Face] = []
    for normal in normals:
        rotation = rotation_to_down(normal)
        turned = vertices @ rotation.T
        low = float(turned[:, 2].min())
        seen = outline(turned[:, :2])
        faces.append(
            Face(rotation, -low, float(np.ptp(turned[:, 2])), seen, seen, 0.0, seen.mean(axis=0))
        )
    return faces


def curved_faces(body: Body, ways: Sequence[Face]) -> tuple[Face, ...]:
    """List curved sides over which the centre of mass is, apart from each other and from `ways`,
    the lowest first.
    """
    found: list[Face] = []
    for normal in facet_normals(*body_hull(body))[:MOST_CURVED]:
        face = curved_face(body, rotation_to_down(normal))
        if face is not None:
            found.append(face)

    found.sort(key=lambda face: round(face.extent, 3))
    apart: list[Face] = []
    for face in found:
        others = [float(face.rotation[2] @ other.rotation[2]) for other in (*ways, *apart)]
        if max(others, default=-1.0) < math.cos(CURVED_SIDE_ANGLE_RAD):
            apart.append(face)
    return tuple(apart)


def curved_face(body: Body, rotation: Float[Array, "3 3"]) -> Face | None:
    """Return the side that is down under this rotation (3, 3), however curved; None where its
    centre of mass is beside it.
    """
    vertices, _ = body_hull(body)
    turned = vertices @ rotation.T
    matrix = np.eye(4)
    matrix[:3, :3] = rotation
    low, high = bounds(body.parts, Pose.from_matrix(matrix))
    touching = turned[turned[:, 2] < float(turned[:, 2].min()) + CURVED_HEIGHT_M, :2]
    corners = CURVED_MARGIN_M * np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    base = outline((touching[:, None] + corners).reshape(-1, 2))
    centre = rotation @ centre_of_mass(body)
    angle = tipping_angle(base, centre[:2], float(centre[2] - low[2]))
    if angle < 0.0:
        return None
    extent = float(high[2] - low[2])
    return Face(
        rotation, -float(low[2]), extent, outline(turned[:, :2]), base, angle, centre[:2].copy()
    )
