"""A robot's MJCF as a URDF: MuJoCo reads it, with its includes and defaults."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from tamp.commands.robot_folder.mjcf_shapes import Shapes, add_origin, pose_matrix
from tamp.errors import InputError
from tamp.geometric.loading.xml_file import read_xml
from tamp.geometric.robot.urdf_words import words
from tamp.geometric.scene.pose import Array
from tamp.simulation.mujoco_model import load_mujoco

WORLD = "world"


def as_urdf(file: Path, folder: Path) -> Path:
    """Return a description as a URDF: itself where it is one, else written in the folder.

    Raises:
        InputError: It is neither a URDF nor an MJCF.
    """
    tag = str(read_xml(file).tag)
    if tag == "mujoco":
        return urdf_of_mjcf(file, folder)
    if tag == "mujocoinclude":
        raise InputError("a part of an MJCF", file=file, remedy="Name the file that includes it")
    if tag != "robot":
        raise InputError(
            f"neither a URDF nor an MJCF: its root is <{tag[:40]}>, not <robot> or <mujoco>",
            file=file,
        )
    return file


def urdf_of_mjcf(file: Path, folder: Path) -> Path:
    """Write the URDF, and meshes beside it, of a robot in MJCF.

    A body is a link; several joints of one are a chain of links between. Frames of links are at
    their joints' anchors, and a joint is at 0 where the file draws it. Sites are frames. What can
    collide is a collision shape: planes and height fields, which have no end, are left out.
    Equalities of two joints are mimics.

    Args:
        file: The MJCF.
        folder: Where they are written.

    Raises:
        InputError: MuJoCo refuses it, with its words.
    """
    mujoco = load_mujoco()
    try:
        model: Any = mujoco.MjModel.from_xml_path(str(file))
    except (ValueError, RuntimeError, OSError) as error:
        raise InputError(f"MuJoCo refuses it: {' '.join(str(error).split())}", file=file) from None
    writer = _Writer(mujoco, model, folder)
    robot = writer.write()
    made = folder / "robot.urdf"
    ElementTree.ElementTree(robot).write(made, encoding="utf-8", xml_declaration=True)
    return made


class _Writer:
    """The URDF in the making.

    Args:
        mujoco: Its module.
        model: Its compiled model.
        folder: Where meshes are written.
    """

    def __init__(self, mujoco: Any, model: Any, folder: Path) -> None:
        self._mujoco, self._model = mujoco, model
        self._robot = ElementTree.Element("robot", name="")
        self._names: set[str] = set()
        self._links: dict[int, str] = {}
        self._anchors: dict[int, Array] = {}
        self._shapes = Shapes(mujoco, model, folder)

    def write(self) -> ElementTree.Element:
        """Return the robot's element."""
        model = self._model
        joints = [self._name("JOINT", j, f"joint{j}") for j in range(model.njnt)]
        mimics = self._mimics(joints)
        for body in range(model.nbody):
            name = WORLD if body == 0 else self._name("BODY", body, f"body{body}")
            self._links[body] = name
            first = int(model.body_jntadr[body])
            own = range(first, first + int(model.body_jntnum[body]))
            self._body(body, name, own, joints, mimics)
        for site in range(model.nsite):
            self._site(site)
        return self._robot

    def _body(
        self,
        body: int,
        name: str,
        own: range,
        joints: list[str],
        mimics: dict[str, tuple[str, Any]],
    ) -> None:
        """Write a body's links and joints, and its shapes in the last link."""
        model = self._model
        anchor = np.zeros(3)
        if body > 0:
            parent_number = int(model.body_parentid[body])
            parent, offset = self._links[parent_number], self._anchors[parent_number]
            T = pose_matrix(model.body_pos[body], model.body_quat[body])
            T[:3, 3] -= offset

            for count, joint in enumerate(own):
                at = np.array(model.jnt_pos[joint])
                child = name if count == len(own) - 1 else self._free(f"{name}_{joints[joint]}")
                step = T.copy() if count == 0 else np.eye(4)
                step[:3, 3] += step[:3, :3] @ (at - anchor)
                anchor = at
                if count < len(own) - 1:
                    self._link(child)
                self._joint(joint, joints[joint], parent, child, step, mimics)
                parent = child

            if not len(own):
                self._fixed(self._free(f"{name}_fixed"), parent, name, T)

        self._anchors[body] = anchor
        link = self._link(name, float(model.body_mass[body]) if body else 0.0)
        first = int(model.body_geomadr[body])
        for geom in range(first, first + int(model.body_geomnum[body])):
            if model.geom_contype[geom] or model.geom_conaffinity[geom]:
                self._shapes.add(link, geom, anchor)

    def _link(self, name: str, mass: float = 0.0) -> ElementTree.Element:
        link = ElementTree.SubElement(self._robot, "link", name=name)
        if mass > 0.0:
            inertial = ElementTree.SubElement(link, "inertial")
            ElementTree.SubElement(inertial, "mass", value=repr(mass))
            same = repr(1e-3 * mass)
            values = {"ixx": same, "iyy": same, "izz": same, "ixy": "0", "ixz": "0", "iyz": "0"}
            ElementTree.SubElement(inertial, "inertia", values)
        return link

    def _joint(
        self, joint: int, name: str, parent: str, child: str, T: Array,
        mimics: dict[str, tuple[str, Any]],
    ) -> None:  # fmt: skip
        model, kinds = self._model, self._mujoco.mjtJoint
        kind = int(model.jnt_type[joint])
        limited = bool(model.jnt_limited[joint])
        if kind in (int(kinds.mjJNT_FREE), int(kinds.mjJNT_BALL)):
            # the pose in the file is where a free body stands
            self._element(name, "floating", parent, child, T)
            return

        slides = kind == int(kinds.mjJNT_SLIDE)
        word = "prismatic" if slides else ("revolute" if limited else "continuous")
        element = self._element(name, word, parent, child, T)
        ElementTree.SubElement(element, "axis", xyz=words(model.jnt_axis[joint]))

        limit = {"effort": repr(self._effort(joint)), "velocity": "0"}  # MJCF has no velocities
        if limited:
            drawn = float(model.qpos0[model.jnt_qposadr[joint]])
            low, high = (float(value) - drawn for value in model.jnt_range[joint])
            limit |= {"lower": repr(low), "upper": repr(high)}
        ElementTree.SubElement(element, "limit", limit)
        if name in mimics:
            master, (offset, factor) = mimics[name]
            attributes = {"joint": master, "multiplier": repr(factor), "offset": repr(offset)}
            ElementTree.SubElement(element, "mimic", attributes)

    def _fixed(self, name: str, parent: str, child: str, T: Array) -> None:
        self._element(name, "fixed", parent, child, T)

    def _element(
        self, name: str, kind: str, parent: str, child: str, T: Array
    ) -> ElementTree.Element:
        element = ElementTree.SubElement(self._robot, "joint", name=name, type=kind)
        ElementTree.SubElement(element, "parent", link=parent)
        ElementTree.SubElement(element, "child", link=child)
        add_origin(element, T)
        return element

    def _effort(self, joint: int) -> float:
        """Return the most that a joint's limits and actuators allow; 0 where nothing says."""
        model = self._model
        found: list[float] = []
        if model.jnt_actfrclimited[joint]:
            found.append(float(np.abs(model.jnt_actfrcrange[joint]).max()))
        ways = self._mujoco.mjtTrn
        for actuator in range(model.nu):
            direct = int(model.actuator_trntype[actuator]) == int(ways.mjTRN_JOINT)
            if direct and int(model.actuator_trnid[actuator, 0]) == joint:
                gear = abs(float(model.actuator_gear[actuator, 0]))
                if model.actuator_forcelimited[actuator]:
                    found.append(gear * float(np.abs(model.actuator_forcerange[actuator]).max()))
        return min(found, default=0.0)

    def _mimics(self, joints: list[str]) -> dict[str, tuple[str, tuple[float, float]]]:
        """Read equalities of two joints, of first degree."""
        model, kinds = self._model, self._mujoco.mjtEq
        found: dict[str, tuple[str, tuple[float, float]]] = {}
        for eq in range(model.neq):
            if int(model.eq_type[eq]) != int(kinds.mjEQ_JOINT) or int(model.eq_obj2id[eq]) < 0:
                continue
            follower, master = (joints[int(ids[eq])] for ids in (model.eq_obj1id, model.eq_obj2id))
            offset, factor = (float(value) for value in model.eq_data[eq, :2])
            if master not in found:
                found[follower] = master, (offset, factor)
        return found

    def _site(self, site: int) -> None:
        model = self._model
        body = int(model.site_bodyid[site])
        T = pose_matrix(model.site_pos[site], model.site_quat[site])
        T[:3, 3] -= self._anchors[body]
        name = self._name("SITE", site, f"site{site}")
        self._link(name)
        self._fixed(self._free(f"{name}_fixed"), self._links[body], name, T)

    def _name(self, kind: str, number: int, else_: str) -> str:
        objects = self._mujoco.mjtObj
        name = self._mujoco.mj_id2name(self._model, getattr(objects, f"mjOBJ_{kind}"), number)
        return self._free(name or else_, kind == "JOINT")

    def _free(self, name: str, joint: bool = False) -> str:
        """Return a name that no other link, or joint, has."""
        mark = "joint " if joint else ""
        tried, count = name, 1
        while mark + tried in self._names or tried == WORLD:
            count += 1
            tried = f"{name}_{count}"
        self._names.add(mark + tried)
        return tried
