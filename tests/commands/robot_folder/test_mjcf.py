"""MJCF as input: the same frames as MuJoCo's, and a robot's folder from it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tamp.commands.robot import main
from tamp.commands.robot_folder.arm import find_arm
from tamp.commands.robot_folder.check import against_urdf
from tamp.commands.robot_folder.convex import solids
from tamp.commands.robot_folder.description import read_description
from tamp.commands.robot_folder.ends import choose_end
from tamp.commands.robot_folder.mjcf import as_urdf
from tamp.errors import InputError
from tamp.geometric.loading.robot_folder import read_robot
from tamp.geometric.robot.kinematics import Kinematics
from tamp.simulation.mujoco_model import load_mujoco

MUJOCO: Any = load_mujoco()
ARM = """
<mujoco model="six">
  <compiler angle="degree" autolimits="true"/>
  <default><geom density="1000"/><joint range="-175 175"/></default>
  <asset><mesh name="wedge" vertex="0 0 0  .1 0 0  0 .05 0  0 0 .3"/></asset>
  <worldbody>
    <geom type="plane" size="5 5 .1"/>
    <body name="foot">
      <geom type="box" size=".06 .06 .05" pos="0 0 .05"/>
      <body name="pan_link" pos="0 0 .1" euler="0 0 45">
        <joint name="pan" axis="0 0 1"/>
        <geom type="cylinder" size=".05 .04"/>
        <body name="upper" pos="0 .1 .06">
          <joint name="lift" axis="0 1 0" pos="0 0 .01"/>
          <geom type="capsule" size=".04 .12" pos="0 0 .2"/>
          <body name="fore" pos="0 -.1 .4" euler="0 10 0">
            <joint name="elbow" axis="0 1 0" ref="10"/>
            <geom type="mesh" mesh="wedge"/>
            <geom type="sphere" size=".5" contype="0" conaffinity="0"/>
            <body name="wrist" pos="0 0 .35">
              <joint name="wrist1" axis="0 1 0" pos="0 .01 0"/>
              <joint name="wrist2" axis="0 0 1" pos="0 .05 0" actuatorfrcrange="-9 9"/>
              <geom type="ellipsoid" size=".03 .03 .05" pos="0 .05 0"/>
              <body name="last" pos="0 .1 .1">
                <joint name="wrist3" axis="0 1 0" limited="false"/>
                <geom type="box" size=".02 .02 .02" pos="0 .02 0"/>
                <site name="attachment_site" pos="0 .06 0" euler="-90 0 0"/>
              </body>
            </body>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator><motor joint="pan" gear="50" ctrllimited="false" forcerange="-2 2"/></actuator>
</mujoco>
"""


@pytest.fixture
def six(tmp_path: Path) -> Path:
    file = tmp_path / "six.xml"
    file.write_text(ARM, encoding="utf-8")
    return file


def test_joints_limits_and_efforts_are_read(six: Path, tmp_path: Path) -> None:
    description = read_description(as_urdf(six, tmp_path))
    kinds = {
        name: joint.kind for name, joint in description.joints.items() if joint.kind != "fixed"
    }
    assert kinds == dict.fromkeys(["pan", "lift", "elbow", "wrist1", "wrist2"], "revolute") | {
        "wrist3": "continuous"
    }
    elbow = description.joints["elbow"]
    # where the file draws it is 0: its own zero is 10 degrees away
    assert np.degrees([elbow.lower, elbow.upper]) == pytest.approx([-185.0, 165.0])
    assert description.efforts["pan"] == pytest.approx(100.0)
    assert description.efforts["wrist2"] == pytest.approx(9.0)
    end = choose_end(description)
    assert (end.tip, end.joints, end.fingers) == ("attachment_site", 6, None)


def test_what_cannot_collide_and_the_floor_are_left_out(six: Path, tmp_path: Path) -> None:
    description = read_description(as_urdf(six, tmp_path))
    counts = {name: len(some) for name, some in description.links.items() if some}
    assert counts == {"foot": 1, "pan_link": 1, "upper": 1, "fore": 1, "wrist": 1, "last": 1}
    wedge = solids(description.links["fore"], "fore")[0]
    assert np.ptp(wedge.vertices, axis=0) == pytest.approx([0.1, 0.05, 0.3], abs=2e-6)


def test_frames_and_shapes_are_where_mujoco_has_them(six: Path, tmp_path: Path) -> None:
    description = read_description(as_urdf(six, tmp_path))
    arm = find_arm(description, "world", "attachment_site", {})
    model = MUJOCO.MjModel.from_xml_path(str(six))
    data, rng = MUJOCO.MjData(model), np.random.default_rng(0)
    wedge = solids(arm.groups[3].elements, "fore")[0].vertices.mean(axis=0)
    for _ in range(20):
        q = rng.uniform(-2.0, 2.0, 6)
        data.qpos[:] = model.qpos0 + q
        MUJOCO.mj_kinematics(model, data)
        T = np.eye(4)
        for number, (joint, value) in enumerate(zip(arm.joints, q, strict=True), start=1):
            turn = np.eye(4)
            turn[:2, :2] = [[np.cos(value), -np.sin(value)], [np.sin(value), np.cos(value)]]
            T = T @ joint.origin.matrix @ turn
            if number == 3:
                geom = next(
                    g
                    for g in range(model.ngeom)
                    if model.geom_type[g] == MUJOCO.mjtGeom.mjGEOM_MESH
                )
                vertices = model.mesh_vert.mean(axis=0)
                theirs = data.geom_xmat[geom].reshape(3, 3) @ vertices + data.geom_xpos[geom]
                assert T[:3, :3] @ wedge + T[:3, 3] == pytest.approx(theirs, abs=2e-6)
        tip = T @ arm.T_last_tip.matrix
        assert tip[:3, 3] == pytest.approx(data.site("attachment_site").xpos, abs=2e-6)
        assert tip[:3, :3].ravel() == pytest.approx(data.site("attachment_site").xmat, abs=2e-6)


def test_a_folder_is_made_from_it(six: Path, tmp_path: Path, quick: None) -> None:
    out = tmp_path / "robots" / "six"
    assert main(["make", str(six), "--out", str(out), "--base", "differential", "--quiet"]) == 0
    robot = read_robot(out)
    assert [joint.name for joint in robot.joints] == [
        "pan", "lift", "elbow", "wrist1", "wrist2", "wrist3",
    ]  # fmt: skip
    assert np.isfinite(Kinematics(robot).arm_tool(np.array(robot.home))).all()


def test_fingers_that_an_equality_couples_are_found(tmp_path: Path) -> None:
    fingers = "".join(
        f'<body name="{side}" pos="0 .06 0"><joint name="{side}_finger" type="slide" axis="{sign} 0 0" range="0 .04"/>'
        f'<geom type="box" size=".005 .02 .01" pos="{sign * 0.005} .02 0"/></body>'
        for side, sign in (("left", 1), ("right", -1))
    )
    text = ARM.replace(
        '<site name="attachment_site"', f'{fingers}<site name="attachment_site"'
    ).replace(
        "</mujoco>",
        '<equality><joint joint1="right_finger" joint2="left_finger"/></equality></mujoco>',
    )
    (tmp_path / "hand.xml").write_text(text, encoding="utf-8")
    description = read_description(as_urdf(tmp_path / "hand.xml", tmp_path))
    assert description.mimics == {"right_finger": ("left_finger", 1.0, 0.0)}
    end = choose_end(description)
    assert (end.tip, end.fingers) == ("last", ("left_finger", "right_finger"))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (ARM.replace('mesh="wedge"/>', 'mesh="wedg"/>'), r"MuJoCo refuses it.*wedg"),
        ("<mujocoinclude/>", r"a part of an MJCF"),
        ("<sdf/>", r"neither a URDF nor an MJCF"),
        (ARM.replace("</mujoco>", ""), r"cannot read"),
    ],
)
def test_a_bad_mjcf_is_one_clear_error(tmp_path: Path, text: str, says: str) -> None:
    file = tmp_path / "bad.xml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=says) as refused:
        as_urdf(file, tmp_path)
    assert "\n" not in str(refused.value)


def test_pinocchio_reads_a_urdf_whose_limits_say_no_effort(tmp_path: Path, driving: Path) -> None:
    text = (driving.parent / "arm.urdf").read_text(encoding="utf-8")
    file = tmp_path / "arm.urdf"
    file.write_text(text.replace(' velocity="2" effort="2000"', ""), encoding="utf-8")
    description = read_description(file)
    arm = find_arm(description, "foot", "tool", {})
    assert against_urdf(read_robot(driving), description, arm, "tool") < 2e-5
