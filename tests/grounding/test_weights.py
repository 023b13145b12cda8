"""Weights on disk: read whole and sound, or refused with the file and what is wrong in it."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from grounding.weights import Weights, read_weights, write_weights
from tamp.errors import InputError


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "the file is cut off"),
        (struct.pack("<Q", 2**63) + b"{}", "its header claims"),
        (struct.pack("<Q", 2) + b"[]", "its header is no object"),
        (struct.pack("<Q", 4) + b"\xff\xfe{}", "no text"),
        (struct.pack("<Q", 200_000) + b"[" * 200_000, "nested too deeply"),
        (
            struct.pack("<Q", 60)
            + b'{"a":{"dtype":"F64","shape":[99999999999],"data_offsets":[0,9'.ljust(60),
            "damaged",
        ),
        (
            struct.pack("<Q", 59)
            + b'{"a":{"dtype":"BF16","shape":[1],"data_offsets":[0,2]}}    '
            + b"00",
            "of type 'BF16'",
        ),
        (
            struct.pack("<Q", 65)
            + b'{"a":{"dtype":"F64","shape":[99999999],"data_offsets":[0,800]}}  ',
            "damaged",
        ),
    ],
)
def test_weights_that_claim_what_is_not_there(content: bytes, message: str, tmp_path: Path) -> None:
    path = tmp_path / "w.safetensors"
    write_weights(path, Weights({"x": np.zeros(3)}, {"model": "transfer"}))
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_weights(path)
    assert "the weights are damaged" in str(caught.value)
    assert message in str(caught.value)


def test_weights_are_read_as_they_were_written(tmp_path: Path) -> None:
    arrays = {
        "b": np.arange(6.0).reshape(2, 3).T,  # not in the order of its memory
        "a": np.array([True, False]),
        "c": np.array([1, -2], np.int8),
    }
    write_weights(tmp_path / "w.safetensors", Weights(arrays, {"model": "transfer", "seed": 7}))
    found = read_weights(tmp_path / "w.safetensors")
    assert {*found.arrays} == {*arrays}
    for name, array in arrays.items():
        assert found.arrays[name].dtype == array.dtype and (found.arrays[name] == array).all()
    assert found.card == {"format": "tamp grounding 1", "model": "transfer", "seed": 7}


def test_an_array_that_is_not_finite_is_named_with_its_entry(tmp_path: Path) -> None:
    array = np.zeros((2, 3))
    array[1, 2] = np.nan
    write_weights(tmp_path / "w.safetensors", Weights({"x": array}, {"model": "transfer"}))
    with pytest.raises(InputError, match=r"array 'x', entry \(1, 2\): it is not finite"):
        read_weights(tmp_path / "w.safetensors")


@pytest.mark.parametrize("entry", ["relation", "model"])
@pytest.mark.parametrize("value", [3, None, ["on"], "on\x1b[31m"])
def test_a_card_names_its_relation_and_model_in_words(
    entry: str, value: Any, tmp_path: Path
) -> None:
    path = tmp_path / "w.safetensors"
    write_weights(path, Weights({"x": np.zeros(3)}, {"model": "transfer", entry: value}))
    with pytest.raises(InputError, match=f"'{entry}' of the card is .*, not a name") as caught:
        read_weights(path)
    assert caught.value.file == str(tmp_path / "w.json") and "\x1b" not in str(caught.value)


def test_weights_that_are_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such weight file"):
        read_weights(tmp_path / "none.safetensors")
