"""Names and paths of shipped files, the cache folder, and files that are written whole or not at all."""

from __future__ import annotations

from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.system.files import cache_folder, find_domain, find_problem, shipped, write_whole


def test_shipped_files_are_found_by_name_from_anywhere(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("four_objects", "four_objects.yaml"):
        assert find_problem(name) == shipped("problems") / "four_objects.yaml"
    for name in ("cupboard", "cupboard.pddl"):
        assert find_domain(name) == shipped("domains") / "cupboard.pddl"


def test_paths_come_before_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mine = tmp_path / "four_objects.yaml"
    mine.write_text("")
    assert find_problem(mine) == mine and find_problem(str(mine)) == mine
    monkeypatch.chdir(tmp_path)
    assert find_problem("four_objects").resolve() == mine


def test_a_domain_beside_the_problem_comes_first(tmp_path: Path) -> None:
    mine = tmp_path / "cupboard.pddl"
    mine.write_text("")
    assert find_domain("cupboard", beside=tmp_path) == mine
    assert find_domain("cupboard") == shipped("domains") / "cupboard.pddl"


@pytest.mark.parametrize(
    ("name", "message"),
    [
        (
            "for_objects",
            r"unknown problem 'for_objects'. Choices: .*four_objects.*Did you mean 'four_objects'\?",
        ),
        (
            "there/one_object.yaml",
            r"no such file: there/one_object.yaml.*Did you mean 'one_object'\?",
        ),
        ("", "no problem given"),
        (".", r"unknown problem '.'"),
    ],
)
def test_what_is_not_there_is_said_with_the_choices(name: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        find_problem(name)


def test_streams_are_no_domains() -> None:
    with pytest.raises(InputError, match="unknown domain 'cupbord'") as caught:
        find_domain("cupbord")
    assert "cupboard" in caught.value.choices and not any(
        "streams" in choice for choice in caught.value.choices
    )


def test_the_cache_folder_can_be_chosen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TAMP_CACHE", str(tmp_path / "here"))
    assert cache_folder() == tmp_path / "here"
    monkeypatch.delenv("TAMP_CACHE")
    assert cache_folder() == Path.home() / ".cache" / "tamp"


def test_files_are_written_whole(tmp_path: Path) -> None:
    file = tmp_path / "new" / "file.bin"
    write_whole(file, b"one")
    write_whole(file, b"two")
    assert file.read_bytes() == b"two" and list(file.parent.iterdir()) == [file]
    with pytest.raises(OSError, match="directory"):
        write_whole(file.parent, b"a folder stands there")
    assert list(tmp_path.iterdir()) == [file.parent]
