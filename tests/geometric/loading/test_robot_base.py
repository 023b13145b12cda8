"""What a robot's file says of its base: turning radius, and a foot above the floor."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.geometric.loading.robot_base import SUNK_M, check_above_floor, read_turning_radius
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.loading.yaml_file import read_yaml
from tamp.geometric.loading.yaml_nodes import YamlNode
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose


def entries(folder: Path, text: str) -> dict[str, YamlNode]:
    file = folder / "base.yaml"
    file.write_text(text, encoding="utf-8")
    return dict(read_yaml(file).mapping())


@pytest.mark.parametrize("radius", [0.05, 0.7, 20.0])
def test_a_car_has_a_turning_radius(radius: float, tmp_path: Path) -> None:
    assert (
        read_turning_radius(entries(tmp_path, f"drive: car\nturning_radius: {radius}\n")) == radius
    )


@pytest.mark.parametrize("drive", ["omnidirectional", "differential", "fixed"])
def test_others_have_none(drive: str, tmp_path: Path) -> None:
    assert read_turning_radius(entries(tmp_path, f"drive: {drive}\n")) is None
    with pytest.raises(
        InputError, match=rf":2: .*a turning_radius is a car's, not of a {drive} base"
    ):
        read_turning_radius(entries(tmp_path, f"drive: {drive}\nturning_radius: 1.0\n"))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("drive: car\n", "a car needs a turning_radius"),
        ("drive: car\nturning_radius: 0.04\n", "at least 0.05"),
        ("drive: car\nturning_radius: 21\n", "at most 20"),
        ("drive: car\nturning_radius: .nan\n", "not a finite number"),
    ],
)
def test_a_bad_radius_is_one_clear_error(text: str, says: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=says):
        read_turning_radius(entries(tmp_path, text))


@pytest.mark.parametrize("name", ROBOTS)
def test_shipped_robots_stand_above_the_floor(name: str, tmp_path: Path) -> None:
    robot = ROBOTS[name]()
    node = entries(tmp_path, "mount: here\n")["mount"]
    for arm in (robot, *robot.beside):
        check_above_floor(arm, node)


def test_a_foot_in_the_floor_is_refused_by_how_deep_it_is(tmp_path: Path) -> None:
    robot = ROBOTS["ur5"]()
    low = float(bounds(robot.link(robot.foot).parts, Pose())[0][2])
    node = entries(tmp_path, "mount: here\n")["mount"]
    check_above_floor(replace(robot, T_base_arm=Pose((0.0, 0.0, -low - 0.9 * SUNK_M))), node)
    sunk = replace(robot, T_base_arm=Pose((0.0, 0.0, -low - 0.25)))
    with pytest.raises(InputError, match=r":1: .*reaches 0.25 m into the floor. Mount it higher"):
        check_above_floor(sunk, node)
