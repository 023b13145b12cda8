"""A page gives away no mesh from outside of the problem's folder that not everybody has."""

from __future__ import annotations

from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.geometric.loading.meshes import find_mesh
from tamp.view.external_meshes import check_inside
from tests.needs import NEEDS_PYBULLET


def test_meshes_beside_and_below_the_problem_may_be_shown(tmp_path: Path) -> None:
    problem = tmp_path / "here" / "p.yaml"
    below = tmp_path / "here" / "meshes" / "cup.obj"
    below.parent.mkdir(parents=True)
    below.touch()
    check_inside([below, problem.with_name("beside.obj")], problem)
    check_inside([], problem)

    outside = tmp_path / "secret.obj"
    outside.touch()
    with pytest.raises(
        InputError, match=r"outside of the problem's folder. Move it there, or say.*--allow-outside"
    ):
        check_inside([below, outside], problem)


def test_a_link_out_of_the_folder_is_outside(tmp_path: Path) -> None:
    (tmp_path / "secret.obj").touch()
    folder = tmp_path / "here"
    folder.mkdir()
    (folder / "cup.obj").symlink_to(tmp_path / "secret.obj")
    with pytest.raises(InputError, match="outside"):
        check_inside([folder / "cup.obj"], folder / "p.yaml")
    with pytest.raises(InputError, match="outside"):
        check_inside([folder / ".." / "secret.obj"], folder / "p.yaml")
    (folder / "linked.yaml").symlink_to(tmp_path / "p.yaml")
    check_inside(
        [tmp_path / "secret.obj"], folder / "linked.yaml"
    )  # the problem's own place counts


def test_a_folder_whose_name_begins_alike_is_another(tmp_path: Path) -> None:
    (tmp_path / "here-too").mkdir()
    with pytest.raises(InputError, match="outside"):
        check_inside([tmp_path / "here-too" / "cup.obj"], tmp_path / "here" / "p.yaml")


def test_meshes_that_come_with_tamp_may_be_shown(tmp_path: Path) -> None:
    check_inside([find_mesh("pybullet_data/objects/mug.urdf", tmp_path)], tmp_path / "p.yaml")


@NEEDS_PYBULLET
def test_meshes_that_anybody_has_may_be_shown(tmp_path: Path) -> None:
    import pybullet_data

    check_inside([Path(pybullet_data.getDataPath()) / "duck.obj"], tmp_path / "p.yaml")
