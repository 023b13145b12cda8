"""A robot's folder as it is written: read back it is the robot, its URDF has the same frames, hulls and masses."""

from __future__ import annotations

import dataclasses
import math
import os
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pinocchio  # pyright: ignore[reportMissingImports]
import pytest

from tamp.commands.robot_folder import write
from tamp.commands.robot_folder.write import LEAST_MASS, mesh_name, urdf_text, write_folder
from tamp.errors import InputError
from tamp.geometric.loading.robot_folder import read_robot
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import LIMIT_MARGIN_RAD, Robot
from tamp.geometric.robot.urdf import Joint, read_collision_vertices, read_joints
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Hull

NAMES = ["ur5", "ur5_suction", "xarm7"]


def table_of(robot: Robot) -> dict[str, Array]:
    with np.load(robot.folder / "reachability.npz") as arrays:
        return {key: arrays[key] for key in arrays}


def written(robot: Robot, folder: Path, masses: dict[str, float] | None = None) -> Path:
    out = folder / robot.name
    write_folder(out, robot, {}, table_of(robot), masses or {}, "some.urdf")
    return out


def renamed(robot: Robot, names: dict[str, str]) -> Robot:
    """The same with other names of links and joints."""

    def of(name: str) -> str:
        return names.get(name, name)

    def joints(some: tuple[Joint, ...]) -> tuple[Joint, ...]:
        return tuple(
            dataclasses.replace(one, name=of(one.name), parent=of(one.parent), child=of(one.child))
            for one in some
        )

    pairs = [sorted((of(a), of(b))) for a, b in robot.allowed]
    return dataclasses.replace(
        robot,
        links=tuple(dataclasses.replace(link, name=of(link.name)) for link in robot.links),
        base=of(robot.base), foot=of(robot.foot), hand=of(robot.hand),
        joints=joints(robot.joints), fingers=joints(robot.fingers),
        allowed=frozenset((a, b) for a, b in pairs),
    )  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
def test_what_is_read_back_is_the_robot(name: str, tmp_path: Path) -> None:
    robot = ROBOTS[name]()
    found = read_robot(written(robot, tmp_path))
    for field in dataclasses.fields(Robot):
        if field.name in ("links", "joints", "fingers", "urdf", "folder", "described"):
            continue
        assert getattr(found, field.name) == getattr(robot, field.name), field.name
    for own, read in zip(
        (*robot.joints, *robot.fingers), (*found.joints, *found.fingers), strict=True
    ):
        assert (read.name, read.child, read.kind) == (own.name, own.child, own.kind)
        assert (read.origin, read.axis) == (own.origin, own.axis)
    for own, read in zip(robot.links, found.links, strict=True):
        assert len(own.parts) == len(read.parts)
        for first, second in zip(own.parts, read.parts, strict=True):
            if isinstance(first.shape, Hull) and isinstance(second.shape, Hull):
                assert np.array_equal(first.shape.vertices, second.shape.vertices)
                assert np.array_equal(first.shape.faces, second.shape.faces)
            else:
                assert first == second


@pytest.mark.parametrize("name", NAMES)
def test_the_urdf_has_the_frames_of_the_kinematics(name: str, tmp_path: Path) -> None:
    """By pinocchio, from the foot on, at random angles and an opening."""
    robot = ROBOTS[name]()
    model = pinocchio.buildModelFromUrdf(str(written(robot, tmp_path) / "robot.urdf"))
    data, rng = model.createData(), np.random.default_rng(0)
    for _ in range(3):
        arm, opening = rng.uniform(robot.lower, robot.upper), robot.opening * rng.uniform()
        q = pinocchio.neutral(model)
        values = dict(zip((joint.name for joint in robot.joints), arm, strict=True))
        values |= {finger.name: opening / 2 for finger in robot.fingers}
        for joint, value in values.items():
            q[model.joints[model.getJointId(joint)].idx_q] = value
        pinocchio.framesForwardKinematics(model, data, q)
        poses = Kinematics(robot).link_poses(np.array([0.0, 0.0, 0.0, *arm]), opening)
        T_foot = np.linalg.inv(poses[robot.foot])
        for link in robot.links[1:]:
            frame = data.oMf[model.getFrameId(link.name)].homogeneous
            assert frame == pytest.approx(T_foot @ poses[link.name], abs=1e-9), link.name


def test_the_meshes_are_the_hulls(tmp_path: Path) -> None:
    robot = ROBOTS["ur5"]()
    found = read_collision_vertices(written(robot, tmp_path) / "robot.urdf")
    for link in robot.links[1:]:
        shape = link.parts[0].shape
        assert isinstance(shape, Hull)
        assert np.array_equal(found[link.name], shape.vertices)


def test_masses_and_inertias_are_those_of_boxes_around_the_hulls(tmp_path: Path) -> None:
    """A link of which nothing is said weighs the least that physics wants."""
    robot = ROBOTS["ur5"]()
    heavy = next(one.child for one in robot.joints if len(robot.link(one.child).parts) == 1)
    root = ElementTree.fromstring(urdf_text(robot, {heavy: 7.0}))
    for link in root.iter("link"):
        mass = float(link.find("inertial/mass").get("value"))  # type: ignore[union-attr, arg-type]
        assert mass == (7.0 if link.get("name") == heavy else LEAST_MASS)
    inertia = root.find(f"link[@name='{heavy}']/inertial")
    assert inertia is not None
    (part,) = robot.link(heavy).parts
    assert isinstance(part.shape, Hull)
    corners = part.pose.apply(part.shape.vertices)
    x, y, z = np.ptp(corners, axis=0)
    told = {key: float(value) for key, value in inertia.find("inertia").attrib.items()}  # type: ignore[union-attr]
    assert told["ixx"] == pytest.approx(7.0 * (y * y + z * z) / 12, rel=1e-4)
    assert told["iyy"] == pytest.approx(7.0 * (x * x + z * z) / 12, rel=1e-4)
    assert told["izz"] == pytest.approx(7.0 * (x * x + y * y) / 12, rel=1e-4)
    at = [float(word) for word in inertia.find("origin").get("xyz").split()]  # type: ignore[union-attr]
    assert at == pytest.approx((corners.min(axis=0) + corners.max(axis=0)) / 2)


def test_limits_a_joint_that_turns_on_and_fingers(tmp_path: Path) -> None:
    """A continuous joint has two turns to each side, beyond the margin that plans keep."""
    robot = ROBOTS["ur5"]()
    endless = dataclasses.replace(robot.joints[0], kind="continuous")
    changed = dataclasses.replace(robot, joints=(endless, *robot.joints[1:]))
    joints = read_joints(written(changed, tmp_path) / "robot.urdf")
    turning = joints[endless.name]
    assert turning.kind == "revolute"
    assert (turning.lower, turning.upper) == pytest.approx(
        (-2 * math.pi - LIMIT_MARGIN_RAD, 2 * math.pi + LIMIT_MARGIN_RAD)
    )
    for own in robot.joints[1:]:
        assert (joints[own.name].lower, joints[own.name].upper) == (own.lower, own.upper)
    for finger in robot.fingers:
        assert (joints[finger.name].lower, joints[finger.name].upper) == (0.0, robot.opening / 2)


@pytest.mark.parametrize(
    "name",
    ["1", "on", "null", "1e5", "it's", 'a"b', "x&y", "a b", "a\\b", "a:b", "#b", "~", "<x>", "ä"],
)
def test_names_that_a_urdf_may_have_are_kept(name: str, tmp_path: Path) -> None:
    """Links and joints with blanks, signs of XML or words of YAML: all three files say the same."""
    robot = ROBOTS["ur5"]()
    odd = renamed(robot, {robot.links[3].name: name, robot.joints[2].name: name})
    out = written(odd, tmp_path)
    found = read_robot(out)
    assert [link.name for link in found.links] == [link.name for link in odd.links]
    assert [joint.name for joint in found.joints] == [joint.name for joint in odd.joints]
    assert found.allowed == odd.allowed
    joints = read_joints(out / "robot.urdf")
    assert joints[name].name == name
    assert {joint.child for joint in joints.values()} >= {name}
    assert read_collision_vertices(out / "robot.urdf").keys() == {
        link.name for link in odd.links[1:]
    }


def test_links_whose_names_differ_in_signs_have_meshes_of_their_own(tmp_path: Path) -> None:
    assert len({mesh_name(link, 1) for link in ("a b", "a_b", "a/b", "a-b", "a.b", "a.20.b")}) == 6
    robot = ROBOTS["ur5"]()
    first, second = robot.links[3].name, robot.links[4].name
    alike = renamed(robot, {first: "arm_1", second: "arm/1"})
    found = read_collision_vertices(written(alike, tmp_path) / "robot.urdf")
    assert not np.array_equal(found["arm_1"], found["arm/1"])


def test_a_folder_is_replaced_whole_or_not_at_all(tmp_path: Path) -> None:
    robot = ROBOTS["ur5_suction"]()
    out = written(robot, tmp_path)
    (out / "extra").write_text("old")
    before = {file.name: file.read_bytes() for file in out.iterdir() if file.is_file()}

    def full(*_: object) -> str:
        raise OSError(28, "No space left on device")

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(write, "yaml_text", full)  # the last of the files
        with pytest.raises(InputError, match="No space left"):
            written(robot, tmp_path)
    assert {f.name: f.read_bytes() for f in out.iterdir() if f.is_file()} == before
    assert os.listdir(tmp_path) == [out.name]

    written(robot, tmp_path)
    assert not (out / "extra").exists()
    assert os.listdir(tmp_path) == [out.name]
