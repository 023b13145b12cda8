"""Write tamp/geometric/robot/assets/panda_mobile.npz: the convex hulls of the Panda's links, in their frames.

    python benchmarks/build_robot_hulls.py

Shipped precomputed because scipy and trimesh cost a second at start-up. The hull is taken over all vertices of a link's
mesh: link6.obj has faces of two vertices, so its faces cannot be trusted, and pybullet collides with the hull as well.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial import ConvexHull

from tamp.geometric.robot.robot import panda_urdf
from tamp.geometric.robot.urdf import read_collision_vertices
from tamp.geometric.scene.pose import Array

ASSET = Path(__file__).parents[1] / "tamp" / "geometric" / "robot" / "assets" / "panda_mobile.npz"


def hull(points: Array) -> tuple[Array, np.ndarray]:
    """Vertices (n, 3) and outward triangles (m, 3) of the convex hull of points."""
    result = ConvexHull(points)
    new = np.full(len(points), -1)
    new[result.vertices] = np.arange(len(result.vertices))
    vertices = points[result.vertices]
    faces = new[result.simplices]
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inward = np.einsum("ij,ij->i", normals, result.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    return vertices, faces


def main() -> None:
    """Build the asset."""
    arrays = {}
    for name, points in read_collision_vertices(panda_urdf()).items():
        vertices, faces = hull(points)
        arrays[f"{name}/vertices"] = vertices
        arrays[f"{name}/faces"] = faces.astype(np.int64)
    np.savez_compressed(ASSET, **arrays)  # pyright: ignore[reportArgumentType]


if __name__ == "__main__":
    main()
