"""Cover the robot's links by spheres; writes tamp/geometric/robot/assets/<robot>_spheres.npz. Seconds a link.

    python -m benchmarks.build_robot_spheres

Greedy set cover: candidates are grid points c inside the link with radius depth(c) + slack, so that each sphere stands
out by at most `slack`; the next one is the one that covers most of the surface samples left. The smallest slack for
which LEAVES spheres suffice is taken. The spheres are then grown until they provably cover everything: every point of a
link is within PITCH * sqrt(3) / 2 of a node of the cubic grid of that pitch, so that it suffices that the spheres, made
smaller by that length, cover all nodes within it of the link.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
from scipy.spatial import ConvexHull

from tamp.geometric.robot.robot import ROBOTS
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Hull

LEAVES = 20
PITCH = 0.003
"""Of the grid that proves the cover, metres."""


def planes(vertices: Array) -> tuple[Array, Array]:
    """Unit outward normals (f, 3) and offsets (f,): the hull is {x : normals @ x <= offsets}."""
    equations = np.unique(ConvexHull(vertices).equations.round(9), axis=0)
    return equations[:, :3], -equations[:, 3]


def grid(vertices: Array, pitch: float, margin: float) -> Array:
    """Nodes of the cubic grid in the box around the vertices, grown by `margin`. Shape (n, 3)."""
    low, high = vertices.min(axis=0) - margin, vertices.max(axis=0) + margin
    axes = [np.arange(a, b + pitch, pitch) for a, b in zip(low, high, strict=True)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def depth(points: Array, normals: Array, offsets: Array) -> Array:
    """How deep points are inside (the distance to the surface), negative outside (at least minus the distance)."""
    result = np.full(len(points), np.inf)
    for normal, offset in zip(normals, offsets, strict=True):
        np.minimum(result, offset - points @ normal, out=result)
    return result


def surface(vertices: Array, count: int) -> Array:
    """The vertices and about `count` points spread evenly over the surface of their hull. Shape (n, 3)."""
    hull = ConvexHull(vertices)
    pitch = float(np.sqrt(2 * hull.area / count))
    points = [vertices]
    for a, b, c in vertices[hull.simplices]:
        n = int(np.ceil(max(np.linalg.norm(b - a), np.linalg.norm(c - a)) / pitch))
        u, v = (w.ravel() / n for w in np.mgrid[0 : n + 1, 0 : n + 1])
        u, v = u[u + v <= 1, None], v[u + v <= 1, None]
        points.append(a + u * (b - a) + v * (c - a))
    return np.unique(np.concatenate(points).round(5), axis=0)


def greedy(distances: Array, radii: Array, most: int) -> list[int] | None:
    """Candidates (columns) that together contain all samples (rows), or None when more than `most` would be needed."""
    covered = distances <= radii
    left = np.ones(len(distances), dtype=bool)
    chosen: list[int] = []
    while left.any():
        if len(chosen) == most:
            return None
        gains = covered[left].sum(axis=0)
        best = int(gains.argmax())
        if gains[best] == 0:
            return None
        chosen.append(best)
        left &= ~covered[:, best]
    return chosen


def cover(hull: Hull, most: int = LEAVES) -> tuple[Array, float]:
    """Spheres (k, 4) that contain the hull, and how far the farthest stands out of it, metres."""
    vertices = np.asarray(hull.vertices)
    normals, offsets = planes(vertices)
    inside = grid(vertices, 0.01, 0.0)
    depths = depth(inside, normals, offsets)
    inside, depths = inside[depths > 0.0], depths[depths > 0.0]
    samples = surface(vertices, 3000)
    distances = np.linalg.norm(samples[:, None] - inside[None], axis=2)
    low, high, best = 0.001, 0.05, None
    for _ in range(7):
        slack = (low + high) / 2
        chosen = greedy(distances, depths + slack, most)
        if chosen is None:
            low = slack
        else:
            high, best = slack, (chosen, slack)
    if best is None:
        raise ValueError("no cover found")
    chosen, slack = best
    centres, radii = inside[chosen], depths[chosen] + slack
    reach = PITCH * np.sqrt(3) / 2
    nodes = grid(vertices, PITCH, PITCH)
    nodes = nodes[depth(nodes, normals, offsets) >= -reach]
    growth = np.full(len(nodes), np.inf)
    for centre, radius in zip(centres, radii, strict=True):
        np.minimum(growth, np.linalg.norm(nodes - centre, axis=1) - radius, out=growth)
    radii = radii + growth.max() + reach
    return np.column_stack([centres, radii]), float((radii - depths[chosen]).max())


def main() -> None:
    """Cover all hulls of all robots."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--leaves", type=int, default=LEAVES)
    parser.add_argument("--out", type=Path, default=None)
    options = parser.parse_args()
    import tamp.geometric.robot.spheres

    for name, make in ROBOTS.items():
        arrays = {}
        for link in make().links:
            for k, part in enumerate(link.parts):
                if isinstance(part.shape, Hull):
                    leaves, slack = cover(part.shape, options.leaves)
                    arrays[f"{link.name}/{k}"], arrays[f"{link.name}/{k}/slack"] = leaves, np.array(slack)
                    sys.stdout.write(f"{link.name}: {len(leaves)} spheres, slack {1000 * slack:.1f} mm\n")
        target = options.out or Path(tamp.geometric.robot.spheres.__file__).parent / "assets" / f"{name}_spheres.npz"
        np.savez_compressed(target, **arrays)


if __name__ == "__main__":
    main()
