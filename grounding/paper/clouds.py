"""Points on the surface of a form, which its point-cloud features are made of."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from grounding.body_geometry import BodyGeometry
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body
from tamp.geometric.stability.hulls import body_hull

POINTS = 2048
"""Points of a cloud (paper, section III-B)."""


def cloud(form: BodyGeometry) -> Array:
    """Sample a cloud of POINTS points on the surfaces of the form's parts, uniform by area, shape
    (POINTS, 3); metres, its own frame.

    The same form has the same points, and a scaled one has them scaled.
    """
    return _unit_cloud(form.unit) * form.scale


@lru_cache(maxsize=1024)
def _unit_cloud(form: BodyGeometry) -> Array:
    rng = np.random.default_rng(0)
    meshes = [body_hull(Body("cloud", (part,), Pose(), movable=True)) for part in form.parts]
    corners = np.concatenate(
        [points[triangles] for points, triangles in meshes]
    )  # (triangles, 3 corners, 3)
    first, along, across = (
        corners[:, 0],
        corners[:, 1] - corners[:, 0],
        corners[:, 2] - corners[:, 0],
    )
    area = np.linalg.norm(np.cross(along, across), axis=1)
    chosen = rng.choice(len(area), size=POINTS, p=area / area.sum())
    u, v = rng.random((2, POINTS, 1))
    beyond = u + v > 1  # the other half of the parallelogram, folded back
    u, v = np.where(beyond, 1 - u, u), np.where(beyond, 1 - v, v)
    points = first[chosen] + u * along[chosen] + v * across[chosen]
    points.flags.writeable = False
    return points
