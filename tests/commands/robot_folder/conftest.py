"""Robots that are made once for all tests here: fewer samples than for a user."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tamp.commands.robot_folder import convex, reach_table, self_collision, spheres
from tamp.commands.robot_folder.description import Description, read_description
from tests.commands.robot_folder.urdf import FIVE, LIFT, SIX, arm_text, write_arm


@pytest.fixture(scope="session")
def quick():
    """Make robots with fewer samples."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(self_collision, "STATES", 2000)
        patch.setattr(self_collision, "COMPARED", 300)
        patch.setattr(reach_table, "SAMPLES", 300_000)
        patch.setattr(spheres, "MOST_NODES", 20_000)
        patch.setattr(convex, "PIECES", 3)
        yield


def made(folder: Path, *options: str, joints=SIX, name: str = "boxes") -> Path:
    """Make a robot's folder as the command does."""
    from tamp.commands.robot import main

    urdf = write_arm(folder, joints)
    out = folder / name
    assert (
        main(["make", str(urdf), "--arm", "foot", "tool", "--out", str(out), "--quiet", *options])
        == 0
    )
    return out


@pytest.fixture(scope="session")
def driving(quick, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An arm of six joints on a differential base."""
    return made(tmp_path_factory.mktemp("driving"), "--base", "differential")


@pytest.fixture(scope="session")
def steered(quick, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An arm of six joints on a car."""
    return made(tmp_path_factory.mktemp("steered"), "--base", "car", "--turning-radius", "0.7")


@pytest.fixture(scope="session")
def lifting(quick, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An arm of seven joints, the first of which is a lift, on an omnidirectional base."""
    return made(tmp_path_factory.mktemp("lifting"), joints=(LIFT, *SIX), name="lifter")


@pytest.fixture(scope="session")
def bolted(quick, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An arm of six joints bolted to a table."""
    return made(tmp_path_factory.mktemp("bolted"), "--base", "fixed", "--height", "0.5")


@pytest.fixture(scope="session")
def five(quick, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An arm of five joints on an omnidirectional base."""
    return made(tmp_path_factory.mktemp("five"), joints=FIVE, name="five")


@pytest.fixture
def described(tmp_path: Path) -> Callable[..., Description]:
    """Reads the arm of boxes with more elements in its URDF."""

    def read(extra: str, attributes: str = "") -> Description:
        file = tmp_path / "arm.urdf"
        text = arm_text(extra=extra).replace(
            '<robot name="boxes">', f'<robot name="boxes"{attributes}>'
        )
        file.write_text(text, encoding="utf-8")
        return read_description(file)

    return read
