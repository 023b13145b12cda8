"""Pictures of results: four files, whatever the results are."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tamp.benchmark.picture import draw
from tamp.errors import InputError
from tests.benchmark.results import results
from tests.benchmark.toys import TIMEOUT, line, some


def test_the_pictures_are_drawn_from_any_results(tmp_path: Path) -> None:
    unsolved = line(some(1, ("never",))[0], 30.0, **TIMEOUT)
    written = draw([*results(), unsolved], tmp_path / "deep")
    assert [path.name for path in written] == ["success.png", "ecdf.png", "cactus.png", "parts.png"]
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in written)


def test_pictures_without_matplotlib_or_a_folder_are_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match="cannot be written"):
        draw(results(), tmp_path / "file")
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(InputError, match=r"pip install 'tamp-planner\[bench\]'"):
        draw(results(), tmp_path)
