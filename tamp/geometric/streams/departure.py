"""Collision checks of the retreat with a body in hand: what it touches at first it may leave."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.context import Context
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.values import Grasp

if TYPE_CHECKING:
    from jaxtyping import Float

LOOKS_PER_STEP = 4
"""Looks between two configurations at how a body leaves what it touches."""


def lift_hits(
    context: Context, pose: Pose, grasp: Grasp, lift: Float[Array, "n conf"],
    others: Mapping[str, Pose] | None = None, padding: float = 0.0,
) -> tuple[str, str] | None:  # fmt: skip
    """Return the first pair that collides while a held body is lifted off a pose, as
    `Arrangement.path_hits` says it.

    Args:
        context: The problem's tools.
        pose: T_world_body before.
        grasp: How the hand holds it.
        lift: Configurations (n, 10).
        others: Movable bodies to look at; None for the fixed ones.
        padding: Metres that robot and body keep to the others.
    """
    held, body = context.attachment(grasp), grasp.body
    around = (
        {name: context.scene.bodies[name].pose for name in context.scene.fixed}
        if others is None
        else others
    )

    leaving = {
        name: other
        for name, other in around.items()
        if context.touching.together(body, pose, name, other)
    }

    collisions = context.collisions
    if not leaving:
        among = (
            context.fixed_only(grasp)
            if others is None
            else collisions.arrangement(others, held, fixed=False)
        )
        return among.path_hits(lift, padding=padding)

    staying = (
        {}
        if others is None
        else {name: other for name, other in others.items() if name not in leaving}
    )
    among = collisions.arrangement(staying, held, fixed=others is None, without=leaving)
    hand = collisions.arrangement(leaving, None, opening=grasp.opening, fixed=False)
    hit = among.path_hits(lift, padding=padding) or hand.path_hits(lift, padding=padding)
    if hit is not None:
        return hit

    path = np.concatenate(
        [lift[:1], *(np.linspace(a, b, LOOKS_PER_STEP + 1)[1:] for a, b in pairwise(lift))]
    )
    bodies = [context.kinematics.tool(conf) @ grasp.T_tool_body.matrix for conf in path]
    stays = (name for name in leaving if not context.touching.separates(body, bodies, name))
    return next(((body, name) for name in stays), None)
