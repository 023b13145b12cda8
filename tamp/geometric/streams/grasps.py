"""Grasps of a body by a parallel gripper: from above, from the sides and slanted; antipodal on any
convex pieces.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body
from tamp.geometric.stability.ray_crossings import Solid, solid_of
from tamp.geometric.streams.firmness import FAIR, FIRM, strain
from tamp.geometric.streams.grasp_directions import (
    LEVEL,
    LEVEL_CLOSING,
    STEP,
    across,
    angles,
    closing_axes,
    cross,
    slanted,
    straight,
)
from tamp.geometric.streams.hand_fit import CONE, ROOMY, Closed, HandFit
from tamp.geometric.streams.narrow_ways import promising
from tamp.geometric.values import Grasp
from tamp.stream import Rejection

if TYPE_CHECKING:
    from jaxtyping import Float

TIP = 0.009
"""Metres by which the finger tips reach beyond the tool's origin."""

DEPTH = (0.006, 0.030)
"""Least and largest depth of the tool's origin in the body along the approach: finger tips 1.5 to 4
cm deep, metres."""

SHALLOW = 0.012
"""Depth below the top of a slanted hand's tool, metres: deeper, the palm would meet the body."""

HALF_HAND = 0.035
"""Half the hand's thickness and some air, metres: a side grasp keeps this far from what the body
stands on."""

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
"""Random proposals in a row that may fail before the stream ends: the body cannot be grasped, or in
no new way."""


def _welcome(_: Grasp) -> None:
    """Refuse none."""


def _anywhere(_: Array) -> bool:
    """Take every way for free."""
    return True


def sample_grasps(
    body: Body,
    robot: Robot,
    rng: np.random.Generator,
    ups: Sequence[Float[Array, " 3"]] = (),
    refused: Callable[[Grasp], Rejection | None] = _welcome,
    free: Callable[[Float[Array, "4 4"]], bool] = _anywhere,
) -> Iterator[Grasp | Rejection]:
    """Yield grasps of a body: first the canonical ones in random order, then random antipodal ones
    without end.

    Canonical are grasps from above at the middle and from the sides at half height, from the sides
    near the top, then slanted ones, those with a finger under the body, and last slanted ones near
    the top of a tall body; above and side are meant with the body as it stands at the start. Each
    was closed exactly: the open hand is free of the body at the grasp and while it draws back, and
    both pads meet the body within the friction cone. Firm ones come as they are found; the fair
    ones of a group of canonical grasps follow that group; those that the body's weight strains
    more, or that leave the open hand little room, come with the first random ones. Of random
    grasps the strained ones come a few at a time, the least strained first. Ends only when nothing
    (new) is found any more: a body that is too wide everywhere gives none.

    Args:
        body: Its mass, friction and centre of mass weigh the grasps.
        robot: Its hand.
        rng: The order and the random grasps.
        ups: Directions of up in the tool's frame in which it carries, beside that in which it
            grasps, (3,) each.
        refused: Why a grasp is of no use, whose place another one takes.
        free: Whether the open hand's way to T_body_tool is free where the body stands at the start;
            in a narrow place most random grasps are such.
    """
    solid = solid_of(body)
    fit = HandFit(body, solid, robot)
    up = body.pose.rotation[2]

    def strained(closed: Closed) -> float:
        """Compute how much the grasp is strained; one without room beside the body as much as the
        limit at least.
        """
        held = closed.T_body_tool[:3, :3].T @ up
        much = strain(
            body, solid.centre, closed.T_body_tool, closed.opening, closed.patches, robot.force,
            (held, *ups),
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
    proposals = promising(_antipodal(solid, up, fit.widest, rng), free)
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
    """Return the strain, by which grasps are sorted."""
    return weighed[0]


def _canonical(
    body: Body, solid: Solid, fit: HandFit, up: Array, rng: np.random.Generator
) -> Iterator[Iterator[Closed]]:
    """List, in groups, the grasps that an engineer would try first."""
    axes = closing_axes(body, solid, up, fit.widest, rng)
    upright = straight(axes, up)
    level = [pair for pair in upright if abs(pair[0] @ up) < LEVEL_CLOSING]
    rest = [pair for pair in upright if abs(pair[0] @ up) >= LEVEL_CLOSING]
    sides = [pair for pair in level if abs(pair[1] @ up) < LEVEL]
    tall = solid.extent(up)[1] - solid.centre @ up > 2 * HALF_HAND
    for directions, high in (
        (level, False),
        (sides if tall else [], True),
        (slanted(axes, up), False),
        (rest, False),
    ):
        order = [directions[index] for index in rng.permutation(len(directions))]
        tools = (_at_middle(solid, closing, approach, up, high) for closing, approach in order)
        yield (closed for closed in map(fit.close, tools) if closed is not None)

    if tall:  # a slanted line through the middle of a tall body meets it far to the side
        above = sorted(slanted(axes, up), key=lambda pair: float(pair[1] @ up))
        tools = (_at_top(solid, approach, closing, up) for closing, approach in above)
        yield (closed for closed in map(fit.close, tools) if closed is not None)


def _grasp(body: Body, closed: Closed) -> Grasp:
    return Grasp(body.name, Pose.from_matrix(closed.T_body_tool).inverse(), float(closed.opening))


def _at_middle(
    solid: Solid, closing: Array, approach: Array, up: Array, near_top: bool = False
) -> Array:
    """Put the tool at the body's centre line, no deeper than its centre; a side grasp leaves room
    above the support.

    Or, from the side, near the top of a tall body: what hides its middle, such as a box that it
    stands in, does not hinder there.
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


def _at_top(solid: Solid, approach: Array, closing: Array, up: Array) -> Array:
    """Put the tool just below the body's top, over its centre, where a slanted hand has the least
    lever arm.
    """
    point = solid.centre + (solid.extent(up)[1] - SHALLOW - solid.centre @ up) * up
    return _tool(closing, approach, point)


def _deep(solid: Solid, point: Array, approach: Array, depth: float) -> Array:
    """Move the point to `depth` in the body along the approach; tips stay in a thin one."""
    low, high = solid.extent(approach)
    surface = solid.solid_at(point, approach)
    start = point @ approach + surface.start if surface is not None else low
    thickness = (point @ approach + surface.end if surface is not None else high) - start
    return point + (start + min(depth, thickness - TIP - 0.003) - point @ approach) * approach


def _antipodal(
    solid: Solid, up: Array, widest: float, rng: np.random.Generator
) -> Iterator[Array | None]:
    """Draw tool poses whose closing line meets the surface squarely on both sides; None for a draw
    without.
    """
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
    """Draw a tool pose with a random approach about the line through a surface point."""
    width = solid.solid_at(point, closing)
    if width is None or width.start < -0.002 or width.end > widest:
        return None
    if -(width.start_normal @ closing) < math.cos(CONE) or width.end_normal @ closing < math.cos(
        CONE
    ):
        return None
    angle = angles(STEP)[rng.integers(len(angles(STEP)))]
    first, second = across(closing, up)
    approach = math.cos(angle) * first + math.sin(angle) * second
    if approach @ up > LEVEL and rng.random() > 0.15:
        return None
    middle = point + closing * (width.start + width.end) / 2
    return _tool(closing, approach, _deep(solid, middle, approach, rng.uniform(*DEPTH)))


def _tool(closing: Array, approach: Array, origin: Array) -> Array:
    """Build T_body_tool (4, 4): y along the closing axis, z along the approach."""
    T = np.eye(4)
    T[:3, 0], T[:3, 1], T[:3, 2], T[:3, 3] = cross(closing, approach), closing, approach, origin
    return T
