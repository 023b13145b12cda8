"""Links that are left out of a robot, with all that hangs on them but its arm."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tamp.commands.robot_folder.description import read_description
from tamp.commands.robot_folder.left_out import description_for, left_out
from tamp.commands.robot_folder.wanted import Wanted
from tamp.errors import InputError
from tests.commands.robot_folder.urdf import two_armed


@pytest.fixture
def two(tmp_path: Path) -> Path:
    file = tmp_path / "two.urdf"
    file.write_text(two_armed(), encoding="utf-8")
    return file


def test_the_arm_itself_is_never_left_out(two: Path) -> None:
    description = read_description(two)
    gone = left_out(description, ("body",), "body", "l_tool")
    assert {"body", "l_foot", "r_foot", "r_tool"} <= gone
    assert not {"l_pan_link", "l_wrist3_link", "l_tool"} & gone
    with pytest.raises(InputError, match=r"--without: unknown link 'bodi'.*Did you mean 'body'"):
        left_out(description, ("bodi",), "body", "l_tool")


def test_what_is_left_out_has_neither_shapes_nor_mass(two: Path) -> None:
    wanted = Wanted(two, "l_tool", Path("out"), base="body")
    whole = description_for(wanted)
    assert all(whole.links[name] and whole.masses[name] == 1.5 for name in ("l_foot", "r_foot"))
    left = description_for(replace(wanted, without=("r_foot",)))
    assert left.links["r_foot"] == left.links["r_wrist3_link"] == ()
    assert left.masses["r_foot"] == left.masses["r_wrist3_link"] == 0.0
    assert left.links["body"] == whole.links["body"] and left.masses["body"] == 30.0
    assert left.links["l_pan_link"] == whole.links["l_pan_link"]
    assert left.joints == whole.joints
