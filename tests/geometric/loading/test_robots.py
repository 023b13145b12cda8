"""Robots by their names: the shipped ones, a user's by its folder; the folder beside the problem comes first."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.geometric.loading.robots import ASSETS, ROBOTS, SHIPPED, find_robot, load_robot


def folder_at(place: Path) -> Path:
    shutil.copytree(ASSETS / "ur5", place)
    return place


def test_every_folder_that_comes_with_tamp_is_shipped_by_its_name() -> None:
    assert {file.parent.name for file in ASSETS.glob("*/robot.yaml")} == set(SHIPPED) == set(ROBOTS)


@pytest.mark.parametrize("name", SHIPPED)
def test_a_shipped_robots_name_stays_whatever_folder_is_there(name: str, tmp_path: Path) -> None:
    folder_at(tmp_path / name)
    assert find_robot(name, tmp_path) == name


def test_a_folder_is_looked_for_beside_the_problem_then_here(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here, beside = tmp_path / "here", tmp_path / "beside"
    folder_at(here / "mine")
    beside.mkdir()
    monkeypatch.chdir(here)
    assert find_robot("mine") == find_robot("mine", beside) == str(here / "mine")
    folder_at(beside / "mine")
    assert find_robot("mine", beside) == str(beside / "mine")
    assert find_robot("../beside/mine") == find_robot(str(beside / "mine")) == str(beside / "mine")
    # One that only has the name is passed over for one that is a robot's.
    (beside / "mine" / "robot.yaml").unlink()
    assert find_robot("mine", beside) == str(here / "mine")


def test_a_folder_that_is_no_robots_says_how_to_make_one(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError, match=r"the folder 'empty' has no robot\.yaml") as said:
        find_robot("empty", tmp_path)
    assert "tamp-robot make" in said.value.remedy and said.value.file == str(tmp_path / "empty")


@pytest.mark.parametrize("model", ["panda_mobil", "x" * 5000, "no/such/folder"])
def test_what_is_not_there_names_the_choices(
    model: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "empty").mkdir()
    monkeypatch.chdir(tmp_path / "empty")
    with pytest.raises(InputError, match="unknown robot") as said:
        find_robot(model, tmp_path / "empty")
    assert said.value.choices == SHIPPED


def test_what_was_found_is_loaded_by_name_or_folder(tmp_path: Path) -> None:
    own = folder_at(tmp_path / "mine")
    assert load_robot("ur5").name == "ur5"
    mine = load_robot(find_robot("mine", tmp_path))
    assert (mine.name, mine.folder) == ("mine", own)
    shutil.rmtree(own)
    with pytest.raises(InputError, match=r"no robot: robot\.yaml is missing"):
        load_robot(str(own))
