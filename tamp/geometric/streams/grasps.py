"""Grasps of a body by a parallel gripper: from above, from the sides and slanted; antipodal on any convex pieces."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from functools import cache

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Sphere
from tamp.geometric.stability.ray_crossings import Solid
from tamp.geometric.streams.firmness import FAIR, FIRM, strain
from tamp.geometric.streams.hand_fit import CONE, ROOMY, Closed, HandFit
from tamp.geometric.values import Grasp
from tamp.stream import Rejection

TIP = 0.009
"""Metres by which the finger tips reach beyond the tool's origin."""

DEPTH = (0.006, 0.030)
"""Least and largest depth of the tool's origin in the body along the approach: finger tips 1.5 to 4 cm deep, metres."""

HALF_HAND = 0.035
"""Half the hand's thickness and some air, metres: a side grasp keeps this far from what the body stands on."""

STEP = math.radians(15)
"""Spacing of approach directions about the closing axis."""

LEVEL = 0.1
"""Approaches whose upward part is larger come from below: of use only after the body was turned over."""

LEVEL_CLOSING = 0.3
"""A closing axis whose upward part is larger brings a finger under the body: of use where that stands on little."""

STEEP = 0.7
"""Random closing axes whose upward part is larger than this"""

UNDER = 0.1
"""are kept with this probability."""

BATCH = 64
"""Surface points drawn at once."""

TOGETHER = 12
"""Random grasps that are drawn together, and given with the least strained first."""

LOOKED_AT = 150
"""Random grasps looked at for those, at most: most may be of no use."""

PATIENCE = 4000
"""Random proposals in a row that may fail before the stream ends: the body cannot be grasped, or in no new way."""


def _welcome(_: Grasp) -> None:
    """Refuses none."""


def sample_grasps(
    body: Body,
    robot: Robot,
    rng: np.random.Generator,
    ups: Sequence[Array] = (),
    refused: Callable[[Grasp], Rejection | None] = _welcome,
) -> Iterator[Grasp | Rejection]:
    """Grasps of a body: first the canonical ones in random order, then random antipodal ones without end.

    Canonical are grasps from above at the middle and from the sides at half height, from the sides near the top, then
    slanted ones, and last those with a finger under the body; above and side are meant with the body as it stands at
    the start. Each was closed exactly: the open hand is free of the body at the grasp and while it draws back, and both
    pads meet the body within the friction cone. Firm ones come as they are found; the fair ones of a group of canonical
    grasps follow that group; those that the body's weight strains more, or that leave the open hand little room, come
    with the first random ones. Of random grasps the strained ones come a few at a time, the least strained first. Ends
    only when nothing (new) is found any more: a body that is too wide everywhere gives none.

    Args:
        body: Its mass, friction and centre of mass weigh the grasps.
        robot: Its hand.
        rng: The order and the random grasps.
        ups: Directions of up in the tool's frame in which it carries, beside that in which it grasps, (3,) each.
        refused: Why a grasp is of no use, whose place another one takes.
    """
    solid = Solid(body)
    fit = HandFit(body, solid, robot)
    up = body.pose.rotation[2]

    def strained(closed: Closed) -> float:
        """How much the grasp is strained; one without room beside the body as much as the limit at least."""
        held = closed.T_body_tool[:3, :3].T @ up
        much = strain(
            body, solid.centre, closed.T_body_tool, closed.opening, closed.patches, robot.force, (held, *ups)
        )  # fmt: skip
        return much + FIRM if robot.opening - closed.opening < ROOMY else much

    waiting: list[tuple[float, Grasp]] = []
    for group in _canonical(body, solid, fit, up, rng):
        for closed in group:
            grasp, much = _grasp(body, closed), strained(closed)
            why = refused(grasp)
            if why is not None:
                yield why
            elif much <= FIRM:
                yield grasp
            else:
                waiting.append((much, grasp))
        waiting.sort(key=_strain)
        while waiting and waiting[0][0] <= FAIR:
            yield waiting.pop(0)[1]
    failures = 0
    proposals = _antipodal(solid, up, fit.widest, rng)
    while failures < PATIENCE:
        wanted, looked = len(waiting) + TOGETHER, 0
        while len(waiting) < wanted and failures < PATIENCE and looked < LOOKED_AT:
            proposal = next(proposals)
            closed = None if proposal is None else fit.close(proposal)
            failures = failures + 1 if closed is None else 0
            if closed is None:
                continue
            looked += 1
            grasp = _grasp(body, closed)
            why = refused(grasp)
            if why is not None:
                yield why
                continue
            much = strained(closed)
            if much <= FIRM:
                yield grasp
                wanted -= 1
            else:
                waiting.append((much, grasp))
        for _, grasp in sorted(waiting, key=_strain):
            yield grasp
        waiting = []


def _strain(weighed: tuple[float, Grasp]) -> float:
    """By which grasps are sorted."""
    return weighed[0]


def _canonical(
    body: Body, solid: Solid, fit: HandFit, up: Array, rng: np.random.Generator
) -> Iterator[Iterator[Closed]]:
    """Those that an engineer would try first, in groups."""
    axes = _closing_axes(body, solid, up, fit.widest, rng)
    straight = _straight(axes, up)
    level = [pair for pair in straight if abs(pair[0] @ up) < LEVEL_CLOSING]
    rest = [pair for pair in straight if abs(pair[0] @ up) >= LEVEL_CLOSING]
    sides = [pair for pair in level if abs(pair[1] @ up) < LEVEL]
    tall = solid.extent(up)[1] - solid.centre @ up > 2 * HALF_HAND
    for directions, high in (
        (level, False),
        (sides if tall else [], True),
        (_slanted(axes, up), False),
        (rest, False),
    ):
        order = [directions[index] for index in rng.permutation(len(directions))]
        tools = (_at_middle(solid, closing, approach, up, high) for closing, approach in order)
        yield (closed for closed in map(fit.close, tools) if closed is not None)


def _grasp(body: Body, closed: Closed) -> Grasp:
    return Grasp(body.name, Pose.from_matrix(closed.T_body_tool).inverse(), float(closed.opening))


def _straight(axes: list[Array], up: Array) -> list[tuple[Array, Array]]:
    """Closing and approach directions from above and from the sides."""
    return [
        (axis, a) for axis in axes for a in _approaches(axis, up, math.pi / 2) if a @ up < LEVEL
    ]


def _slanted(axes: list[Array], up: Array) -> list[tuple[Array, Array]]:
    """Closing and approach directions 30, 45 and 60 degrees from straight down."""
    level = [axis for axis in axes if abs(axis @ up) < LEVEL_CLOSING]
    return [
        (axis, a) for axis in level for a in _approaches(axis, up, STEP) if -0.9 < a @ up < -0.4
    ]


def _closing_axes(
    body: Body, solid: Solid, up: Array, widest: float, rng: np.random.Generator
) -> list[Array]:
    """Directions (3,) in which the fingers may close, each with both signs.

    A box's edges; for other bodies the horizontal directions in which they are narrowest, and some all around.
    """
    shape, R = body.parts[0].shape, body.parts[0].pose.rotation
    if len(body.parts) == 1 and isinstance(shape, Box):
        axes = [R[:, i] for i in range(3) if shape.size[i] <= widest]
    else:
        around = R[:, 2] if isinstance(shape, Cylinder) else up
        level = np.cross(around, up)
        first = (
            level / np.linalg.norm(level) if np.linalg.norm(level) > 0.1 else _perpendicular(around)
        )
        second = np.cross(around, first)

        def ring(angles: Array) -> list[Array]:
            return [math.cos(a) * first + math.sin(a) * second for a in angles]

        axes = [around, first, second]
        if abs(around @ up) > 0.9:
            axes += ring(rng.uniform(0.0, math.pi) + np.arange(4) * math.pi / 4)
        if not isinstance(shape, Cylinder | Sphere):
            fine = ring(np.arange(180) * math.pi / 180)
            widths = np.diff([solid.extent(axis) for axis in fine], axis=1).ravel()
            axes += [
                fine[i] for i in range(180) if widths[i] < min(widths[i - 1], widths[(i + 1) % 180])
            ]
    return [sign * axis for axis in axes for sign in (1.0, -1.0)]


def _approaches(closing: Array, up: Array, step: float) -> list[Array]:
    """Unit vectors (3,) perpendicular to the closing axis, `step` radians apart, the first as much down as possible."""
    first, second = _across(closing, up)
    return [math.cos(a) * first + math.sin(a) * second for a in _angles(step)]


def _across(closing: Array, up: Array) -> tuple[Array, Array]:
    """Two unit vectors (3,) that are perpendicular to the closing axis and each other; the first looks down."""
    down = -up + (up @ closing) * closing
    length = math.sqrt(down @ down)
    first = down / length if length > 0.1 else _perpendicular(closing)
    return first, _cross(closing, first)


@cache
def _angles(step: float) -> Array:
    return np.arange(0.0, 2 * math.pi - 1e-9, step)


def _at_middle(
    solid: Solid, closing: Array, approach: Array, up: Array, near_top: bool = False
) -> Array:
    """The tool at the body's centre line, no deeper than its centre; a side grasp leaves room above the support.

    Or, from the side, near the top of a tall body: what hides its middle, such as a box that it stands in, does not
    hinder there.
    """
    point = solid.centre.copy()
    low, high = solid.extent(up)
    sideways = 1.0 - abs(approach @ up)
    if abs(closing @ up) < 0.5:
        wanted = (
            high - HALF_HAND / 2 if near_top else max(float(point @ up), low + HALF_HAND * sideways)
        )
        point += (min(wanted, high - 0.01) - point @ up) * up * sideways
    depth = float(point @ approach) - solid.extent(approach)[0]
    return _tool(
        closing, approach, _deep(solid, point, approach, max(min(depth, DEPTH[1]), DEPTH[0]))
    )


def _deep(solid: Solid, point: Array, approach: Array, depth: float) -> Array:
    """The point moved along the approach to `depth` under the body's surface there; tips stay inside a thin body."""
    low, high = solid.extent(approach)
    surface = solid.solid_at(point, approach)
    start = point @ approach + surface.start if surface is not None else low
    thickness = (point @ approach + surface.end if surface is not None else high) - start
    return point + (start + min(depth, thickness - TIP - 0.003) - point @ approach) * approach


def _antipodal(
    solid: Solid, up: Array, widest: float, rng: np.random.Generator
) -> Iterator[Array | None]:
    """Random tool poses whose closing line meets the surface squarely on both sides; None for a draw without."""
    while True:
        points, normals = solid.surface_points(rng, BATCH)
        tilts = rng.normal(0.0, math.radians(4), (BATCH, 3))
        closings = tilts - (np.einsum("ij,ij->i", tilts, normals) + 1.0)[:, None] * normals
        closings /= np.linalg.norm(closings, axis=1, keepdims=True)
        _, ends, _, planes = solid.crossings(points, closings)
        square = np.einsum("ipj,ij->ip", solid.normals(planes), closings) >= math.cos(CONE)
        narrow = np.any((ends > 0.002) & (ends <= widest) & square, axis=1)
        narrow &= (np.abs(closings @ up) < STEEP) | (rng.random(BATCH) < UNDER)
        # Far from under or over the centre of mass the body would turn in the hand.
        aside = solid.centre - points
        for along in (closings, np.broadcast_to(up, closings.shape)):
            aside = aside - np.einsum("ij,ij->i", aside, along)[:, None] * along
        near = rng.random(BATCH) < np.exp(-np.sum(aside**2, axis=1) / 0.03**2) + 0.1
        yield from (
            _around(solid, points[i], closings[i], up, widest, rng)
            if narrow[i] and near[i]
            else None
            for i in range(BATCH)
        )


def _around(
    solid: Solid, point: Array, closing: Array, up: Array, widest: float, rng: np.random.Generator
) -> Array | None:
    """A tool pose with a random approach about the line through a surface point."""
    width = solid.solid_at(point, closing)
    if width is None or width.start < -0.002 or width.end > widest:
        return None
    if -(width.start_normal @ closing) < math.cos(CONE) or width.end_normal @ closing < math.cos(
        CONE
    ):
        return None
    angle = _angles(STEP)[rng.integers(len(_angles(STEP)))]
    first, second = _across(closing, up)
    approach = math.cos(angle) * first + math.sin(angle) * second
    if approach @ up > LEVEL and rng.random() > 0.15:
        return None
    middle = point + closing * (width.start + width.end) / 2
    return _tool(closing, approach, _deep(solid, middle, approach, rng.uniform(*DEPTH)))


def _tool(closing: Array, approach: Array, origin: Array) -> Array:
    """T_body_tool (4, 4): y along the closing axis, z along the approach."""
    T = np.eye(4)
    T[:3, 0], T[:3, 1], T[:3, 2], T[:3, 3] = _cross(closing, approach), closing, approach, origin
    return T


def _perpendicular(axis: Array) -> Array:
    other = np.cross(np.eye(3)[int(np.argmin(np.abs(axis)))], axis)
    return other / np.linalg.norm(other)


def _cross(first: Array, second: Array) -> Array:
    """`np.cross` of two vectors (3,), in a tenth of the time."""
    (a, b, c), (x, y, z) = first.tolist(), second.tolist()
    return np.array([b * z - c * y, c * x - a * z, a * y - b * x])
