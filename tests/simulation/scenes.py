"""Scenes of bodies made by hand, for the engines, and worlds without one."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import (
    Body,
    Hull,
    Part,
    RobotStart,
    Room,
    Scene,
)

ROBOT = RobotStart("panda_mobile", (0.0, 0.0, 0.0))


def cube_hull(edge: float) -> Hull:
    corners = np.array(list(itertools.product((-edge / 2, edge / 2), repeat=3)))
    faces = np.array([
        [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
        [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
    ])  # fmt: skip
    return Hull(corners, faces)


def scene_of(*bodies: Body) -> Scene:
    return Scene("test", {body.name: body for body in bodies}, ROBOT, Room((-3, 3), (-3, 3)))


def body(
    name: str, *parts: Part, at: tuple[float, float, float] = (0, 0, 0), movable: bool = True
) -> Body:
    return Body(name, parts, Pose(at), movable)


def without_an_engine(kind: type) -> Any:
    """A class of worlds that can be made although what only an engine can answer is missing."""
    return type(kind.__name__, (kind,), dict.fromkeys(kind.__abstractmethods__))
