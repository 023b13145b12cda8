"""Bodies and scenes made by hand, without a problem file."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tamp.geometric.loading.bodies import UnplacedBody, read_body
from tamp.geometric.loading.yaml_file import read_yaml
from tamp.geometric.loading.yaml_nodes import YamlNode
from tamp.geometric.scene.convex import hull_of
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import (
    Body,
    Box,
    Cavity,
    Hull,
    Part,
    RobotStart,
    Room,
    Scene,
    Shape,
    Surface,
)


def body(
    name: str, shape: Shape, at: tuple[float, float, float], *, movable: bool = True, **more: object
) -> Body:
    """A body of one part at a position, upright."""
    return Body(name, (Part(shape),), Pose(at), movable, **more)  # type: ignore[arg-type]


def table(name: str = "table", at: tuple[float, float] = (0.0, 0.0), height: float = 0.5) -> Body:
    """A solid fixed block of 1 x 0.6 m with its whole top as a surface of the same name."""
    top = Surface(name, name, Pose((0.0, 0.0, height / 2)), (1.0, 0.6))
    return body(name, Box((1.0, 0.6, height)), (*at, height / 2), movable=False, surfaces=(top,))


def crate(name: str = "crate", at: tuple[float, float] = (2.0, 0.0)) -> Body:
    """A floor plate of 0.4 x 0.4 x 0.02 m whose cavity, 0.3 m high, is the space above it."""
    inside = Cavity(f"{name}_inside", name, Pose((0.0, 0.0, 0.01)), (0.4, 0.4, 0.3))
    return body(name, Box((0.4, 0.4, 0.02)), (*at, 0.01), movable=False, cavities=(inside,))


def scene(
    *bodies: Body, base: tuple[float, float, float] = (0.0, -2.0, 0.0), half: float = 3.0
) -> Scene:
    """A square room of `half` metres each way with those bodies in it."""
    return Scene(
        "made",
        {one.name: one for one in bodies},
        RobotStart("panda_mobile", base),
        Room((-half, half), (-half, half)),
    )


def hull(points: Array) -> Hull:
    """The convex hull of points (n, 3) as a shape."""
    return Hull(*hull_of(np.asarray(points, dtype=float)))


def cuboid(size: tuple[float, float, float]) -> Array:
    """The eight corners (8, 3) of a box about the origin."""
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
    return signs * np.array(size) / 2


def yaml(folder: Path, text: str) -> YamlNode:
    """The root of a YAML text, read from a file in the folder."""
    file = folder / "given.yaml"
    file.write_text(text, encoding="utf-8")
    return read_yaml(file)


def drafts(folder: Path, text: str) -> dict[str, UnplacedBody]:
    """The bodies of a YAML text, one a line as in `bodies:`, read but not placed."""
    return {
        name: read_body(name, node, folder) for name, node in yaml(folder, text).mapping().items()
    }
