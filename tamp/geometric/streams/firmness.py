"""The firmness of a grasp: the body's weight and its lever arm against the friction and the force
of two pads.

After Coulomb's law on a patch under even pressure, as in Howe and Cutkosky, "Practical force-motion
models for sliding manipulation" (IJRR 1996): the pads resist a force along them, a turn about the
closing axis by friction on the patch, and turns about the other two by moving the pressure to an
edge of the patch and by friction forces that oppose.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Body

if TYPE_CHECKING:
    from jaxtyping import Float

GRAVITY_M_S2 = 9.81
"""Metres per second squared."""

SHAKE_SHARE = 0.3
"""Accelerations of the hand while it carries, in any direction, as a share of gravity."""

FIRM_STRAIN = 0.5
"""The strain up to which a grasp is taken for firm; at 1 the body is about to slip or turn in the
hand."""

FAIR_STRAIN = 0.75
"""The strain up to which a grasp at the body's middle is not put off for random ones, of which few
are firmer."""

SHAKE_DIRECTIONS = np.concatenate([np.eye(3), -np.eye(3)])
"""Directions (6, 3) in which the hand may accelerate."""

PAD_FRICTION = 1.0
"""Coulomb's coefficient of the pads, by which a body's own is multiplied."""

PATCH_MARGIN_M = 0.002
"""Half the distance of the points at which a patch is felt: it reaches so much farther, metres."""


def strain(
    body: Body,
    centre: Float[Array, " 3"],
    T_body_tool: Float[Array, "4 4"],
    width: float,
    patches: Sequence[Float[Array, "_ 3"]],
    force: float,
    ups: Sequence[Float[Array, " 3"]],
) -> float:
    """Compute the share that a body's weight uses up of what two pads can hold; without a unit, at
    1 it slips.

    Args:
        body: Its mass and friction are asked for.
        centre: Its centre of mass in its own frame, shape (3,), metres.
        T_body_tool: The grasp, shape (4, 4).
        width: Of the body between the pads, metres.
        patches: Where each pad touches, points (k, 3) in the tool's frame, metres.
        force: With which each pad presses, newtons.
        ups: The directions of up that the tool sees while it holds the body, (3,) each, in the
            tool's frame.
    """
    lever = T_body_tool[:3, :3].T @ (centre - T_body_tool[:3, 3])
    weight = body.mass * GRAVITY_M_S2
    grip = PAD_FRICTION * body.friction * force
    spread = [patch[:, [0, 2]] - patch[:, [0, 2]].mean(axis=0) for patch in patches]
    about_closing = sum(
        grip * (PATCH_MARGIN_M / 2 + float(np.linalg.norm(one, axis=1).mean())) for one in spread
    )
    reach = (
        np.min([np.ptp(patch[:, [0, 2]], axis=0) for patch in patches], axis=0) / 2 + PATCH_MARGIN_M
    )
    holds = np.array(
        [2 * force * reach[1] + grip * width, about_closing, 2 * force * reach[0] + grip * width]
    )
    shaken = np.concatenate([up + SHAKE_SHARE * SHAKE_DIRECTIONS for up in ups])
    turns = np.cross(lever, weight * shaken) / holds
    slip = (1.0 + SHAKE_SHARE) * weight / (2 * grip)
    return float(np.hypot(np.linalg.norm(turns, axis=1).max(), slip))
