"""What an SRDF says, proposes, and what of it is not taken."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import yaml

from tamp.commands.robot import main  # pyright: ignore[reportPrivateUsage]
from tamp.commands.robot_folder.description import read_description
from tamp.commands.robot_folder.srdf import read_srdf
from tamp.commands.robot_folder.srdf_search import srdf_for
from tamp.geometric.loading.robot_folder import read_robot
from tests.commands.robot_folder.srdf_files import (
    ARM,
    UPRIGHT,
    off,
    read,
    state,
    write,
)
from tests.commands.robot_folder.urdf import arm_text


def test_lines_are_those_of_the_file_whatever_comes_before(tmp_path: Path) -> None:
    text = f'\n\n<?xml version="1.0"?>\n<!-- a\nb -->\n<robot\n name="boxes">\n\n{ARM}\n</robot>'
    (tmp_path / "arm.urdf").write_text(arm_text(), encoding="utf-8")
    (tmp_path / "arm.srdf").write_text(text, encoding="utf-8")
    srdf = read_srdf(tmp_path / "arm.srdf", read_description(tmp_path / "arm.urdf"))
    assert text.splitlines()[srdf.groups["arm"].line - 1] == ARM


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
