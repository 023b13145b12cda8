"""What an SRDF answers and proposes, and what of it is not taken."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml

from tamp.commands.robot import Make, _wanted, main  # pyright: ignore[reportPrivateUsage]
from tamp.commands.robot_folder.description import read_description
from tamp.commands.robot_folder.srdf import Srdf, read_srdf
from tamp.commands.robot_folder.srdf_arm import arm_groups
from tamp.commands.robot_folder.srdf_search import srdf_for
from tamp.commands.robot_folder.wanted import Wanted
from tamp.errors import InputError
from tamp.geometric.loading.robot_folder import read_robot
from tests.commands.robot_folder.test_ends import HAND, fingers
from tests.commands.robot_folder.urdf import arm_text

HEAD = """
<link name="neck"/><link name="eyes"/>
<joint name="nod" type="revolute"><parent link="foot"/><child link="neck"/><limit lower="-1" upper="1"/></joint>
<joint name="look" type="revolute"><parent link="neck"/><child link="eyes"/><limit lower="-1" upper="1"/></joint>
"""
JOINTS = ("pan", "lift", "elbow", "wrist1", "wrist2", "wrist3")
ARM = """<group name="arm"><chain base_link="foot" tip_link="tool"/></group>"""
GRIPPER = """<group name="hand"><link name="hand"/><joint name="left_finger_joint"/></group>
<end_effector name="gripper" parent_link="tool" group="hand"/>"""
MIMIC = '<mimic joint="left_finger_joint"/>'
UPRIGHT = (0.0, -0.8, 1.9, 0.45, 0.0, 0.0)
"""A configuration of the arm of boxes in which it may drive."""


def state(name: str, values: dict[str, float] | tuple[float, ...]) -> str:
    """Write a state of the arm."""
    named = values if isinstance(values, dict) else dict(zip(JOINTS, values, strict=True))
    inside = "".join(f'<joint name="{joint}" value="{value}"/>' for joint, value in named.items())
    return f'<group_state name="{name}" group="arm">{inside}</group_state>'


def off(first: str, second: str, reason: str = "Never") -> str:
    """Write a pair that is not to be checked."""
    return f'<disable_collisions link1="{first}" link2="{second}" reason="{reason}"/>'


def write(folder: Path, srdf: str, urdf: str, name: str = "arm.srdf", robot: str = "boxes") -> Path:
    """Write the arm and an SRDF beside it, whose first entry is on its second line; return the
    arm's file.
    """
    (folder / "arm.urdf").write_text(urdf, encoding="utf-8")
    file = folder / name
    file.parent.mkdir(exist_ok=True)
    file.write_text(f'<robot name="{robot}">\n{srdf}\n</robot>\n', encoding="utf-8")
    return folder / "arm.urdf"


def settled(folder: Path, srdf: str, urdf: str, **options: object) -> Wanted:
    """Settle the choices for an arm with an SRDF beside it."""
    file = write(folder, srdf, urdf)
    return _wanted(replace(Make(str(file), folder / "out"), **options), file)


def read(folder: Path, srdf: str, urdf: str | None = None) -> Srdf:
    """Read an SRDF of the arm."""
    file = write(folder, srdf, urdf or arm_text())
    return read_srdf(folder / "arm.srdf", read_description(file))


def test_a_group_that_is_a_chain_says_which_is_the_arm(tmp_path: Path) -> None:
    wanted = settled(tmp_path, ARM, arm_text(extra=HEAD))
    assert (wanted.base, wanted.tip) == ("foot", "tool")
    assert any("arm.srdf:2's group 'arm': --arm foot tool" in one for one in wanted.remarks)


@pytest.mark.parametrize(
    "group",
    [
        "".join(f'<joint name="{name}"/>' for name in reversed(JOINTS)),
        "".join(f'<link name="{name}_link"/>' for name in JOINTS),
        '<group name="low"/><group name="high"/>',
    ],
    ids=["joints", "links", "groups"],
)
def test_a_group_of_joints_links_or_groups_is_a_chain_as_well(tmp_path: Path, group: str) -> None:
    low = "".join(f'<joint name="{name}"/>' for name in JOINTS[:1])
    high = "".join(f'<joint name="{name}"/>' for name in JOINTS[1:])
    parts = f'<group name="low">{low}</group><group name="high">{high}<group name="high"/></group>'
    srdf = read(tmp_path, f'{parts}<group name="all">{group}</group>', arm_text(extra=HEAD))
    found = {
        arm.group.name: arm for arm in arm_groups(srdf, read_description(tmp_path / "arm.urdf"))
    }
    assert found["all"].joints == JOINTS
    assert (found["all"].base, found["all"].tip) == ("foot", "wrist3_link")


def test_a_finger_at_the_end_of_a_chain_is_no_joint_of_the_arm(tmp_path: Path) -> None:
    urdf = arm_text(extra=HEAD + HAND + fingers("revolute"))
    group = ARM.replace('"tool"', '"left_finger"')
    wanted = settled(tmp_path, group, urdf)
    assert (wanted.base, wanted.tip) == ("foot", "tool")
    (arm,) = arm_groups(
        read_srdf(tmp_path / "arm.srdf", read_description(tmp_path / "arm.urdf")),
        read_description(tmp_path / "arm.urdf"),
    )
    assert arm.joints == JOINTS


def test_of_nested_groups_the_longest_is_the_arm(tmp_path: Path) -> None:
    short = '<group name="arm"><chain base_link="pan_link" tip_link="tool"/></group>'
    long = ARM.replace('"arm"', '"arm_and_torso"')
    assert settled(tmp_path, short, arm_text(extra=HEAD)).base == "pan_link"
    assert settled(tmp_path, short + long, arm_text(extra=HEAD)).base == "foot"


def test_an_arm_with_a_hand_or_an_arms_name_comes_before_a_head(tmp_path: Path) -> None:
    head = '<group name="head"><joint name="nod"/><joint name="look"/></group>'
    urdf = arm_text(extra=HEAD)
    assert settled(tmp_path, head + ARM, urdf).tip == "tool"
    with pytest.raises(InputError, match=r"2 groups that may be the arm.*foot eyes \(head\)"):
        settled(tmp_path, ARM.replace('"arm"', '"chain"') + head, urdf)
    urdf = arm_text(extra=HEAD + HAND + fingers("prismatic"))
    assert settled(tmp_path, ARM.replace('"arm"', '"a"') + head + GRIPPER, urdf).tip == "tool"


def test_a_group_that_is_a_head_is_no_arm_and_hides_none(tmp_path: Path) -> None:
    head = '<group name="head"><joint name="nod"/><joint name="look"/></group>'
    with pytest.raises(
        InputError, match=r"1 group that may.*--arm foot eyes \(head\), --arm foot tool"
    ):
        settled(tmp_path, head, arm_text(extra=HEAD))
    longest = ARM.replace('"arm"', '"chain"')
    assert settled(tmp_path, longest, arm_text(extra=HEAD)).tip == "tool"


def test_the_end_effector_says_which_is_the_gripper(tmp_path: Path) -> None:
    urdf = arm_text(extra=HAND + fingers("prismatic", mimic=MIMIC))
    arm = ("foot", "tool")
    wanted = settled(tmp_path, GRIPPER, urdf, arm=arm)
    assert wanted.fingers == ("left_finger_joint", "right_finger_joint")
    assert any("end effector 'gripper'" in one for one in wanted.remarks)
    assert settled(tmp_path, "", urdf, arm=arm).fingers is None
    assert settled(tmp_path, GRIPPER, urdf, arm=arm, axis="z").fingers is None
    assert settled(tmp_path, GRIPPER, urdf, arm=arm, suction=0.02).fingers is None


def test_lines_are_those_of_the_file_whatever_comes_before(tmp_path: Path) -> None:
    text = f'\n\n<?xml version="1.0"?>\n<!-- a\nb -->\n<robot\n name="boxes">\n\n{ARM}\n</robot>'
    (tmp_path / "arm.urdf").write_text(arm_text(), encoding="utf-8")
    (tmp_path / "arm.srdf").write_text(text, encoding="utf-8")
    srdf = read_srdf(tmp_path / "arm.srdf", read_description(tmp_path / "arm.urdf"))
    assert text.splitlines()[srdf.groups["arm"].line - 1] == ARM


@pytest.mark.parametrize("name", ["arm.srdf", "other.srdf", "config/x.srdf", "srdf/x.srdf"])
def test_it_is_found_beside_the_urdf(tmp_path: Path, name: str) -> None:
    file = write(tmp_path, ARM, arm_text(), name)
    found, remarks = srdf_for(read_description(file), None, file)
    assert found is not None and found.file == tmp_path / name
    assert remarks == (f"{tmp_path / name} is read, too",)


def test_it_is_found_in_the_package_of_moveits_settings(tmp_path: Path) -> None:
    urdf = tmp_path / "boxes_description" / "urdf" / "arm.urdf"
    srdf = tmp_path / "boxes_moveit_config" / "config" / "boxes.srdf"
    for file, text in ((urdf, arm_text()), (srdf, f'<robot name="boxes">{ARM}</robot>')):
        file.parent.mkdir(parents=True)
        file.write_text(text, encoding="utf-8")
    found, _ = srdf_for(read_description(urdf), None, urdf)
    assert found is not None and found.file == srdf


def test_of_several_the_one_of_the_robots_name_is_read_then_that_of_the_files(
    tmp_path: Path,
) -> None:
    file = write(tmp_path, ARM, arm_text(), "a.srdf", robot="spheres")
    description = read_description(file)
    found, remarks = srdf_for(description, None, file)
    assert found is None and "only a.srdf (for 'spheres'): --srdf takes one" in remarks[0]
    write(tmp_path, ARM, arm_text(), "b.srdf")
    found, _ = srdf_for(description, None, file)
    assert found is not None and found.file.name == "b.srdf"
    write(tmp_path, ARM, arm_text(), "c.srdf")
    found, remarks = srdf_for(description, None, file)
    assert found is None and "several SRDFs are for 'boxes'" in remarks[0]
    write(tmp_path, ARM, arm_text())
    found, _ = srdf_for(description, None, file)
    assert found is not None and found.file.name == "arm.srdf"


def test_what_the_urdf_has_not_is_left_out_and_said(tmp_path: Path) -> None:
    entries = f'{ARM}\n{off("foot", "tail")}\n<group name="leg"><joint name="knee"/></group>'
    srdf = read(tmp_path, entries)
    assert not srdf.disabled and srdf.groups["leg"].joints == ()
    assert srdf.remarks == (
        "arm.srdf: what the URDF does not have is left out: link 'tail' (line 3), joint 'knee' (line 4)",
    )


def test_a_name_of_another_robot_and_a_chain_that_is_none_are_said(tmp_path: Path) -> None:
    file = write(
        tmp_path, '<group name="arm"><chain base_link="tool" tip_link="foot"/></group>', arm_text(),
        robot="spheres",
    )  # fmt: skip
    found, remarks = srdf_for(read_description(file), tmp_path / "arm.srdf", file)
    assert found is not None and found.groups["arm"].chains == ()
    assert remarks == (
        "arm.srdf:1 is for the robot 'spheres', the URDF for 'boxes'",
        "arm.srdf:2: the group 'arm' is no chain: 'foot' does not hang on 'tool'",
    )


BROKEN = {
    "no-xml": ("<robot", r"arm.srdf: .*line 1"),
    "a-urdf": (arm_text(), r"arm.srdf:1: not an SRDF: a URDF"),
    "other-root": ("\n<sdf/>", r"arm.srdf:2: not an SRDF: its root is <sdf>"),
    "no-number": (f'<robot name="boxes">\n{state("home", {"pan": 0})}</robot>'.replace('"0"', '"up"'),
                  r"arm.srdf:2: joint 'pan': its value 'up' is no number"),
    "infinite": (f'<robot name="boxes">\n{state("home", {"pan": np.inf})}</robot>', r"'inf' is no number"),
    "other-robot": (
        f'<robot name="boxes">\n{"".join(off(f"a{n}", f"b{n}") for n in range(3))}</robot>',
        r"arm.srdf:2: it is of another robot: the URDF has no link 'a0'",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_one_is_an_error_where_it_was_named_and_a_sentence_where_it_was_found(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text, says = BROKEN[name]
    (tmp_path / "arm.urdf").write_text(arm_text(), encoding="utf-8")
    (tmp_path / "arm.srdf").write_text(text, encoding="utf-8")
    words = ["make", str(tmp_path / "arm.urdf"), "--out", str(tmp_path / "out"), "--quiet"]
    assert main([*words, "--srdf", str(tmp_path / "arm.srdf")]) == 2
    error = capsys.readouterr().err
    assert re.search(says, error) and error.count("\n") == 1, error

    urdf = tmp_path / "arm.urdf"
    found, remarks = srdf_for(read_description(urdf), None, urdf)
    assert found is None and len(remarks) == 1
    assert remarks[0].endswith(": not read") and re.search(says, remarks[0])


@pytest.fixture(scope="module")
def made(quick: None, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """Make the arm with an SRDF that proposes homes and pairs; return its folder and what was said."""
    folder = tmp_path_factory.mktemp("srdf")
    entries = [
        state("home", (0.0, 1.57, 0.0, 0.0, 0.0, 0.0)), state("Ready", UPRIGHT), state("half_sitting", {"pan": 1.0}),
        off("foot", "wrist2_link"), off("pan_link", "lift_link", "Adjacent"), off("foot", "lift_link"),
        '<disable_default_collisions link="wrist3_link"/>', '<enable_collisions link1="foot" link2="wrist3_link"/>',
    ]  # fmt: skip
    urdf = write(folder, "\n".join(entries), arm_text())
    with pytest.MonkeyPatch.context() as patch:
        said: list[str] = []
        patch.setattr("tamp.commands.robot.say", said.append)
        assert main(["make", str(urdf), "--out", str(folder / "boxes"), "--quiet"]) == 0
    return folder / "boxes", "\n".join(said)


def test_the_first_state_in_which_it_may_drive_is_home(made: tuple[Path, str]) -> None:
    folder, said = made
    assert read_robot(folder).home == UPRIGHT
    assert "arm.srdf:2's state 'home' is not taken for home" in said
    assert "home is arm.srdf:3's state 'Ready'" in said


def test_pairs_that_meet_are_checked_whatever_the_srdf_says(made: tuple[Path, str]) -> None:
    folder, said = made
    allowed = read_robot(folder).allowed
    assert ("foot", "wrist2_link") not in allowed and ("lift_link", "pan_link") in allowed
    assert re.search(
        r"arm.srdf:5 disables foot and wrist2_link \(Never\), which meet in 1\.\d % of states", said
    )
    assert "disables lift_link and pan_link" not in said
    assert "arm.srdf:8 disables pan_link and wrist3_link (default)" in said
    assert "disables foot and wrist3_link" not in said


def test_the_folder_says_which_srdf_it_was_made_with(made: tuple[Path, str]) -> None:
    folder, said = made
    file = str(folder.parent / "arm.srdf")
    assert yaml.safe_load((folder / "robot.yaml").read_text())["srdf"] == file
    assert f"{file} is read, too" in said
