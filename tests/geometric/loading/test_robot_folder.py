"""A robot's folder as it is read: limits with margins, hulls, allowed pairs, arms of others; or one clear error."""

from __future__ import annotations

import math
import shutil
from pathlib import Path

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.geometric.loading.robot_folder import FULL_TURN, read_robot
from tamp.geometric.loading.robots import ASSETS
from tamp.geometric.robot.robot import LIMIT_MARGIN_RAD, Robot
from tamp.geometric.scene.scene import Box

GOOD = (ASSETS / "two_pandas" / "robot.yaml").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("was", "becomes", "message"),
    [
        ("robot: panda_fixed", "robot: no_such_robot", "no robot's folder 'no_such_robot'"),
        (
            "robot: panda_fixed",
            "robot: two_pandas",
            "the robot 'two_pandas' has several arms itself",
        ),
        ("  left:", "  Left:", "'Left' is no name of an arm"),
        ("  left:", "  right:", "right"),
        ("drive: fixed", "drive: hovering", "unknown drive 'hovering'"),
        (
            "quaternion: [0.0, 0.0, 0.0, 1.0]",
            "quaternion: [0.0, 0.0, 0.0, 2.0]",
            "its norm is not 1",
        ),
        ("arms:", "arms: {}\nothers:", "others"),
    ],
)
def test_bad_arms_are_refused_with_the_reason(
    was: str, becomes: str, message: str, tmp_path: Path
) -> None:
    assert was in GOOD
    (tmp_path / "robot.yaml").write_text(GOOD.replace(was, becomes), encoding="utf-8")
    with pytest.raises(InputError, match=message) as error:
        read_robot(tmp_path)
    assert "robot.yaml" in str(error.value)


def test_one_arm_is_no_body_of_several(tmp_path: Path) -> None:
    text = GOOD[: GOOD.index("  right:")]
    (tmp_path / "robot.yaml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="several arms are at least two"):
        read_robot(tmp_path)


def test_a_shipped_robots_arm_is_found_by_its_name(tmp_path: Path) -> None:
    text = GOOD.replace("robot: panda_fixed", "robot: xarm7")
    (tmp_path / "robot.yaml").write_text(text, encoding="utf-8")
    made = read_robot(tmp_path)
    assert [arm.arm for arm in made.arms] == ["left", "right"]
    assert all(link.name.startswith(("pedestal", "left_", "right_")) for link in made.links)
    assert {file.parent.name for file in made.files} == {tmp_path.name, "xarm7"}


def changed(folder: Path, *changes: tuple[str, str]) -> Path:
    """A copy of the folder of ur5, each change of its file made once."""
    folder = folder / "mine"
    shutil.copytree(ASSETS / "ur5", folder)
    text = (folder / "robot.yaml").read_text(encoding="utf-8")
    for was, becomes in changes:
        assert was in text
        text = text.replace(was, becomes, 1)
    (folder / "robot.yaml").write_text(text, encoding="utf-8")
    return folder


def read(folder: Path, *changes: tuple[str, str]) -> Robot:
    return read_robot(changed(folder, *changes))


PAN = "kind: revolute\n      origin: {xyz: [0.0, 0.0, 0.089159]"
RANGE = "range: [-3.14159265359, 3.14159265359]"
"""Of the elbow, the third joint."""


def test_limits_keep_a_margin_and_a_joint_that_turns_on_has_a_turn_to_either_side(
    tmp_path: Path,
) -> None:
    robot = read(
        tmp_path, (PAN, PAN.replace("revolute", "continuous")), (RANGE, "range: [-1.0, 2.0]")
    )
    assert (
        (robot.lower[0], robot.upper[0]) == (-2 * math.pi, 2 * math.pi) == (-FULL_TURN, FULL_TURN)
    )
    assert (robot.lower[2], robot.upper[2]) == (-1.0 + LIMIT_MARGIN_RAD, 2.0 - LIMIT_MARGIN_RAD)
    assert (robot.joints[2].lower, robot.joints[2].upper) == (-1.0, 2.0)


def test_a_slide_has_a_tenth_of_the_margin_in_metres(tmp_path: Path) -> None:
    kind = (PAN, PAN.replace("revolute", "prismatic"))
    at_home = ("home: [-0.359936", "home: [0.1")
    wide = ("range: [-6.28318530718, 6.28318530718]", "range: [0.0, 0.4]")
    robot = read(tmp_path, kind, at_home, wide)
    assert robot.prismatic == (True, *(False,) * 5)
    margin = LIMIT_MARGIN_RAD / 10
    assert (robot.lower[0], robot.upper[0]) == pytest.approx((margin, 0.4 - margin), abs=1e-12)


def test_what_the_file_says_and_what_it_leaves_out(tmp_path: Path) -> None:
    robot = read(tmp_path, ("  foot:", "  payload: 4.5\n  locked_joint: elbow_joint\n  foot:"))
    assert (robot.payload, robot.locked) == (4.5, 2)
    assert (robot.name, robot.drive, robot.turning_radius) == ("mine", "differential", None)
    assert robot.velocity[:4] == (0.6, 0.6, 1.0, 3.15) and len(robot.velocity) == 9
    assert robot.effort == (150.0, 150.0, 150.0, 28.0, 28.0, 28.0)
    (base,) = robot.links[0].parts
    assert base.shape == Box((0.8, 0.7, 0.33)) and base.pose.position == (0.0, 0.0, 0.185)
    assert robot.urdf == tmp_path / "mine" / "robot.urdf"
    plain = read_robot(ASSETS / "ur5")
    assert (plain.payload, plain.locked) == (math.inf, None)


def test_the_first_of_a_line_of_allowed_pairs_goes_with_each_other(tmp_path: Path) -> None:
    text = (ASSETS / "ur5" / "robot.yaml").read_text(encoding="utf-8")
    lines = "allowed:\n  - base_link base upper_arm_link\n  - [forearm_link, base]\n"
    robot = read(tmp_path, (text[text.index("allowed:") :], lines))
    assert robot.allowed == {
        ("base", "base_link"), ("base_link", "upper_arm_link"), ("base", "forearm_link"),
    }  # fmt: skip


@pytest.mark.parametrize(
    ("was", "becomes", "message"),
    [
        ("version: 1", "version: 2", "version 2 of a robot's folder is not known, only 1"),
        ("version: 1\n", "", "version none of a robot"),
        ("format: tamp-robot", "format: robot", "it does not say 'format: tamp-robot'"),
        ("home: [-0.359936", "home: [6.28", r"shoulder_pan_joint = 6.28 is not within"),
        (RANGE, "range: [1.0, 1.0]", "the lower limit 1 is not below the upper 1"),
        (RANGE, f"range: [0.0, {1.9 * LIMIT_MARGIN_RAD}]", "is not below the upper"),
        ("kind: revolute", "kind: floating", "unknown kind of joint 'floating'"),
        ("link: forearm_link", "link: shoulder_link", "have a link of one name"),
        ("  link: base\n", "  link: base_link\n", "have a link of one name"),
        ("link: forearm_link", "link: forarm_link", "has hulls of 'forearm_link', which is no link"),
        ("  foot:", "  locked_joint: knee\n  foot:", "unknown joint 'knee'"),
        ("  foot:", "  payload: -1.0\n  foot:", "payload"),
        ("urdf: robot.urdf", "urdf: pybullet_data/no/such.urdf", "needs pybullet_data/no/such.urdf"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_one_clear_error(
    was: str, becomes: str, message: str, tmp_path: Path
) -> None:
    if "forarm" in becomes:  # or an allowed pair would be refused first
        text = (ASSETS / "ur5" / "robot.yaml").read_text(encoding="utf-8")
        folder = changed(tmp_path, (text[text.index("allowed:") :], ""), (was, becomes))
    else:
        folder = changed(tmp_path, (was, becomes))
    with pytest.raises(InputError, match=message) as said:
        read_robot(folder)
    assert "mine" in str(said.value) and "\n" not in str(said.value)


def test_an_arm_without_joints_is_refused(tmp_path: Path) -> None:
    text = (ASSETS / "ur5" / "robot.yaml").read_text(encoding="utf-8")
    joints = text[text.index("  joints:\n") : text.index("gripper:")]
    with pytest.raises(InputError, match="an arm needs a joint"):
        read(tmp_path, (joints, "  joints: {}\n"))


@pytest.mark.parametrize("name", ["robot.yaml", "geometry.npz"])
def test_a_file_that_is_missing_is_named(name: str, tmp_path: Path) -> None:
    folder = changed(tmp_path)
    (folder / name).unlink()
    with pytest.raises(InputError, match=f"no robot: {name} is missing"):
        read_robot(folder)


def test_hulls_are_each_links_own_in_their_order(tmp_path: Path) -> None:
    folder = changed(tmp_path)
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    arrays = {
        "forearm_link/0/vertices": corners, "forearm_link/0/faces": faces,
        "base_link/0/vertices": 0.1 * corners, "base_link/0/faces": faces,
        "forearm_link/1/vertices": 2 * corners, "forearm_link/1/faces": faces,
    }  # fmt: skip
    np.savez(folder / "geometry.npz", **arrays)
    robot = read_robot(folder)
    forearm = robot.link("forearm_link").parts
    assert [part.shape.vertices.max() for part in forearm] == [1.0, 2.0]  # type: ignore[union-attr]
    assert len(robot.link("base_link").parts) == 1 and robot.link("upper_arm_link").parts == ()
    arrays["forearm_link/1/faces"] = faces + 1
    np.savez(folder / "geometry.npz", **arrays)
    with pytest.raises(InputError, match="'forearm_link/1/faces' names vertices that are not"):
        read_robot(folder)


def test_a_description_lies_in_the_folder_or_in_an_installed_package(tmp_path: Path) -> None:
    folder = changed(
        tmp_path, ("urdf: robot.urdf", "urdf: tamp/geometric/robot/assets/ur5/robot.urdf")
    )
    assert read_robot(folder).urdf == ASSETS / "ur5" / "robot.urdf"
    (folder / "robot.yaml").write_text(
        (folder / "robot.yaml").read_text().replace("urdf: tamp/", "urdf: pybullet_data/"), "utf-8"
    )
    with pytest.raises(InputError, match="needs pybullet_data/geometric") as said:
        read_robot(folder)
    assert said.value.remedy == "pip install pybullet"


def test_an_arms_folder_is_looked_for_beside_before_among_the_shipped(tmp_path: Path) -> None:
    own = changed(tmp_path)
    own.rename(tmp_path / "panda_fixed")
    both = tmp_path / "both"
    both.mkdir()
    text = GOOD.replace("robot: panda_fixed", "robot: ../panda_fixed", 1)
    (both / "robot.yaml").write_text(text, encoding="utf-8")
    left, right = read_robot(both).arms
    assert (len(left.joints), len(right.joints)) == (6, 7)
