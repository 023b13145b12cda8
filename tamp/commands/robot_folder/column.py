"""The column on which a short arm stands on the base that drives it to tables."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tamp.commands.robot_folder.convex import hull_of
from tamp.commands.robot_folder.reach_table import tools
from tamp.geometric.robot.chain import Chain
from tamp.geometric.robot.robot import Link, Robot
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Box, Part

ON_TABLES = (0.75, 0.95)
"""Metres: where the hand is that grasps from above what stands on a table."""

DOWN = -0.9
"""The upward part of the tool's direction up to which it points down."""

FRONT = 0.05
"""Metres in front of the base where a hand reaches a table that the base stands at."""

ENOUGH = 0.3
"""Share of the best height's chances that makes a lower one good enough."""

HEIGHT_STEP_M, HIGHEST = 0.05, 1.0
"""Metres: between heights that are tried, and the highest."""

SAMPLES = 200_000

THICK = 0.1
"""Edge length of the column, metres."""


def on_column(robot: Robot) -> Robot:
    """Raise an arm that from a driving base's top hardly grasps from above on tables, on a column
    that is a part of its foot; another one stays where it is.
    """
    heights = _hands(robot)
    raised = np.arange(0.0, HIGHEST - robot.T_base_arm.position[2], HEIGHT_STEP_M)
    chances = np.array(
        [((heights + up > ON_TABLES[0]) & (heights + up < ON_TABLES[1])).sum() for up in raised]
    )
    if not len(raised) or chances.max() == 0 or chances[0] >= ENOUGH * chances.max():
        return robot
    up = float(raised[int(np.argmax(chances >= ENOUGH * chances.max()))])

    x, y, z = robot.T_base_arm.position
    box = robot.link(robot.base).parts[0]
    low = box.pose.position[2] + box.shape.size[2] / 2 if isinstance(box.shape, Box) else z
    corners = np.array(
        [[a, b, c] for a in (-1, 1) for b in (-1, 1) for c in (low, z + up)], dtype=float
    ) * np.array([THICK / 2, THICK / 2, 1.0]) + np.array([x, y, 0.0])
    moved = Pose((x, y, z + up), robot.T_base_arm.quaternion)
    column = Part(hull_of(moved.inverse().apply(corners), robot.foot))
    links = tuple(
        Link(link.name, (*link.parts, column)) if link.name == robot.foot else link
        for link in robot.links
    )
    return replace(robot, T_base_arm=moved, links=links)


def _hands(robot: Robot) -> Array:
    """Return heights of random hands that point down in front of the base, metres."""
    chain = Chain.of(robot)
    rng = np.random.default_rng(0)
    q = rng.uniform(chain.lower, chain.upper, (SAMPLES, len(chain.lower)))
    R, p = tools(chain, q)
    box = robot.link(robot.base).parts[0]
    front = box.pose.position[0] + (box.shape.size[0] / 2 if isinstance(box.shape, Box) else 0.0)
    return p[(R[:, 2, 2] < DOWN) & (p[:, 0] > front + FRONT), 2]
