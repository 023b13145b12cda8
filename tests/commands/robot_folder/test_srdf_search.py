"""The SRDF beside a URDF: where it is looked for, and which of several is read."""

from __future__ import annotations

from pathlib import Path

import pytest

from tamp.commands.robot_folder.description import read_description
from tamp.commands.robot_folder.srdf_search import srdf_for
from tests.commands.robot_folder.srdf_files import (
    ARM,
    write,
)
from tests.commands.robot_folder.urdf import arm_text


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
