"""Grasps of a body by a parallel gripper: from above, from the sides and slanted; antipodal on any
convex pieces.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body
from tamp.geometric.stability.ray_crossings import ConvexUnion, solid_of
from tamp.geometric.streams.antipodal import GRASP_DEPTHS_M, antipodal_grasps, at_depth, tool_pose
from tamp.geometric.streams.firmness import FAIR_STRAIN, FIRM_STRAIN, strain
from tamp.geometric.streams.grasp_directions import (
    LEVEL_CLOSING,
    MAX_UPWARD_PART,
    closing_axes,
    slanted,
    straight,
)
from tamp.geometric.streams.hand_fit import (
    ROOMY_CLEARANCE_M,
    Closed,
    GraspChecker,
)
from tamp.geometric.streams.narrow_ways import promising
from tamp.geometric.values import Grasp
from tamp.stream import Rejection

if TYPE_CHECKING:
    from jaxtyping import Float

SLANTED_DEPTH_M = 0.012
"""Depth below the top of a slanted hand's tool, metres: deeper, the palm would meet the body."""

HALF_HAND = 0.035
"""Half the hand's thickness and some air, metres: a side grasp keeps this far from what the body
stands on."""

GRASPS_PER_BATCH = 12
"""Random grasps that are drawn together, and given with the least strained first."""

LOOKED_AT = 150
"""Random grasps looked at for those, at most: most may be of no use."""

MAX_FAILED_GRASPS = 4000
"""Random proposals in a row that may fail before the stream ends: the body cannot be grasped, or in
no new way."""


def refuse_none(_: Grasp) -> None:
    """Refuse none."""


def take_any_way(_: Float[Array, "4 4"]) -> bool:
    """Take every way for free."""
    return True


def sample_grasps(
    body: Body,
    robot: Robot,
    rng: np.random.Generator,
    ups: Sequence[Float[Array, " 3"]] = (),
    refused: Callable[[Grasp], Rejection | None] = refuse_none,
    free: Callable[[Float[Array, "4 4"]], bool] = take_any_way,
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
    fit = GraspChecker(body, solid, robot)
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
        return much + FIRM_STRAIN if robot.opening - closed.opening < ROOMY_CLEARANCE_M else much

    waiting: list[tuple[float, Grasp]] = []
    for group in _canonical(body, solid, fit, up, rng):
        for closed in group:
            grasp, much = _grasp(body, closed), strained(closed)
            why = refused(grasp)
            if why is not None:
                yield why
            elif much <= FIRM_STRAIN:
                yield grasp
            else:
                waiting.append((much, grasp))
        waiting.sort(key=_strain)
        while waiting and waiting[0][0] <= FAIR_STRAIN:
            yield waiting.pop(0)[1]

    failures = 0
    proposals = promising(antipodal_grasps(solid, up, fit.widest, rng), free)
    while failures < MAX_FAILED_GRASPS:
        wanted, looked = len(waiting) + GRASPS_PER_BATCH, 0
        while len(waiting) < wanted and failures < MAX_FAILED_GRASPS and looked < LOOKED_AT:
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
            if much <= FIRM_STRAIN:
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
    body: Body, solid: ConvexUnion, fit: GraspChecker, up: Array, rng: np.random.Generator
) -> Iterator[Iterator[Closed]]:
    """List, in groups, the grasps that an engineer would try first."""
    axes = closing_axes(body, solid, up, fit.widest, rng)
    upright = straight(axes, up)
    level = [pair for pair in upright if abs(pair[0] @ up) < LEVEL_CLOSING]
    horizontal = [pair for pair in upright if abs(pair[0] @ up) >= LEVEL_CLOSING]
    sides = [pair for pair in level if abs(pair[1] @ up) < MAX_UPWARD_PART]
    tall = solid.extent(up)[1] - solid.centre @ up > 2 * HALF_HAND
    for directions, high in (
        (level, False),
        (sides if tall else [], True),
        (slanted(axes, up), False),
        (horizontal, False),
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
    solid: ConvexUnion, closing: Array, approach: Array, up: Array, near_top: bool = False
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
    return tool_pose(
        closing,
        approach,
        at_depth(solid, point, approach, max(min(depth, GRASP_DEPTHS_M[1]), GRASP_DEPTHS_M[0])),
    )


def _at_top(solid: ConvexUnion, approach: Array, closing: Array, up: Array) -> Array:
    """Put the tool just below the body's top, over its centre, where a slanted hand has the least
    lever arm.
    """
    point = solid.centre + (solid.extent(up)[1] - SLANTED_DEPTH_M - solid.centre @ up) * up
    return tool_pose(closing, approach, point)
