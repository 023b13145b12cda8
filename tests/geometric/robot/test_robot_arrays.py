"""Arrays of a robot's folder are read whole and checked, or are one error that names the file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.geometric.robot import robot_arrays
from tamp.geometric.robot.robot_arrays import REMEDY, numbers, read_arrays

ROWS = np.arange(6.0).reshape(2, 3)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "arrays.npz"
    np.savez(path, rows=ROWS, one=np.array(0.5), **{"link/0": np.array([1, 2])})
    return path


def test_arrays_come_back_as_they_were_written(file: Path) -> None:
    arrays = read_arrays(file)
    assert set(arrays) == {"rows", "one", "link/0"}
    assert (numbers(arrays, "rows", file, (None, 3)) == ROWS).all()
    assert numbers(arrays, "one", file, ()) == 0.5


@pytest.mark.parametrize("kept", [0, 10, 200])
def test_a_file_that_was_cut_off_is_damaged(kept: int, file: Path) -> None:
    file.write_bytes(file.read_bytes()[:kept])
    with pytest.raises(InputError, match="damaged") as said:
        read_arrays(file)
    assert said.value.file == str(file) and said.value.remedy == REMEDY


def test_a_file_that_is_missing_says_so(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none\.npz is missing"):
        read_arrays(tmp_path / "none.npz")


def test_what_unpacks_to_more_than_allowed_is_not_unpacked(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(robot_arrays, "MOST_BYTES", 1_000_000)
    np.savez_compressed(file, rows=np.zeros(250_000))  # 2 MB, packed in 3 kB
    with pytest.raises(InputError, match="damaged: its arrays take 2 MB, at most 1 are read"):
        read_arrays(file)


def test_what_is_larger_than_allowed_is_not_read(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(robot_arrays, "MOST_BYTES", 100)
    with pytest.raises(InputError, match="damaged: no file of arrays is"):
        read_arrays(file)


def test_a_robot_of_many_hulls_has_many_arrays(file: Path) -> None:
    np.savez(file, **{f"link/{number}": np.zeros(1) for number in range(300)})
    assert len(read_arrays(file)) == 300


@pytest.mark.parametrize("array", [np.array(["a", "b"]), np.array([1 + 2j])])
def test_what_is_no_number_is_refused_by_its_name(array: np.ndarray, file: Path) -> None:
    np.savez(file, names=array)
    with pytest.raises(InputError, match="damaged: array 'names' holds") as said:
        read_arrays(file)
    assert said.value.file == str(file)


@pytest.mark.parametrize(
    ("array", "shape", "kinds"),
    [
        (ROWS, (None, 4), "f"),
        (ROWS, (None,), "f"),
        (np.zeros((0, 3)), (None, 3), "f"),
        (ROWS, (None, 3), "iu"),
        (np.array(["a", "b"]), (None,), "fiu"),
        (np.array([1.0, np.nan]), (None,), "f"),
        (np.array([1.0, np.inf]), (None,), "f"),
        (np.array([1.0, -2e9]), (None,), "f"),
    ],
)
def test_arrays_of_another_kind_are_refused(
    array: np.ndarray, shape: tuple[int | None, ...], kinds: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match="'rows' is not"):
        numbers({"rows": array}, "rows", tmp_path / "a.npz", shape, kinds)


def test_an_array_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="it has no 'rows'"):
        numbers({}, "rows", tmp_path / "a.npz", (None,))
