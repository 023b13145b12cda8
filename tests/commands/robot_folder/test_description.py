"""What a URDF rounds is made exact, and what it cannot say is found otherwise."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from tamp.commands.robot_folder.description import find_urdf, read_description
from tamp.errors import InputError
from tests.commands.robot_folder.urdf import arm_text


@pytest.mark.parametrize(
    ("rpy", "exact"),
    [
        ("1.5708 0 3.14159", (np.pi / 2, 0.0, np.pi)),
        ("1.5708 0.0486795 3.14159", (np.pi / 2, 0.0486795, np.pi)),
        ("0.01 0.02 -1.5707", (0.01, 0.02, -np.pi / 2)),
        ("0.7853 0.3 0.3", (np.pi / 4, 0.3, 0.3)),
        ("0.79 0.3 0.3", (0.79, 0.3, 0.3)),
    ],
)
def test_each_right_angle_is_made_exact_by_itself(tmp_path: Path, rpy: str, exact) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text(arm_text().replace('rpy="-1.5708 0 0"', f'rpy="{rpy}"'), encoding="utf-8")
    R = read_description(file).joints["tool_joint"].origin.rotation
    a, b, c = exact
    x, y, z = (
        np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]]),
        np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]]),
        np.array([[np.cos(c), -np.sin(c), 0], [np.sin(c), np.cos(c), 0], [0, 0, 1]]),
    )
    assert np.abs(R - z @ y @ x).max() < 1e-12


def test_where_pybullet_is_missing_its_files_are_named_as_what_is_missing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, "pybullet_data", None)
    with pytest.raises(InputError, match="pybullet_data is not installed") as said:
        find_urdf("pybullet_data/kuka_iiwa/model.urdf")
    assert "Python 3.11" in said.value.remedy


def test_elements_of_a_simulator_need_no_declaration(described) -> None:
    text = '<link name="pad"><drake:visible value="1"/></link>' + (
        '<joint name="pad" type="fixed" drake:kind="x"><parent link="tool"/><child link="pad"/></joint>'
    )
    assert "pad" in described(text).links


def test_macros_of_xacro_are_said(described) -> None:
    with pytest.raises(InputError, match=r"macros of xacro.*Expand it first"):
        described('<xacro:macro name="arm"/>', ' xmlns:xacro="http://www.ros.org/wiki/xacro"')
