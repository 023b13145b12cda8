"""Hand-made generators of placements: `surface`, the engineer's, and `uniform`, the paper's
baseline (section IV-A).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.random import Generator as Random

from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Scene
from tamp.geometric.stability.placement import Placement, placement_on, resting_pose, room_above
from tamp.geometric.stability.stable_poses import Face, stable_faces_of

KEEP_FACE = 0.85
"""The share of `surface` placements that keep the face that is down at the start, when it fits."""

BOX_GROWTH_SHARE = 0.5
"""`uniform` samples in the first argument's box grown on each side by this much of its largest half
extent."""


class SurfacePlacements:
    """A stable face down, uniform in yaw and in the positions that keep the whole body above the
    region; a curved side where no stable face fits under its ceiling.

    Where the body is larger than the region, uniform in the positions of its centre; overhang is
    judged afterwards.
    """

    def propose(
        self, scene: Scene, arguments: Sequence[str], count: int, rng: Random
    ) -> list[Placement]:
        """Propose placements at rest in the region `arguments[1]`; none when nothing fits under
        its ceiling.
        """
        body, region_name = arguments
        region = scene.region(region_name)
        stable = stable_faces_of(scene.bodies[body])
        faces = stable.under(room_above(region))
        if not faces:
            return []
        keep = KEEP_FACE if faces[0] < len(stable.ways) else 0.0  # no curved side is before another

        T_world_region = scene.world_pose(region)
        T_region_world = T_world_region.inverse()
        placements: list[Placement] = []
        for _ in range(count):
            index = faces[0] if rng.random() < keep else faces[int(rng.integers(len(faces)))]
            face, yaw = stable.face(index), rng.uniform(-math.pi, math.pi)
            x, y = position_inside(face, yaw, region.size, rng)
            # A pose of the world rounds them in the last bit, on which whole plans can hang: so
            # that seeds keep theirs, the numbers are those that it holds.
            T_world_body = T_world_region @ resting_pose(face, yaw, x, y)
            placements.append(placement_on(index, face, T_region_world @ T_world_body, region.name))

        return placements


class UniformPlacements:
    """Uniform positions in the grown box of the region's body, uniform rotations (LEARNING.md,
    section 1).
    """

    def propose(
        self, scene: Scene, arguments: Sequence[str], count: int, rng: Random
    ) -> list[Pose]:
        """Propose world poses; most of them float, sink or lean."""
        region = scene.region(arguments[1])
        support = scene.bodies[region.body]
        low, high = bounds(support.parts, support.pose)
        margin = BOX_GROWTH_SHARE * float((high - low).max()) / 2
        positions = rng.uniform(low - margin, high + margin, size=(count, 3))
        quaternions = rng.normal(size=(count, 4))
        quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
        return [
            Pose(
                (float(x), float(y), float(z)), (float(q[0]), float(q[1]), float(q[2]), float(q[3]))
            )
            for (x, y, z), q in zip(positions, quaternions, strict=True)
        ]


def position_inside(
    face: Face, yaw: float, size: Sequence[float], rng: Random
) -> tuple[float, float]:
    """Draw a random x, y of the body's frame, metres, in the frame of a rectangle of size x, y, at
    a yaw in radians.

    The outline stays inside; where it cannot, the centre of mass does.
    """
    c, s = math.cos(yaw), math.sin(yaw)
    outline = face.outline @ np.array([[c, s], [-s, c]])
    low, high = outline.min(axis=0), outline.max(axis=0)
    position = [0.0, 0.0]
    for axis in range(2):
        least, most = -size[axis] / 2 - low[axis], size[axis] / 2 - high[axis]
        if least > most:
            centre = float(np.array([c, -s] if axis == 0 else [s, c]) @ face.centre)
            least, most = -size[axis] / 2 - centre, size[axis] / 2 - centre
        position[axis] = rng.uniform(least, most)
    return position[0], position[1]
