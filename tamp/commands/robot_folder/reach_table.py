"""The table from where the arm reaches what: forward kinematics of many random configurations."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
from scipy.ndimage import minimum_filter

from tamp.geometric.robot.chain import Chain
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array

HEIGHT_STEP, DISTANCE_STEP = 0.07, 0.05
"""Of the table's cells, metres,"""

HEADINGS = 24
"""and in how many a turn is divided."""

SAMPLES = 3_000_000
"""Configurations that fill the table."""

CHUNK = 100_000

FRONT = np.radians(50)
"""Bearings of the tool, as seen from the foot, that are counted where the first joint does not turn
about the vertical: the base mostly faces its work."""

SPARE = 0.05
"""Share of a joint's range at both ends that comfortable configurations leave."""

RESOLVED = 3
"""Samples of a cell below which it does not count: it is at the edge of reach."""


def table(robot: Robot, told: Callable[[float], None]) -> dict[str, Array]:
    """Compute the arrays that `Reachability` reads."""
    chain = Chain.of(robot)
    ups = directions()
    rotations = np.array([rotation_with_up(up) for up in ups])
    foot = np.array(robot.T_base_arm.position)
    length = _length(chain)
    heights = np.arange(0.0, max(1.0, min(2.5, foot[2] + length + 0.3)), HEIGHT_STEP)
    distances = np.arange(0.075, max(0.6, length), DISTANCE_STEP)
    counts = np.zeros((len(heights), len(ups), len(distances), HEADINGS), dtype=np.int64)
    upright = abs(chain.origins[0, 2, 2]) > 0.999 and not chain.slides[0]
    rng = np.random.default_rng(0)

    margin = SPARE * (chain.upper - chain.lower)
    for begun in range(0, SAMPLES, CHUNK):
        q = rng.uniform(chain.lower + margin, chain.upper - margin, (CHUNK, len(margin)))
        R, p = tools(chain, q)
        level = np.round((p[:, 2] - heights[0]) / HEIGHT_STEP).astype(int)
        x, y = p[:, 0] - foot[0], p[:, 1] - foot[1]
        row = np.round((np.hypot(x, y) - distances[0]) / DISTANCE_STEP).astype(int)
        towards = np.arctan2(y, x)
        kept = (level >= 0) & (level < len(heights)) & (row >= 0) & (row < len(distances))
        if not upright:
            kept &= np.abs(towards) < FRONT
        R, level, row, towards = R[kept], level[kept], row[kept], towards[kept]

        direction = (R[:, 2] @ ups.T).argmax(axis=1)
        turn = R @ rotations[direction].transpose(0, 2, 1)
        yaw = np.arctan2(turn[:, 1, 0] - turn[:, 0, 1], turn[:, 0, 0] + turn[:, 1, 1])
        column = np.round((yaw - towards) / (2 * np.pi / HEADINGS)).astype(int) % HEADINGS
        np.add.at(counts, (level, direction, row, column), 1)
        told(begun / SAMPLES)

    counts = np.where(counts >= RESOLVED, counts, 0)
    eroded = minimum_filter(counts, size=(1, 1, 3, 1), mode="nearest")
    # an arm that reaches few poses keeps them all
    counts = eroded if (eroded > 0).sum() > 0.2 * (counts > 0).sum() else counts
    return {
        "heights": heights,
        "directions": ups,
        "rotations": rotations,
        "distances": distances,
        "counts": np.minimum(counts, 255).astype(np.uint8),
    }


def tools(chain: Chain, q: Array) -> tuple[Array, Array]:
    """Compute rotations (k, 3, 3) and positions (k, 3) of the tool in the base's frame at joint
    positions (k, n), by forward kinematics.
    """
    R, p = np.tile(np.eye(3), (len(q), 1, 1)), np.zeros((len(q), 3))
    for index in range(q.shape[1]):
        p = p + R @ chain.origins[index, :3, 3]
        R = R @ chain.origins[index, :3, :3]
        if chain.slides[index]:
            p = p + R[:, :, 2] * q[:, index, None]
            continue
        cos, sin = np.cos(q[:, index, None]), np.sin(q[:, index, None])
        R = np.stack(
            [R[:, :, 0] * cos + R[:, :, 1] * sin, R[:, :, 1] * cos - R[:, :, 0] * sin, R[:, :, 2]],
            axis=2,
        )
    return R @ chain.T_flange_tool[:3, :3], p + R @ chain.T_flange_tool[:3, 3]


def directions(frequency: int = 4) -> Array:
    """Return unit vectors (n, 3): the points of an octahedron's faces divided `frequency` times;
    the axes are among them.
    """
    grid = itertools.product(range(-frequency, frequency + 1), repeat=3)
    points = np.array([p for p in grid if sum(map(abs, p)) == frequency], dtype=float)
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def rotation_with_up(up: Array) -> Array:
    """Return some tool orientation (3, 3) that sees the world's z as `up`: its last row."""
    helper = np.eye(3)[np.argmin(np.abs(up))]
    x = np.cross(helper, up)
    x /= np.linalg.norm(x)
    return np.array([x, np.cross(up, x), up])


def _length(chain: Chain) -> float:
    """Bound the tool's distance from the foot, metres."""
    pieces = [*chain.origins[1:, :3, 3], chain.T_flange_tool[:3, 3]]
    slides = np.abs(np.stack([chain.lower, chain.upper])).max(axis=0) @ chain.slides
    return float(sum(np.linalg.norm(piece) for piece in pieces) + slides)
