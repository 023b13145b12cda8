"""Listing the files of a folder: at any depth, sorted, and never a whole file system."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from grounding.folder_files import files_below
from tamp.errors import InputError


def test_files_at_any_depth_by_pattern(tmp_path: Path) -> None:
    for name in ("b.yaml", "a/c.yaml", "a/d/e.yaml", "a/notes.txt"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("")
    (tmp_path / "round").symlink_to(tmp_path)
    os.mkfifo(tmp_path / "pipe.yaml")
    names = [str(file.relative_to(tmp_path)) for file in files_below(tmp_path, "*.yaml")]
    assert names == ["a/c.yaml", "a/d/e.yaml", "b.yaml"]
    assert files_below(tmp_path / "b.yaml") == files_below(tmp_path / "nowhere") == []


def test_a_folder_of_too_much_is_refused(tmp_path: Path) -> None:
    for number in range(12):
        (tmp_path / f"{number}.obj").write_text("")
    assert len(files_below(tmp_path, most=12)) == 12
    with pytest.raises(InputError, match="more than 11 files and folders in this folder"):
        files_below(tmp_path, most=11)
