"""The URDF of a robot on the joints that its base drives on: its frames are those of the kinematics."""

from __future__ import annotations

import dataclasses
import shutil
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pinocchio  # pyright: ignore[reportMissingImports]
import pytest

from tamp.errors import InputError
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.states import arm_of
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Part
from tamp.simulation.mobile_urdf import BASE_JOINTS, BASE_MASS, ROOT_LINK, mobile_urdf


def model_of(robot: Robot):
    return pinocchio.buildModelFromXML(mobile_urdf(robot))


def frames(model, values: dict[str, float]) -> dict[str, np.ndarray]:
    """The world's pose of each link at values of the joints by name; others at 0."""
    data, q = model.createData(), pinocchio.neutral(model)
    for name, value in values.items():
        joint = model.joints[model.getJointId(name)]
        if joint.nq == 2:  # one that turns on and on is kept as cosine and sine
            q[joint.idx_q : joint.idx_q + 2] = np.cos(value), np.sin(value)
        else:
            q[joint.idx_q] = value
    pinocchio.framesForwardKinematics(model, data, q)
    return {frame.name: data.oMf[i].homogeneous for i, frame in enumerate(model.frames)}


MOUNT = Pose.from_xyz_rpy((0.1, -0.2, 0.5), (0.3, -0.4, 1.2))


@pytest.mark.parametrize("name", ["ur5", "panda_mobile", "aslant"])
def test_every_link_is_where_the_kinematics_have_it(name: str) -> None:
    """Also of an arm that is mounted aslant."""
    robot = ROBOTS["ur5" if name == "aslant" else name]()
    robot = dataclasses.replace(robot, T_base_arm=MOUNT) if name == "aslant" else robot
    arm = np.random.default_rng(0).uniform(robot.lower, robot.upper)
    base, opening = [0.7, -0.4, 2.5], robot.opening / 2
    values = dict(zip(BASE_JOINTS, base, strict=True))
    values |= dict(zip((joint.name for joint in robot.joints), arm, strict=True))
    values |= {finger.name: opening / 2 for finger in robot.fingers}
    found = frames(model_of(robot), values)
    for link, pose in Kinematics(robot).link_poses(np.array([*base, *arm]), opening).items():
        assert found[link] == pytest.approx(pose, abs=1e-6), link


def test_two_arms_on_one_base_have_joints_of_their_own() -> None:
    robot = ROBOTS["two_pandas"]()
    model, rng = model_of(robot), np.random.default_rng(1)
    base = [0.2, 0.3, -1.0]
    confs = {arm.arm: rng.uniform(arm.lower, arm.upper) for arm in robot.arms}
    values = dict(zip(BASE_JOINTS, base, strict=True))
    for arm in robot.arms:
        values |= dict(zip((one.name for one in arm.joints), confs[arm.arm], strict=True))
    found = frames(model, values)
    for name, conf in confs.items():
        arm = dataclasses.replace(arm_of(robot, name), still_links={})
        tool = found[arm.hand] @ arm.T_hand_tool.matrix
        assert tool == pytest.approx(Kinematics(arm).tool(np.array([*base, *conf])), abs=1e-6)
    assert len(set(model.names)) == len(list(model.names))


def test_the_base_is_its_box_and_heavy() -> None:
    robot = ROBOTS["ur5"]()
    root = ElementTree.fromstring(mobile_urdf(robot))
    base = root.find(f"link[@name='{robot.base}']")
    assert base is not None
    (part,) = robot.link(robot.base).parts
    assert isinstance(part.shape, Box)
    box, origin, mass = (
        base.find(path) for path in ("collision/geometry/box", "collision/origin", "inertial/mass")
    )
    assert box is not None and origin is not None and mass is not None
    assert [float(word) for word in box.get("size", "").split()] == list(part.shape.size)
    assert [float(word) for word in origin.get("xyz", "").split()] == list(part.pose.position)
    assert float(mass.get("value", "")) == BASE_MASS
    children = {joint.find("child").get("link") for joint in root.iter("joint")}  # type: ignore[union-attr]
    names = {link.get("name") for link in root.iter("link")}
    assert names - children == {ROOT_LINK}  # the only root


def test_a_base_that_is_no_single_box_is_refused() -> None:
    robot = ROBOTS["ur5"]()
    (part,) = robot.link(robot.base).parts
    for parts in ((), (part, part), (Part(Cylinder(0.3, 0.2)),)):
        base = dataclasses.replace(robot.links[0], parts=parts)
        odd = dataclasses.replace(robot, links=(base, *robot.links[1:]))
        with pytest.raises(InputError, match="must be one box"):
            mobile_urdf(odd)


@pytest.mark.parametrize("name", ["R&D <1>", "it's", 'the "arm"', "plain"])
def test_folders_and_bases_of_any_name(name: str, tmp_path: Path) -> None:
    """Meshes are named by full path, in XML: the file that is named is there."""
    robot = ROBOTS["ur5"]()
    folder = tmp_path / name
    folder.mkdir()
    shutil.copy(robot.urdf, folder / "robot.urdf")
    shutil.copytree(robot.urdf.parent / "meshes", folder / "meshes")
    base = dataclasses.replace(robot.links[0], name=name)
    moved = dataclasses.replace(
        robot, urdf=folder / "robot.urdf", links=(base, *robot.links[1:]), base=name
    )
    root = ElementTree.fromstring(mobile_urdf(moved))
    assert name in {link.get("name") for link in root.iter("link")}
    files = [mesh.get("filename", "") for mesh in root.iter("mesh")]
    assert files and all(Path(file).is_file() for file in files)
    assert all(Path(file).is_relative_to(folder) for file in files)
