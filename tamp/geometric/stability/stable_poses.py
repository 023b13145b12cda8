"""Stable poses: which ways up a body can rest, and what certifies that it rests somewhere."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import CONTACT_GAP, Body, Cavity, Sphere, Surface
from tamp.geometric.stability.facets import facet_normals, rotation_to_down, tipping_angle
from tamp.geometric.stability.hulls import body_hull, centre_of_mass, outline
from tamp.stream import Rejection, RejectionKind

SNAP_HEIGHT = 0.03
"""A proposal whose lowest point is this near to the surface is put onto it (the paper's tolerance
for `on`), metres."""

SNAP_TILT = math.radians(15.0)
"""A proposal tilted less than this from a stable face, or than the face withstands, is laid onto
that face."""

FLAT = 0.0005
"""Vertices within this height of the lowest one belong to the face that is down, metres."""

SLACK = 0.002
"""What half a degree can change of a body's width, metres."""

STABLE = math.radians(8.0)
"""A face is stable when the body must be tilted at least this much before it tips over the face's
edge."""


ROUND = 0.0015
"""Points this little above the lowest one count as touching where a body lies on a curved side,
metres."""

LEAN = 0.002
"""By so much a curved side carries beyond its lowest points: meshes have few of them, metres."""

BALANCE = 0.015
"""How far inside the supported part of an overhanging base the centre of mass must lie, metres."""


@lru_cache(maxsize=512)
def resting_of(body: Body) -> Resting:
    """Return the ways in which a body can rest, worked out once for each body."""
    return Resting(body)


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


class Resting:
    """The stable faces of one body, the one it rests on at the start first.

    The centre of mass is that of the convex hull of all parts, which is exact for one convex part.
    """

    def __init__(self, body: Body) -> None:
        self.body = body

    @cached_property
    def faces(self) -> tuple[Face, ...]:
        """Return all ways to rest that withstand a tilt of STABLE: the present one, then the
        steadiest.
        """
        down = -self.body.pose.rotation[2]
        faces = stable_faces(self.body)
        faces.sort(
            key=lambda face: (
                -round(float(-face.rotation[2] @ down) > math.cos(SNAP_TILT)),
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
        if any(float(-face.rotation[2] @ down) > math.cos(SNAP_TILT) for face in self.faces):
            return None
        return curved_face(self.body)

    @property
    def ways(self) -> tuple[Face, ...]:
        """Return the stable faces, and the curved side that it lies on."""
        return self.faces if self.lying is None else (*self.faces, self.lying)

    def nearest(self, rotation: Array) -> Face | None:
        """Return the stable face onto which the body, let go under this rotation, tips back; None
        when it may tip over.
        """
        down = -rotation[2]
        best = max(self.ways, key=lambda face: float(-face.rotation[2] @ down), default=None)
        if best is None or float(-best.rotation[2] @ down) < math.cos(max(SNAP_TILT, best.angle)):
            return None
        return best


def rest(
    resting: Resting, proposal: Pose, region: Surface | Cavity, T_world_region: Pose
) -> Pose | Rejection:
    """Put a proposed pose to rest in a region, or say why it cannot.

    The result touches the region (up to CONTACT_GAP) with a stable face whose support lies inside
    the region.
    """
    face = resting.nearest(proposal.rotation)
    if face is None:
        return Rejection("stands on no stable face", kind=RejectionKind.UNSTABLE)
    T_region_body = T_world_region.inverse() @ proposal
    room = region.clearance if isinstance(region, Surface) else region.size[2]
    if face.extent + 2 * CONTACT_GAP > room:
        what = f"too tall ({face.extent:.2f} m, room for {room:.2f} m)"
        return Rejection(what, kind=RejectionKind.TOO_LARGE)
    bottom = T_region_body.position[2] - face.height
    if abs(bottom) > SNAP_HEIGHT:
        return Rejection("too high" if bottom > 0 else "too low", kind=RejectionKind.UNSTABLE)
    yaw = _yaw_between(face.rotation, T_region_body.rotation)
    return settle(
        face, yaw, T_region_body.position[0], T_region_body.position[1], region, T_world_region
    )


def settle(
    face: Face, yaw: float, x: float, y: float, region: Surface | Cavity, T_world_region: Pose
) -> Pose | Rejection:
    """Return the pose on `face`, turned by `yaw`, the body's frame above (x, y) of the region;
    rejected when it overhangs.
    """
    c, s = math.cos(yaw), math.sin(yaw)
    turn = np.array([[c, -s], [s, c]])
    half = np.array(region.size[:2]) / 2
    outline = face.outline @ turn.T + (x, y)
    if isinstance(region, Cavity):
        if (np.abs(outline) > half).any():
            return Rejection("protrudes", kind=RejectionKind.TOO_LARGE)
    else:
        base = face.base @ turn.T + (x, y)
        centre = turn @ face.centre + (x, y)
        if (np.abs(base) > half).any() and not _balanced(base, centre, half):
            return Rejection("overhangs", kind=RejectionKind.UNSTABLE)
    return T_world_region @ resting_pose(face, yaw, x, y)


def resting_pose(face: Face, yaw: float, x: float, y: float) -> Pose:
    """Compute the body's pose in the region's frame, on `face`, turned by `yaw` radians, its frame
    above (x, y) metres.
    """
    c, s = math.cos(yaw), math.sin(yaw)
    matrix = np.eye(4)
    matrix[:3, :3] = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ face.rotation
    matrix[:3, 3] = (x, y, face.height + CONTACT_GAP)
    return Pose.from_matrix(matrix)


def fits(face: Face, size: Sequence[float]) -> bool:
    """Check whether the body on this face fits `size` x, y at some turn, to half a degree."""
    angles = np.linspace(0.0, math.pi, 361)
    directions = np.stack([np.cos(angles), np.sin(angles)])
    widths = np.ptp(face.outline @ directions, axis=0)
    depths = np.ptp(face.outline @ np.stack([-directions[1], directions[0]]), axis=0)
    return bool(((widths <= size[0] + SLACK) & (depths <= size[1] + SLACK)).any())


def _balanced(base: Array, centre: Array, half: Array) -> bool:
    """Check whether the centre of mass lies well inside both the base and the surface."""
    if (np.abs(centre) > half - BALANCE).any():
        return False
    edges = np.roll(base, -1, axis=0) - base
    lengths = np.linalg.norm(edges, axis=1)
    offsets = centre - base
    distances = (edges[:, 0] * offsets[:, 1] - edges[:, 1] * offsets[:, 0]) / np.maximum(
        lengths, 1e-12
    )
    return bool((distances > BALANCE).all())


def _yaw_between(reference: Array, rotation: Array) -> float:
    """Compute the turn about z that brings `reference` nearest to `rotation`."""
    relative = rotation @ reference.T
    return math.atan2(relative[1, 0] - relative[0, 1], relative[0, 0] + relative[1, 1])


def stable_faces(body: Body) -> list[Face]:
    """List the ways in which a body rests and withstands a tilt of STABLE, largest facets first."""
    vertices, triangles = body_hull(body)
    centre_of_mass_ = centre_of_mass(body)
    faces: list[Face] = []
    for normal in facet_normals(vertices, triangles):
        rotation = rotation_to_down(normal)
        turned = vertices @ rotation.T
        low = float(turned[:, 2].min())
        touching = turned[turned[:, 2] < low + FLAT, :2]
        centre = rotation @ centre_of_mass_

        # Within the base no edge is farther from the centre of mass than the base's box: most
        # facets end here.
        room = float(
            np.minimum(centre[:2] - touching.min(axis=0), touching.max(axis=0) - centre[:2]).min()
        )
        if room < math.tan(STABLE) * max(float(centre[2]) - low, 1e-6) - FLAT:
            continue

        base = outline(touching)
        if len(base) < 3:
            continue

        angle = tipping_angle(base, centre[:2], float(centre[2]) - low)
        if angle < STABLE:
            continue

        extent = float(np.ptp(turned[:, 2]))
        faces.append(
            Face(rotation, -low, extent, outline(turned[:, :2]), base, angle, centre[:2].copy())
        )

    return faces


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


def curved_face(body: Body) -> Face | None:
    """Return the side that is down in the body's pose, however curved; None where its centre of
    mass is beside it.
    """
    rotation = body.pose.rotation
    vertices, _ = body_hull(body)
    turned = vertices @ rotation.T
    low, high = bounds(body.parts, Pose((0.0, 0.0, 0.0), body.pose.quaternion))
    touching = turned[turned[:, 2] < float(turned[:, 2].min()) + ROUND, :2]
    corners = LEAN * np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    base = outline((touching[:, None] + corners).reshape(-1, 2))
    centre = rotation @ centre_of_mass(body)
    angle = tipping_angle(base, centre[:2], float(centre[2] - low[2]))
    if angle < 0.0:
        return None
    extent = float(high[2] - low[2])
    return Face(
        rotation, -float(low[2]), extent, outline(turned[:, :2]), base, angle, centre[:2].copy()
    )
