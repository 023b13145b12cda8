"""Arrays of a .npz file that claims what is not there cost nothing, and are one error."""

from __future__ import annotations

import io
import resource
import struct
import time
import zipfile

import numpy as np
import pytest

from grounding.npz import read_npz
from tamp.errors import InputError


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


def archives() -> dict[str, tuple[bytes, str]]:
    sound = npz(("holds.npy", header((2,), "|b1") + b"\0\1"))
    stored = npz(("holds.npy", header((2,), "|b1") + b"\0\1"), method=zipfile.ZIP_STORED)
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
        read_npz(content)
    assert message in str(caught.value)
    assert time.process_time() - began < 10.0
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 500_000
