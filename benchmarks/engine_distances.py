"""Distances of near pairs by each engine, against coal's: boxes, plates, cans, balls, hulls, links of the robot.

    python -m benchmarks.engine_distances                # 10,000 pairs, from 20 mm apart to 20 mm deep

coal agrees with support functions in closed form to 1e-6 m. It has a flaw: a ball deep in a can may be measured
towards the side where the end is nearer (one of these 10,000 pairs; the closed form is taken for balls here), and
meshes are measured face by face: hulls are given to it as convex shapes. FCL is no reference: its signed distance is
off by up to 29 mm, and can end the process. "Faces" are pairs where flat faces of both look at each other, told by the
normal; a few of them overlap by less than a millimetre, where pybullet rounds as at edges: see the 99th percentile.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
import tyro

from benchmarks.common import record, table
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Hull, Part, RobotStart, Room, Scene, Shape, Sphere
from tamp.simulation.engines import ENGINES, installed, open_world
from tamp.simulation.shapes import points

REACH = 0.02
"""Metres apart, and deep, at most."""

FLAT = 1e-7
"""The most that the normal of a face may differ from the pair's, as one less the cosine."""


@dataclass(frozen=True)
class Options:
    """What to measure.

    Attributes:
        pairs: How many.
        seed: Of all that is random.
        out: The name of the file under benchmarks/results.
    """

    pairs: int = 10_000
    seed: int = 0
    out: str = "engine_distances.jsonl"


@dataclass(frozen=True)
class Pair:
    """Two shapes, the second's T_first_second, their distance by coal, and whether faces meet."""

    first: Shape
    second: Shape
    T_first_second: Array
    distance: float
    faces: bool

    @property
    def kinds(self) -> str:
        """The names of both shapes."""
        return " - ".join(sorted(type(shape).__name__ for shape in (self.first, self.second)))


def near_pairs(count: int, seed: int) -> Iterator[Pair]:
    """Random pairs from REACH apart to REACH deep, half of them with axes along each other."""
    import coal  # pyright: ignore[reportMissingImports]

    rng = np.random.default_rng(seed)
    shapes = [*_shapes(rng), *(part.shape for link in ROBOTS["panda_mobile"]().links for part in link.parts)]
    made = [coal_shape(coal, shape) for shape in shapes]
    found = 0

    while found < count:
        i, j = (int(one) for one in rng.integers(len(shapes), size=2))
        turn = _turn(rng)
        way = rng.normal(size=3)
        if rng.random() < 0.5:
            way = np.eye(3)[rng.integers(3)] * rng.choice([-1.0, 1.0])
        way /= np.linalg.norm(way)
        far = float((points(shapes[i]) @ way).max() - (points(shapes[j]) @ turn.T @ way).min())

        T = np.eye(4)
        T[:3, :3], T[:3, 3] = turn, way * (far + rng.uniform(-REACH, REACH))
        T[:3, 3] += rng.normal(size=3) * 0.01
        distance, normal = coal_distance(coal, made[i], made[j], T)
        first, second = shapes[i], shapes[j]
        if isinstance(first, Cylinder) and isinstance(second, Sphere):
            distance = ball_and_can(second, first, T[:3, 3])
        elif isinstance(first, Sphere) and isinstance(second, Cylinder):
            distance = ball_and_can(first, second, -T[:3, :3].T @ T[:3, 3])
        if abs(distance) < REACH:
            found += 1
            yield Pair(first, second, T, distance, _faces_meet(first, second, T, normal))


def _shapes(rng: np.random.Generator) -> list[Shape]:
    some: list[Shape] = [Box(tuple(rng.uniform(0.02, 0.3, 3).tolist())) for _ in range(6)]  # pyright: ignore
    some += [Box((0.3, 0.2, 0.002)), Box((1.2, 0.8, 0.04)), Box((0.02, 0.6, 0.4))]
    some += [
        Cylinder(float(r), float(h)) for r, h in zip(rng.uniform(0.01, 0.1, 4), rng.uniform(0.02, 0.2, 4), strict=True)
    ]
    some += [Sphere(0.01), Sphere(0.04)]
    return some + [_hull(rng.normal(size=(30, 3)) * 0.04) for _ in range(4)]


def _hull(cloud: Array) -> Hull:
    from scipy.spatial import ConvexHull

    hull = ConvexHull(cloud)
    number = np.full(len(cloud), -1)
    number[hull.vertices] = np.arange(len(hull.vertices))
    vertices, faces = cloud[hull.vertices], number[hull.simplices]
    inside = vertices.mean(axis=0)
    corners = vertices[faces] - inside
    inward = (
        np.einsum("ij,ij->i", np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), corners[:, 0]) < 0
    )
    faces[inward] = faces[inward][:, ::-1]
    return Hull(vertices, faces.astype(np.int32))


def _turn(rng: np.random.Generator) -> Array:
    """A rotation (3, 3): any, or one that maps axes onto axes."""
    if rng.random() < 0.5:
        turned = np.eye(3)[rng.permutation(3)]
        return turned * np.linalg.det(turned)
    x, y, z, w = rng.normal(size=4)
    length = math.sqrt(x * x + y * y + z * z + w * w)
    return Pose((0.0, 0.0, 0.0), (x / length, y / length, z / length, w / length)).rotation


def coal_shape(coal: Any, shape: Shape) -> Any:
    """The shape in coal."""
    if isinstance(shape, Box):
        return coal.Box(*shape.size)
    if isinstance(shape, Cylinder):
        return coal.Cylinder(shape.radius, shape.height)
    if isinstance(shape, Sphere):
        return coal.Sphere(shape.radius)
    corners, faces = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    for corner in shape.vertices:
        corners.append(corner)
    for a, b, c in shape.faces.tolist():
        faces.append(coal.Triangle(a, b, c))
    return coal.Convex(corners, faces)


def coal_distance(coal: Any, first: Any, second: Any, T: Array) -> tuple[float, Array]:
    """Signed distance, metres, and the normal (3,)."""
    here, there = coal.Transform3s(), coal.Transform3s()
    there.setRotation(T[:3, :3])
    there.setTranslation(T[:3, 3])
    asked, found = coal.DistanceRequest(), coal.DistanceResult()
    asked.enable_signed_distance = True
    distance = coal.distance(first, here, second, there, asked, found)
    return float(distance), np.array(found.normal)


def ball_and_can(ball: Sphere, can: Cylinder, centre: Array) -> float:
    """Signed distance of a ball whose centre (3,) is told in the can's frame, metres."""
    beyond = np.array([np.hypot(*centre[:2]) - can.radius, abs(centre[2]) - can.height / 2])
    return float(np.linalg.norm(np.maximum(beyond, 0.0)) + min(beyond.max(), 0.0)) - ball.radius


def _faces_meet(first: Shape, second: Shape, T: Array, normal: Array) -> bool:
    ours = _face_along(first, normal)
    theirs = _face_along(second, T[:3, :3].T @ -normal)
    return ours and theirs


def _face_along(shape: Shape, way: Array) -> bool:
    """Whether a flat face of the shape looks that way."""
    if isinstance(shape, Sphere):
        return False
    if isinstance(shape, Box):
        return bool(1 - np.abs(way).max() < FLAT)
    if isinstance(shape, Cylinder):
        return bool(1 - abs(way[2]) < FLAT)
    corners = shape.vertices[shape.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return bool(1 - (normals @ way).max() < FLAT)


def asked(name: str, pairs: list[Pair]) -> Array:
    """The distances by an engine, metres, shape (n,)."""
    shapes = {id(shape): shape for pair in pairs for shape in (pair.first, pair.second)}
    bodies = {
        f"{key}/{side}": Body(f"{key}/{side}", (Part(shape),), Pose((0.0, 0.0, 300.0)), movable=True)
        for key, shape in shapes.items()
        for side in "ab"
    }
    scene = Scene("pairs", MappingProxyType(bodies), RobotStart("", (0.0, 0.0, 0.0)), Room((-2, 2), (-2, 2)))
    found = []
    with open_world(scene, name=name) as world:
        for pair in pairs:
            first, second = f"{id(pair.first)}/a", f"{id(pair.second)}/b"
            world.place(first, np.eye(4))
            world.place(second, pair.T_first_second)
            found.append(world.body_distance(first, second, 2 * REACH))
            for body in (first, second):
                world.place(body, Pose((0.0, 0.0, 300.0)).matrix)
    return np.array(found)


def main(options: Options) -> None:
    """Measure, print, write."""
    pairs = list(near_pairs(options.pairs, options.seed))
    truth, faces = np.array([pair.distance for pair in pairs]), np.array([pair.faces for pair in pairs])
    rows: list[dict[str, Any]] = []
    for name in ENGINES:
        if not installed(name):
            continue
        began = time.process_time()
        error = 1000 * (asked(name, pairs) - truth)
        rows.append({
            "engine": name, "least_mm": float(error.min()), "most_mm": float(error.max()),
            "faces_mm": float(np.abs(error[faces]).max()),
            "faces_p99_mm": float(np.quantile(np.abs(error[faces]), 0.99)),
            "beyond_0.1_mm": int((np.abs(error) > 0.1).sum()),
            "beyond_1_mm": int((np.abs(error) > 1).sum()), "worst": pairs[int(np.abs(error).argmax())].kinds,
            "cpu_s": time.process_time() - began,
        })  # fmt: skip
    table(rows, f"{len(pairs):,} near pairs, {int(faces.sum()):,} of them at faces: error against coal")
    record(options.out, seed=options.seed, pairs=len(pairs), faces=int(faces.sum()), engines=rows)


if __name__ == "__main__":
    main(tyro.cli(Options))
