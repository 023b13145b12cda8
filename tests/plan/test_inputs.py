"""The files that a plan was made from, with their hashes; a robot's only where it is one's own."""

from __future__ import annotations

from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.plan.inputs import inputs_document

OF_ABC = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
"""SHA-256 of "abc", by FIPS 180-2."""


@pytest.fixture
def abc(tmp_path: Path) -> Path:
    file = tmp_path / "abc.yaml"
    file.write_bytes(b"abc")
    return file


def test_every_file_has_its_place_and_hash(abc: Path) -> None:
    told = {"path": str(abc), "sha256": OF_ABC}
    files = {"problem": [abc], "domain": [abc], "streams": [abc], "meshes": [abc, abc], "robot": []}
    assert inputs_document(files) == {
        "problem": told,
        "domain": told,
        "streams": told,
        "meshes": [told, told],
    }


def test_a_robot_of_ones_own_is_told_with_all_its_files(abc: Path) -> None:
    files = {role: [abc] for role in ("problem", "domain", "streams", "meshes", "robot")}
    assert inputs_document(files)["robot"] == [{"path": str(abc), "sha256": OF_ABC}]


def test_a_file_that_is_gone_is_an_error(abc: Path) -> None:
    gone = abc.with_name("gone.obj")
    files = {"problem": [abc], "domain": [abc], "streams": [abc], "meshes": [gone], "robot": []}
    with pytest.raises(InputError, match=r"gone.obj: it cannot be read any more: No such file"):
        inputs_document(files)
