"""A scene to demonstrate in as the page reads it: meshes, places, and which way up bodies can
stand.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from grounding.demonstrate.scene import Stage
from grounding.demonstrate.viewer import front_edge, stand_of, viewer_yaw
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body
from tamp.geometric.stability.stable_poses import stable_faces_of
from tamp.view.appearance import body_meshes
from tamp.view.document import packed_meshes

MOST_FACES = 12
"""Ways up that a body can be turned to."""

FLOOR_MARGIN_M = 3.0
"""Metres of floor around what is shown."""


def stage_document(stage: Stage, number: int) -> dict[str, Any]:
    """Describe a scene for the page.

    Args:
        stage: The scene.
        number: How many scenes there have been; what the page sends must be about the last one.
    """
    scene = stage.scene
    yaw = viewer_yaw(scene, stage.arguments)
    target, radius = _framed(stage)
    stand = stand_of(scene, stage.arguments)

    return {
        "number": number,
        "arguments": list(stage.arguments),
        "bodies": [_body(body, stage) for body in scene.bodies.values()],
        "places": [
            {
                "name": place.name,
                "T": flat(scene.world_pose(place).matrix),
                "size": list(place.size[:2]),
            }
            for place in (*scene.surfaces.values(), *scene.cavities.values())
        ],
        "view": {"target": target.tolist(), "yaw": yaw + np.pi, "radius": radius},
        "front": None if stand is None else [round(float(x), 4) for x in front_edge(stand)],
        "floor": FLOOR_MARGIN_M,
    }


def flat(matrix: Array) -> list[float]:
    """Return a matrix (4, 4) as 16 numbers, row by row, to a tenth of a micrometre."""
    return [round(float(number), 7) + 0.0 for number in matrix.ravel()]


def _body(body: Body, stage: Stage) -> dict[str, Any]:
    low, high = bounds(body.parts, Pose())
    return {
        "name": body.name,
        "movable": body.name in stage.movable,
        "meshes": packed_meshes(body_meshes(body)),
        "T": flat(body.pose.matrix),
        "low": low.tolist(),
        "high": high.tolist(),
        "faces": _faces(body) if body.movable else [],
    }


def _faces(body: Body) -> list[list[float]]:
    """List the rotations (3, 3) that put a stable face down, as modelled first, 9 numbers each."""
    upright = np.eye(3)
    found = [upright]
    for face in stable_faces_of(replace(body, pose=Pose(), support=None)).faces:
        if all(np.abs(face.rotation[2] - other[2]).max() > 0.05 for other in found):
            found.append(face.rotation)
    return [
        [round(float(number), 7) for number in rotation.ravel()] for rotation in found[:MOST_FACES]
    ]


def _framed(stage: Stage) -> tuple[Array, float]:
    """Return the middle and the radius, metres, of what is to be seen at first: the arguments, and
    the bodies that stand where they do.
    """
    scene = stage.scene
    shown = [name for name in stage.arguments if name in stage.movable]
    supports = {scene.bodies[name].support for name in shown} - {None}
    shown += [name for name in stage.movable if scene.bodies[name].support in supports]
    names = shown or list(scene.bodies)
    boxes = [bounds(scene.bodies[name].parts, scene.bodies[name].pose) for name in names]
    low = np.min([box[0] for box in boxes], axis=0)
    high = np.max([box[1] for box in boxes], axis=0)
    return (low + high) / 2, max(0.3, float(np.linalg.norm(high - low)) / 2)
