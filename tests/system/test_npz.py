"""Arrays of a .npz file come back as they were written; one that claims what is not there costs nothing."""

from __future__ import annotations

import io
import resource
import struct
import time
import zipfile
from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.system.npz import read_npz

MOST_BYTES = 400_000_000


def npz(*members: tuple[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", method) as archive:
        for name, content in members:
            archive.writestr(name, content)
    return buffer.getvalue()


def header(shape: tuple[int, ...], kind: str = "<f8") -> bytes:
    buffer = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        buffer, {"descr": kind, "fortran_order": False, "shape": shape}
    )
    return buffer.getvalue()


@cache
def archives() -> dict[str, tuple[bytes, str]]:
    sound = npz(("holds.npy", header((2,), "|b1") + b"\0\1"))
    stored = npz(("holds.npy", header((2,), "|b1") + b"\0\1"), method=zipfile.ZIP_STORED)
    half = b"{'descr': '<f8', 'shape': (3,), \n"
    word = b"{'descr': '<f8', 'fortran_order': False, 'shape': (True,), }\n"
    begun, said = (b"\x93NUMPY\x01\x00" + struct.pack("<H", len(h)) + h for h in (half, word))
    large = npz(*((f"{n}.npy", b"") for n in range(66_000)))
    lies = bytearray(sound)
    place = lies.rfind(b"PK\x05\x06")
    lies[place + 10 : place + 12] = struct.pack("<H", 60_000)
    return {
        "claims": (
            npz(("holds.npy", header((10**12,)))),
            "array 'holds' claims 8,000,000,000,128 bytes, 128 are there",
        ),
        "overflow": (npz(("holds.npy", header((2**40, 2**40)))), "array 'holds' claims"),
        "negative": (npz(("holds.npy", header((-1, -8)) + b"0" * 64)), "array 'holds' claims"),
        "bomb": (
            npz(*((f"{n}.npy", b"\0" * 50_000_000) for n in range(9))),
            "its arrays take 450 MB",
        ),
        "objects": (
            npz(("holds.npy", header((1,), "|O") + b"x" * 8)),
            "array 'holds' holds objects",
        ),
        "text": (npz(("holds.npy", header((1,), "<U2") + b"x" * 8)), "array 'holds' holds text"),
        "no array": (npz(("holds.npy", b"hello")), "array 'holds' is damaged"),
        "code": (
            npz(("holds.npy", b"\x93NUMPY\x01\x00\x20\x00__import__('os').system('false')")),
            "array 'holds' is",
        ),
        "packed": (npz(("holds.npy", b"x"), method=zipfile.ZIP_BZIP2), "packed in a way"),
        "members": (npz(*((f"{n}.npy", b"") for n in range(200))), "more than 100 members"),
        "lies": (bytes(lies), "more than 100 members"),
        "half a header": (npz(("holds.npy", begun)), "array 'holds' is damaged"),
        "a shape of words": (npz(("holds.npy", said + b"0" * 8)), "its shape is (True,)"),
        "more than the end can tell": (large, "more than 65,535 members"),
        "one name": (npz(("a.npy", b""), ("a", b"")), "two of its arrays have one name"),
        "something behind": (sound + b"x", "something stands behind its end"),
        "cut": (sound[:-30], "it is damaged"),
        "empty": (b"", "it is damaged"),
        "zeros": (b"\0" * 1000, "it is damaged"),
        "flipped": (stored.replace(b"\0\1", b"\1\1"), "damaged"),
    }


@pytest.mark.parametrize("case", archives())
def test_an_archive_that_is_none_costs_nothing(case: str) -> None:
    content, message = archives()[case]
    before, began = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.process_time()
    with pytest.raises(InputError) as caught:
        read_npz(content, most_bytes=MOST_BYTES, most_members=100)
    assert message in str(caught.value)
    assert time.process_time() - began < 10.0
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 500_000


ARRAYS = {
    "numbers": np.arange(6.0).reshape(2, 3),
    "columns": np.asfortranarray(np.arange(6).reshape(2, 3)),
    "big_endian": np.arange(3, dtype=">i4"),
    "half": np.array([0.5, 1.5], np.float16),
    "one": np.array(0.25),
    "none": np.zeros((0, 3)),
    "truth": np.array([[True], [False]]),
    "link/0/vertices": np.array([7], np.uint8),
}


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_arrays_come_back_as_they_were_written(save: Callable[..., None]) -> None:
    buffer = io.BytesIO()
    save(buffer, **ARRAYS)
    found = read_npz(buffer.getvalue(), most_bytes=MOST_BYTES, most_members=100)
    assert {*found} == {*ARRAYS}
    for name, array in ARRAYS.items():
        assert (found[name].dtype, found[name].shape) == (array.dtype, array.shape), name
        assert (found[name] == array).all()
        assert found[name].flags.writeable


@pytest.mark.parametrize(("most_bytes", "most_members"), [(16 + 2 * 128, 2), (10_000, 2)])
def test_as_much_as_is_allowed_is_read(most_bytes: int, most_members: int) -> None:
    content = npz(*((f"{name}.npy", header((1,)) + b"\0" * 8) for name in "ab"))
    assert len(read_npz(content, most_bytes=most_bytes, most_members=most_members)) == 2
    with pytest.raises(InputError, match="more than 1 members"):
        read_npz(content, most_bytes=most_bytes, most_members=1)
    with pytest.raises(InputError, match="its arrays take"):
        read_npz(content, most_bytes=15 + 2 * 128, most_members=most_members)
