"""Random poses of bodies: at rest, on the ground, in the air; T_frame_body (4, 4), metres."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.random import Generator as Random

from grounding.body_geometry import BodyGeometry
from grounding.relation_scene import Placed
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import CONTACT_GAP
from tamp.geometric.stability.placement import resting_pose


def random_rest(
    form: BodyGeometry, size: Array | tuple[float, ...], overhang: bool, rng: Random
) -> Array | None:
    """Sample T_region_body at rest: whole above the rectangle, or only its centre of mass, 2 cm
    inside, with `overhang`.
    """
    faces = [face for face in form.faces if face.extent + 2 * CONTACT_GAP <= size[2]]
    if not faces:
        return None
    weights = np.array([face.angle for face in faces])
    face = faces[int(rng.choice(len(faces), p=weights / weights.sum()))]
    yaw = rng.uniform(-math.pi, math.pi)
    c, s = math.cos(yaw), math.sin(yaw)
    turn = np.array([[c, -s], [s, c]])
    half = np.asarray(size[:2]) / 2
    if overhang:
        low = high = turn @ face.centre
        half = half - 0.02
    else:
        outline = face.outline @ turn.T
        low, high = outline.min(axis=0), outline.max(axis=0)

    least, most = -half - low, half - high
    if (least > most).any():
        return None
    x, y = rng.uniform(least, most)
    return resting_pose(face, yaw, float(x), float(y)).matrix.copy()


def on_ground(form: BodyGeometry, stand: Placed, rng: Random) -> Array | None:
    """Sample a pose at rest on the ground around a support."""
    low, high = stand.box
    size = high - low
    pose = random_rest(form, (size[0] + 1.0, size[1] + 1.0, math.inf), False, rng)
    if pose is not None:
        pose[:2, 3] += (low + high)[:2] / 2
    return pose


def afloat(stand: Placed, rng: Random) -> Array:
    """Sample a pose anywhere around and above a support, turned in any way."""
    low, high = stand.box
    pose = random_turn(rng)
    pose[:3, 3] = rng.uniform(
        [low[0] - 0.5, low[1] - 0.5, 0.15], [high[0] + 0.5, high[1] + 0.5, high[2] + 0.5]
    )
    return pose


def random_turn(rng: Random) -> Array:
    """Sample T with a uniformly random rotation and no translation, shape (4, 4)."""
    x, y, z, w = (float(v) for v in rng.normal(size=4))
    norm = math.sqrt(x * x + y * y + z * z + w * w)
    return Pose((0.0, 0.0, 0.0), (x / norm, y / norm, z / norm, w / norm)).matrix.copy()


def upright(at: Array, rng: Random) -> Array:
    """Sample a pose upright on the ground above `at` (2,), any yaw."""
    return Pose.from_xyz_yaw(
        float(at[0]), float(at[1]), 0.0, rng.uniform(-math.pi, math.pi)
    ).matrix.copy()


def solids(stand: Placed) -> list[Placed]:
    """Return the support's convex parts as obstacles of their own."""
    return [Placed(part, stand.matrix) for part in stand.form.pieces]


def pick(names: Mapping[str, object], rng: Random) -> str:
    """Pick one of the names."""
    return tuple(names)[int(rng.integers(len(names)))]


def random_scale(limits: tuple[float, float], rng: Random) -> float:
    """Sample a scale in steps of 0.1, so that shapes come again."""
    low, high = round(limits[0] * 10), round(limits[1] * 10)
    return int(rng.integers(low, high + 1)) / 10
