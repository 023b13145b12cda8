"""Random scenes and plain FCL on all pairs of parts: what the compiled checker is held against."""

from __future__ import annotations

import fcl
import numpy as np
from scipy.spatial import ConvexHull

from tamp.geometric.collision.collisions import Attachment
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Hull, Part, RobotStart, Room, Scene, Shape, Sphere


def random_shape(rng: np.random.Generator, smallest: float = 0.03, largest: float = 0.3) -> Shape:
    """A box, cylinder, sphere or random hull, sides in metres."""
    x, y, z = (float(side) for side in rng.uniform(smallest, largest, 3))
    match rng.integers(4):
        case 0:
            return Box((x, y, z))
        case 1:
            return Cylinder(x / 2, z)
        case 2:
            return Sphere(x / 2)
        case _:
            points = rng.normal(size=(int(rng.integers(5, 60)), 3))
            points = points / np.linalg.norm(points, axis=1)[:, None] * (x / 2, y / 2, z / 2) + rng.uniform(
                -0.1, 0.1, 3
            )
            return convex(points)


def convex(points: Array) -> Hull:
    """The convex hull of points (n, 3), its faces outward."""
    hull = ConvexHull(points)
    faces = hull.simplices.copy()
    a, b, c = (points[faces[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), hull.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    used, faces = np.unique(faces, return_inverse=True)
    return Hull(np.ascontiguousarray(points[used]), faces.reshape(-1, 3))


def table(size: tuple[float, float, float]) -> tuple[Part, ...]:
    """A board on four legs; the frame is on the floor."""
    x, y, z = size
    legs = [Pose((sx * (x / 2 - 0.03), sy * (y / 2 - 0.03), (z - 0.04) / 2)) for sx in (-1, 1) for sy in (-1, 1)]
    return (Part(Box((x, y, 0.04)), Pose((0.0, 0.0, z - 0.02))), *(Part(Box((0.05, 0.05, z - 0.04)), p) for p in legs))


def cupboard(size: tuple[float, float, float]) -> tuple[Part, ...]:
    """Three boards, two sides and a back; open to +y."""
    x, y, z = size
    boards = [Part(Box((x, y, 0.02)), Pose((0.0, 0.0, h))) for h in (0.01, z / 2, z - 0.01)]
    sides = [Part(Box((0.02, y, z)), Pose((s * (x / 2 - 0.01), 0.0, z / 2))) for s in (-1, 1)]
    return (*boards, *sides, Part(Box((x, 0.02, z)), Pose((0.0, -y / 2 + 0.01, z / 2))))


def random_pose(rng: np.random.Generator, low: Array, high: Array) -> Pose:
    """A position in the box, any orientation."""
    quaternion = rng.normal(size=4)
    x, y, z, w = quaternion / np.linalg.norm(quaternion)
    px, py, pz = rng.uniform(low, high)
    return Pose((float(px), float(py), float(pz)), (float(x), float(y), float(z), float(w)))


def random_scene(rng: np.random.Generator, movable: int = 12, robot: str = "panda_mobile") -> Scene:
    """Two tables, a cupboard and bodies, some of several parts, about the origin; `held` is small and movable."""
    places = [(1.1, 0.0, 0.0), (-1.2, 0.4, 1.5), (0.1, -1.3, 0.3)]
    kinds = [table((1.2, 0.7, 0.72)), cupboard((0.9, 0.42, 1.3)), table((0.8, 0.8, 0.5))]
    bodies = []
    for i, ((x, y, yaw), parts) in enumerate(zip(places, kinds, strict=True)):
        dx, dy, turn = rng.uniform(-0.2, 0.2, 3)
        bodies.append(Body(f"fixed{i}", parts, Pose.from_xyz_yaw(x + dx, y + dy, 0.0, yaw + turn), False))
    low, high = np.array([-1.5, -1.5, 0.1]), np.array([1.5, 1.5, 1.5])
    for i in range(movable):
        parts = tuple(
            Part(random_shape(rng), random_pose(rng, np.full(3, -0.1), np.full(3, 0.1)) if k else Pose())
            for k in range(int(rng.integers(1, 3)))
        )
        bodies.append(Body(f"body{i}", parts, random_pose(rng, low, high), True))
    bodies.append(Body("held", (Part(random_shape(rng, 0.04, 0.2)),), Pose((9.0, 9.0, 0.0)), True))
    return Scene(
        "random",
        {b.name: b for b in bodies},
        RobotStart(robot, (0.0, 0.0, 0.0)),
        Room((-2.0, 2.0), (-2.0, 2.0)),
    )


def random_confs(rng: np.random.Generator, robot: Robot, count: int) -> Array:
    """Configurations (count, 3 + joints) about the origin."""
    return np.hstack([rng.uniform(-1.0, 1.0, (count, 2)), rng.uniform(-3, 3, (count, 1)),
                      rng.uniform(robot.lower, robot.upper, (count, len(robot.joints)))])  # fmt: skip


class PlainFcl:
    """The robot, with or without a body in its hand, against bodies: every pair of parts by FCL, FK by pinocchio.

    Shares nothing with the compiled checker but the robot's data.
    """

    def __init__(
        self, scene: Scene, robot: Robot, kinematics: Kinematics, poses: dict[str, Pose], attachment: Attachment | None
    ) -> None:
        self.robot, self.kinematics = robot, kinematics
        self.opening = attachment.opening if attachment else robot.opening
        held = attachment.body if attachment else None
        self.obstacles = [(name, _object(part, (pose @ part.pose).matrix))
                          for name, pose in {**{n: scene.bodies[n].pose for n in scene.fixed}, **poses}.items()
                          if name != held for part in scene.bodies[name].parts]  # fmt: skip
        self.floor = _object(Part(Box((40.0, 40.0, 1.0))), Pose((0.0, 0.0, -0.5)).matrix)
        self.manager = fcl.DynamicAABBTreeCollisionManager()
        self.manager.registerObjects([obj for _, obj in self.obstacles])
        self.manager.setup()
        self.parts = [
            (link.name, part.pose.matrix, _object(part, np.eye(4))) for link in robot.links for part in link.parts
        ]
        self.T_tool_held = attachment.T_tool_body.matrix if attachment else np.eye(4)
        if attachment:
            body = scene.bodies[attachment.body]
            self.parts += [(body.name, part.pose.matrix, _object(part, np.eye(4))) for part in body.parts]
        group = robot.grippers | {held}
        self.grounded = {robot.base, robot.foot}
        self.pairs = [
            (a, b) for b in range(len(self.parts)) for a in range(b)
            if not {self.parts[a][0], self.parts[b][0]} <= group and self.parts[a][0] != self.parts[b][0]
            and tuple(sorted((self.parts[a][0], self.parts[b][0]))) not in robot.allowed
        ]  # fmt: skip

    def _place(self, conf: Array) -> None:
        poses = self.kinematics.link_poses(conf, self.opening)
        for name, T_owner_part, obj in self.parts:
            T_world_owner = poses[name] if name in poses else self.kinematics.tool(conf) @ self.T_tool_held
            matrix = T_world_owner @ T_owner_part
            obj.setTransform(fcl.Transform(matrix[:3, :3], matrix[:3, 3]))

    def collides(self, conf: Array) -> tuple[str, str] | None:
        """A pair that intersects."""
        self._place(conf)
        for name, _, obj in self.parts:
            data = fcl.CollisionData()
            self.manager.collide(obj, data, fcl.defaultCollisionCallback)
            if data.result.is_collision:
                return name, "a body"
            if name not in self.grounded and fcl.collide(obj, self.floor):
                return name, "floor"
        for a, b in self.pairs:
            if fcl.collide(self.parts[a][2], self.parts[b][2]):
                return self.parts[a][0], self.parts[b][0]
        return None

    def distance(self, conf: Array) -> float:
        """The least distance of all pairs, metres; <= 0 when one intersects."""
        self._place(conf)
        least = min(fcl.distance(self.parts[a][2], self.parts[b][2]) for a, b in self.pairs)
        for name, _, obj in self.parts:
            data = fcl.DistanceData()
            self.manager.distance(obj, data, fcl.defaultDistanceCallback)
            least = min(least, data.result.min_distance)
            if name not in self.grounded:
                least = min(least, fcl.distance(obj, self.floor))
        return least


def _object(part: Part, matrix: Array) -> fcl.CollisionObject:
    shape = part.shape
    if isinstance(shape, Box):
        geometry = fcl.Box(*shape.size)
    elif isinstance(shape, Cylinder):
        geometry = fcl.Cylinder(shape.radius, shape.height)
    elif isinstance(shape, Sphere):
        geometry = fcl.Sphere(shape.radius)
    else:
        faces = np.column_stack([np.full(len(shape.faces), 3), shape.faces]).ravel()
        geometry = fcl.Convex(np.array(shape.vertices), len(shape.faces), faces)
    return fcl.CollisionObject(geometry, fcl.Transform(matrix[:3, :3], matrix[:3, 3]))
