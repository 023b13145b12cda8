"""The appearance of bodies and of the robot: their meshes and colours."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache

import numpy as np

from tamp.errors import InputError
from tamp.geometric.loading.meshes import primitive_parts
from tamp.geometric.loading.urdf_link import read_visuals
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.scene import Body, Part, Visual
from tamp.view.mesh import Mesh, read_mesh, shape_mesh, simplified

BASE_COLOUR = (0.25, 0.3, 0.38, 1.0)
ROBOT_COLOUR = (0.93, 0.93, 0.95, 1.0)

CELL = 0.006
"""Metres: details of the robot that are smaller are not drawn; a third of the Panda's triangles
stay.
"""

LARGE = 20_000
"""Triangles of a body's mesh above which it is drawn with details of a hundredth of its size."""


def body_meshes(body: Body) -> tuple[Mesh, ...]:
    """Return the meshes of a body in its own frame: what its file shows, where that can be read,
    else its parts.
    """
    drawn, _ = _drawing(body)
    return drawn or tuple(_part(part, body.colour) for part in body.parts)


def undrawable(bodies: Iterable[Body]) -> tuple[str, ...]:
    """Describe each body of whose file the drawing cannot be read, in a sentence; its parts are
    drawn.
    """
    sentences: list[str] = []
    for body in bodies:
        _, why = _drawing(body)
        if why:
            sentences.append(f"{body.name}: {why}: its collision shape is drawn")
    return tuple(sentences)


@lru_cache(maxsize=256)
def _drawing(body: Body) -> tuple[tuple[Mesh, ...], str]:
    """Read the meshes of a body's visuals, or return none and why they cannot be read."""
    meshes: list[Mesh] = []
    try:
        for visual in body.visuals:
            meshes += _visual(visual, body)
    except InputError as error:
        return (), error.message
    return tuple(meshes), ""


def _visual(visual: Visual, body: Body) -> Iterator[Mesh]:
    if visual.mesh is None:
        yield from (_part(part, visual.colour or body.colour) for part in visual.shapes)
        return
    colour = visual.colour or body.colour
    meshes = read_mesh(visual.mesh, visual.scale, colour)
    if sum(len(mesh.faces) for mesh in meshes) > LARGE:
        low = np.min([mesh.vertices.min(axis=0) for mesh in meshes], axis=0)
        high = np.max([mesh.vertices.max(axis=0) for mesh in meshes], axis=0)
        meshes = [simplified(mesh, float((high - low).max()) / 100) for mesh in meshes]
    yield from (mesh.moved(visual.pose.matrix) for mesh in meshes)


def robot_meshes(robot: Robot) -> dict[str, tuple[Mesh, ...]]:
    """Return the meshes of each link in its own frame: the base's parts, and what the arm's URDF
    shows.
    """
    visuals = {
        arm.prefix + name: shown
        for arm in robot.arms
        for name, shown in read_visuals(arm.urdf).items()
    }

    looks: dict[str, tuple[Mesh, ...]] = {}
    for link in robot.links:
        meshes: list[Mesh] = []
        for element in visuals.get(link.name, ()):
            if element.mesh is None:
                meshes += [_part(part, ROBOT_COLOUR) for part in primitive_parts(element)]
            if element.mesh is not None:
                coloured = element.mesh.with_suffix(".mtl").is_file()
                read = read_mesh(
                    element.mesh, element.scale, None if coloured else ROBOT_COLOUR, CELL
                )
                meshes += [mesh.moved(element.pose.matrix) for mesh in read]
        colour = BASE_COLOUR if link.name == robot.base else ROBOT_COLOUR
        looks[link.name] = tuple(meshes) or tuple(_part(part, colour) for part in link.parts)
    return looks


def _part(part: Part, colour: tuple[float, float, float, float]) -> Mesh:
    return shape_mesh(part.shape, colour).moved(part.pose.matrix)
