"""Weights on disk: read whole and sound, or refused with the file and what is wrong in it."""

from __future__ import annotations

import struct
from pathlib import Path

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
