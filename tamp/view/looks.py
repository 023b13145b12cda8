"""What bodies and the robot look like."""

from __future__ import annotations

from tamp.view.mesh import Mesh, read_mesh, shape_mesh
from tamp.world.robot import Robot
from tamp.world.scene import Body, Part
from tamp.world.urdf_link import read_visuals

BASE_COLOUR = (0.25, 0.3, 0.38, 1.0)
ROBOT_COLOUR = (0.93, 0.93, 0.95, 1.0)

CELL = 0.006
"""Metres: details of the robot that are smaller are not drawn; a third of the Panda's triangles stay."""

LARGE = 20_000
"""Triangles of a body's mesh above which it is drawn with details of a hundredth of its size."""


def body_meshes(body: Body) -> tuple[Mesh, ...]:
    """A body in its own frame: its visual mesh where it has one, else its parts."""
    if body.visual is None:
        return tuple(_part(part, body.colour) for part in body.parts)
    meshes = read_mesh(body.visual, body.visual_scale, body.colour)
    if sum(len(mesh.faces) for mesh in meshes) > LARGE:
        size = max(float((mesh.vertices.max(axis=0) - mesh.vertices.min(axis=0)).max()) for mesh in meshes)
        meshes = read_mesh(body.visual, body.visual_scale, body.colour, size / 100)
    return tuple(mesh.moved(body.visual_pose.matrix) for mesh in meshes)


def robot_meshes(robot: Robot) -> dict[str, tuple[Mesh, ...]]:
    """Each link in its own frame: the base's parts, and what the arm's URDF shows."""
    visuals = read_visuals(robot.urdf)
    looks: dict[str, tuple[Mesh, ...]] = {}
    for link in robot.links:
        meshes: list[Mesh] = []
        for element in visuals.get(link.name, ()):
            if element.shape is not None:
                meshes.append(_part(Part(element.shape, element.pose), ROBOT_COLOUR))
            if element.mesh is not None:
                coloured = element.mesh.with_suffix(".mtl").is_file()
                read = read_mesh(element.mesh, element.scale, None if coloured else ROBOT_COLOUR, CELL)
                meshes += [mesh.moved(element.pose.matrix) for mesh in read]
        colour = BASE_COLOUR if link is robot.links[0] else ROBOT_COLOUR
        looks[link.name] = tuple(meshes) or tuple(_part(part, colour) for part in link.parts)
    return looks


def _part(part: Part, colour: tuple[float, float, float, float]) -> Mesh:
    return shape_mesh(part.shape, colour).moved(part.pose.matrix)
