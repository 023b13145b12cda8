"""Reading of .npz files: sizes and types of the arrays are checked before anything is unpacked."""

from __future__ import annotations

import io
import math
import struct
import tokenize
import zipfile
import zlib
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tamp.errors import InputError

KINDS = {"b": "truth values", "i": "integers", "u": "integers", "f": "numbers"}
"""NumPy's kinds of arrays that are read, in words."""

_END = b"PK\x05\x06"
"""What the end of a zip file's directory begins with."""

_LARGE_END = b"PK\x06\x07"
"""What is put before that end where there are more members, or bytes, than it can tell (zip64)."""

_ENTRY_BYTES = 1000
"""The largest entry of that directory on average: its member's name and 46 bytes."""


class Header(NamedTuple):
    """The header of an array's file: its shape, the order of its memory, its type, and the bytes
    that it takes itself.
    """

    shape: tuple[int, ...]
    fortran: bool
    dtype: np.dtype[Any]
    size: int


def read_npz(content: bytes, *, most_bytes: int, most_members: int) -> dict[str, NDArray[Any]]:
    """Read the arrays of a .npz file by their names, as `numpy.savez` writes it.

    Args:
        content: The file's bytes, which are not trusted.
        most_bytes: Of all arrays together, unpacked.
        most_members: Arrays.

    Raises:
        InputError: It is none; an array is of objects or text, claims what is not there, or all are
            too large or too many. The message names the array, and no file.
    """
    _check_end(content, most_members)

    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            members = archive.infolist()
            names = [_name(member) for member in members]
            if len(set(names)) < len(names):
                raise InputError("it is damaged: two of its arrays have one name")
            total = sum(member.file_size for member in members)
            if total > most_bytes:
                raise InputError(
                    f"its arrays take {total / 1e6:,.0f} MB, "
                    f"at most {most_bytes / 1e6:,.0f} are read"
                )

            return dict(_member(archive, member) for member in members)
    except (
        OSError,
        ValueError,
        KeyError,
        EOFError,
        NotImplementedError,
        RuntimeError,
        MemoryError,
    ) as error:
        raise InputError(f"it is damaged: {error}") from None
    except (zipfile.BadZipFile, zlib.error, struct.error) as error:
        raise InputError(f"it is damaged: {error}") from None


def _check_end(content: bytes, most: int) -> None:
    """Refuse a list of members that would be long to read."""
    start = content.rfind(_END, max(0, len(content) - 65_557))
    if start < 0 or start + 22 > len(content):
        raise InputError("it is damaged: this is no .npz file, or it is cut off")
    if content[start - 20 : start - 16] == _LARGE_END:
        raise InputError("it has more than 65,535 members, or 4 GB")
    (count, size, _, comment) = struct.unpack_from("<HIIH", content, start + 10)
    if start + 22 + comment != len(content):
        raise InputError("it is damaged: something stands behind its end")
    if count > most or size > most * _ENTRY_BYTES:
        raise InputError(f"it has more than {most} members")


def _name(member: zipfile.ZipInfo) -> str:
    return member.filename.removesuffix(".npy")


def _member(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> tuple[str, NDArray[Any]]:
    name = _name(member)
    if member.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise InputError(f"array '{name}' is packed in a way that numpy does not use")
    with archive.open(member) as stream:
        header = _header(stream, name)
        claimed = header.size + math.prod(header.shape) * header.dtype.itemsize
        if header.dtype.kind not in KINDS:
            raise InputError(f"array '{name}' holds {_kind(header.dtype)}, not numbers")
        if any(type(length) is not int for length in header.shape):
            raise InputError(f"array '{name}' is damaged: its shape is {header.shape}")
        if any(length < 0 for length in header.shape) or claimed != member.file_size:
            raise InputError(
                f"array '{name}' claims {claimed:,} bytes, {member.file_size:,} are there"
            )
        content = bytearray(stream.read())  # which can be written to, as numpy's own arrays can
    order = "F" if header.fortran else "C"
    return name, np.frombuffer(content, header.dtype).reshape(header.shape, order=order)


def _header(stream: Any, name: str) -> Header:
    try:
        version = np.lib.format.read_magic(stream)
        if version not in ((1, 0), (2, 0)):
            raise ValueError(f"its version is {version}")
        reader = (
            np.lib.format.read_array_header_1_0
            if version == (1, 0)
            else np.lib.format.read_array_header_2_0
        )

        shape, fortran, dtype = reader(stream)
        return Header(shape, fortran, dtype, stream.tell())
    except (
        ValueError,
        TypeError,
        SyntaxError,
        tokenize.TokenError,
        RecursionError,
        OverflowError,
        MemoryError,
    ) as error:
        raise InputError(
            f"array '{name}' is damaged: {str(error).splitlines()[0] if str(error) else error}"
        ) from None


def _kind(dtype: np.dtype[Any]) -> str:
    return {"U": "text", "S": "text", "O": "objects", "c": "complex numbers"}.get(
        dtype.kind, f"'{dtype}'"
    )
