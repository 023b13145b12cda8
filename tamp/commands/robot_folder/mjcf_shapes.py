"""The shapes of an MJCF as collision elements of a URDF."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from tamp.commands.robot_folder.convex import ball
from tamp.geometric.robot.urdf_words import roll_pitch_yaw, words
from tamp.geometric.scene.pose import Array, Pose


class Shapes:
    """Collision elements, and the meshes that they name.

    Args:
        mujoco: Its module.
        model: Its compiled model.
        folder: Where meshes are written.
    """

    def __init__(self, mujoco: Any, model: Any, folder: Path) -> None:
        self._mujoco, self._model, self._folder = mujoco, model, folder
        self._files: dict[int, str] = {}

    def add(self, link: ElementTree.Element, geom: int, anchor: Array) -> None:
        """Add a geom to a link whose frame is at the anchor (3,) in the body's; nothing for one
        without an end.
        """
        model, kinds = self._model, self._mujoco.mjtGeom
        kind, size = int(model.geom_type[geom]), [float(v) for v in model.geom_size[geom]]
        if kind in (int(kinds.mjGEOM_PLANE), int(kinds.mjGEOM_HFIELD)):
            return

        collision = ElementTree.SubElement(link, "collision")
        T = pose_matrix(model.geom_pos[geom], model.geom_quat[geom])
        T[:3, 3] -= anchor
        add_origin(collision, T)

        geometry = ElementTree.SubElement(collision, "geometry")
        if kind == int(kinds.mjGEOM_BOX):
            ElementTree.SubElement(geometry, "box", size=words(2 * value for value in size))
        elif kind == int(kinds.mjGEOM_SPHERE):
            ElementTree.SubElement(geometry, "sphere", radius=repr(size[0]))
        elif kind in (int(kinds.mjGEOM_CYLINDER), int(kinds.mjGEOM_CAPSULE)):
            tag = "cylinder" if kind == int(kinds.mjGEOM_CYLINDER) else "capsule"
            attributes = {"radius": repr(size[0]), "length": repr(2 * size[1])}
            ElementTree.SubElement(geometry, tag, attributes)
        elif kind == int(kinds.mjGEOM_MESH):
            mesh = int(model.geom_dataid[geom])
            ElementTree.SubElement(geometry, "mesh", filename=self._mesh(mesh))
        else:
            file = f"geom{geom}.obj"
            points = ball(1.0, 0.0) * np.array(size)
            _write_obj(self._folder / file, points, ConvexHull(points).simplices)
            ElementTree.SubElement(geometry, "mesh", filename=file)

    def _mesh(self, mesh: int) -> str:
        if mesh not in self._files:
            model = self._model
            first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
            begin, faces = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
            self._files[mesh] = f"mesh{mesh}.obj"
            _write_obj(
                self._folder / self._files[mesh],
                np.array(model.mesh_vert[first : first + count], dtype=float),
                np.array(model.mesh_face[begin : begin + faces]),
            )
        return self._files[mesh]


def pose_matrix(position: Array, quaternion: Array) -> Array:
    """Return a pose (4, 4) of MuJoCo's position and quaternion wxyz."""
    w, x, y, z = (float(value) for value in quaternion)
    a, b, c = (float(value) for value in position)
    norm = math.sqrt(w * w + x * x + y * y + z * z) or 1.0
    return Pose((a, b, c), (x / norm, y / norm, z / norm, w / norm)).matrix.copy()


def add_origin(element: ElementTree.Element, T: Array) -> None:
    """Add a pose (4, 4) to an element."""
    angles = words(roll_pitch_yaw(T[:3, :3]))
    ElementTree.SubElement(element, "origin", xyz=words(T[:3, 3]), rpy=angles)


def _write_obj(file: Path, vertices: Array, faces: NDArray[np.integer]) -> None:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces.tolist()]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
