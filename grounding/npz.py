"""Arrays out of a .npz file that is not to be trusted: sizes and types are looked at before
anything is unpacked.
"""

from __future__ import annotations

import io
import math
import struct
import zipfile
import zlib
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tamp.errors import InputError

MOST_BYTES = 400_000_000
"""Of all arrays together, unpacked: 200,000 scenes."""

MOST_MEMBERS = 100
"""Arrays of a file; a data set has about twenty."""

KINDS = {"b": "truth values", "i": "integers", "u": "integers", "f": "numbers"}
"""NumPy's kinds of arrays that are read, in words."""

_END = b"PK\x05\x06"


class Header(NamedTuple):
    """The header of an array's file: its shape, its type, and the bytes that it takes itself."""

    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    size: int


def read_npz(content: bytes) -> dict[str, NDArray[Any]]:
    """Unpack the arrays of a .npz file, as `numpy.savez` writes it.

    Raises:
        InputError: It is none; an array is of objects or text, claims what is not there, or all are
            too large. The message names the array.
    """
    _check_end(content)

    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            members = archive.infolist()
            total = sum(member.file_size for member in members)
            if total > MOST_BYTES:
                raise InputError(
                    f"its arrays take {total / 1e6:,.0f} MB, "
                    f"at most {MOST_BYTES / 1e6:,.0f} are read"
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


def _check_end(content: bytes) -> None:
    """Refuse a list of members that would be long to read."""
    start = content.rfind(_END, max(0, len(content) - 65_557))
    if start < 0 or start + 22 > len(content):
        raise InputError("it is damaged: this is no .npz file, or it is cut off")
    (count, size) = struct.unpack_from("<HI", content, start + 10)
    if count > MOST_MEMBERS or size > MOST_MEMBERS * 1000:
        raise InputError(f"it has more than {MOST_MEMBERS} members")


def _member(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> tuple[str, NDArray[Any]]:
    name = member.filename.removesuffix(".npy")
    if member.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise InputError(f"array '{name}' is packed in a way that numpy does not use")
    with archive.open(member) as stream:
        header = _header(stream, name)
        claimed = header.size + math.prod(header.shape) * header.dtype.itemsize
        if header.dtype.kind not in KINDS:
            raise InputError(f"array '{name}' holds {_kind(header.dtype)}, not numbers")
        if any(length < 0 for length in header.shape) or claimed != member.file_size:
            raise InputError(
                f"array '{name}' claims {claimed:,} bytes, {member.file_size:,} are there"
            )
    with archive.open(member) as stream:
        return name, np.lib.format.read_array(stream, allow_pickle=False)


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

        shape, _, dtype = reader(stream)
        return Header(shape, dtype, stream.tell())
    except (
        ValueError,
        TypeError,
        SyntaxError,
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
