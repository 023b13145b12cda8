"""Folders of a moment: gone afterwards, whatever happens, and those of killed processes with them."""

from __future__ import annotations

import os
import tempfile
import time
from pathlib import Path

import pytest

from tamp.system import scratch
from tamp.system.scratch import FOLDER_PATTERN, scratch_folder


def test_folders_of_a_moment_are_tidied_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    dead = next(
        number for number in range(4_000_000, 1, -1) if not Path(f"/proc/{number}").exists()
    )
    old = time.time() - 1000
    for name, age in (
        (f"tamp-{dead}-abc", old),
        (f"tamp-{os.getpid()}-abc", old),
        ("tamp-mine", old),
    ):
        (tmp_path / name).mkdir()
        os.utime(tmp_path / name, (age, age))
    (tmp_path / f"tamp-{dead}-young").mkdir()
    with scratch_folder() as mine:
        assert mine.is_dir()
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(
        [f"tamp-{os.getpid()}-abc", "tamp-mine", f"tamp-{dead}-young"]
    )


def test_a_folder_is_gone_with_what_is_in_it_when_something_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))

    def fails() -> None:
        with scratch_folder() as mine:
            assert mine.parent == tmp_path and FOLDER_PATTERN.match(mine.name)
            (mine / "mesh.obj").write_text("v 0 0 0")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fails()
    assert list(tmp_path.iterdir()) == []


def test_a_file_and_a_link_of_such_a_name_stay(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Only folders are ours; what a link leads to is somebody's."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(scratch, "_runs", lambda number: False)
    place = tmp_path / "somebodys"
    place.mkdir()
    (place / "diary").write_text("dear")
    (tmp_path / "tamp-11-file").write_text("")
    (tmp_path / "tamp-12-link").symlink_to(place)
    (tmp_path / "tamp-13-left").mkdir()
    old = time.time() - 1000
    for name in ("tamp-11-file", "tamp-12-link", "tamp-13-left"):
        os.utime(tmp_path / name, (old, old), follow_symlinks=False)
    with scratch_folder():
        pass
    left = sorted(path.name for path in tmp_path.iterdir())
    assert left == ["somebodys", "tamp-11-file", "tamp-12-link"]
    assert (place / "diary").is_file()


def test_a_process_runs_unless_the_system_knows_none_of_its_number() -> None:
    assert scratch._runs(os.getpid())
    assert scratch._runs(1)  # another user's, perhaps
    assert scratch._runs(10**30)  # no number of a process: nobody can tell, so it is let be
    dead = next(n for n in range(4_000_000, 1, -1) if not Path(f"/proc/{n}").exists())
    assert not scratch._runs(dead)
