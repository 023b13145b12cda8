"""A small picture of a demonstration: its arguments in the middle, seen from the front of what they
stand on.
"""

from __future__ import annotations

import io
import itertools
import math

import numpy as np

from grounding.demonstrate.viewer import viewer_yaw
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Scene
from tamp.view.appearance import body_meshes
from tamp.view.rasterizer import Camera, render, triangles

PICTURE_SIZE_PX = (168, 112)
"""Columns and rows."""

VIEW_ANGLE_DEG = 30.0
"""Of view from top to bottom, degrees."""

EYE_PITCH_RAD = math.radians(32.0)
"""How far the eye looks down, radians."""

LEAST_RADIUS_M = 0.16
"""Metres around the arguments that are seen at least."""


def thumbnail(scene: Scene, arguments: tuple[str, ...]) -> bytes:
    """Render a scene as a PNG, with the arguments (bodies and places) in the middle."""
    from PIL import Image

    parts = [
        triangles(mesh).moved(body.pose.matrix)
        for body in scene.bodies.values()
        for mesh in body_meshes(body)
        if len(mesh.faces)
    ]
    content = io.BytesIO()
    Image.fromarray(render(parts, _camera(scene, arguments), PICTURE_SIZE_PX)).save(content, "PNG")
    return content.getvalue()


def _camera(scene: Scene, arguments: tuple[str, ...]) -> Camera:
    shown = [scene.bodies[name] for name in arguments if name in scene.bodies]
    movable = [body for body in shown if body.movable] or shown
    corners: Array = np.array(
        [
            corner
            for body in movable or scene.bodies.values()
            for corner in itertools.product(*zip(*bounds(body.parts, body.pose), strict=True))
        ]
    )
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
    radius = max(float(np.linalg.norm(corners - middle, axis=1).max()), LEAST_RADIUS_M)

    yaw = viewer_yaw(scene, arguments)
    ahead = np.array([math.cos(yaw), math.sin(yaw)]) * math.cos(EYE_PITCH_RAD)
    out = np.array([-ahead[0], -ahead[1], math.sin(EYE_PITCH_RAD)])
    eye = middle + out * radius / math.sin(math.radians(VIEW_ANGLE_DEG) / 2)
    (x, y, z), (a, b, c) = eye.tolist(), middle.tolist()
    return Camera((x, y, z), (a, b, c), VIEW_ANGLE_DEG)
