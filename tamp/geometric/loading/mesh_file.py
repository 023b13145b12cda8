"""The triangles in a mesh file, whatever is wrong with it: read with limits, and by rules that name
what they miss.
"""

from __future__ import annotations

import io
import json
import logging
import re
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tamp.errors import InputError
from tamp.geometric.loading.collada import read_collada
from tamp.geometric.loading.raw_file import read_raw
from tamp.geometric.scene.pose import Array

MOST_BYTES = 80_000_000
"""Larger mesh files are refused: reading them would take minutes and gigabytes."""

MOST_TRIANGLES = 1_000_000
"""More are refused; a body has some thousand."""

Triangles = tuple[Array, NDArray[np.int64]]
MESH_SUFFIXES = (".obj", ".stl", ".ply", ".dae", ".glb", ".gltf")
_FORMATS = "OBJ, STL, PLY, COLLADA (.dae), glTF (.glb, .gltf) nor URDF"
_FACET = re.compile(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)")
_CORNER_0 = re.compile(rb"^f[^\n]*\s0[/\s]", re.MULTILINE)
_PLY_REMARK = re.compile(rb"^(comment|obj_info)[^\n]*\n", re.MULTILINE)
_PLY_COUNT = re.compile(rb"^element\s+(\S+)\s+(\S+)\s*$", re.MULTILINE)
_PLY_SIZES = {
    "char": 1,
    "uchar": 1,
    "int8": 1,
    "uint8": 1,
    "short": 2,
    "ushort": 2,
    "int16": 2,
    "uint16": 2,
}


def read_triangles(path: Path) -> Triangles:
    """Read vertices (n, 3) as the file has them and faces (m, 3); COLLADA's units and nodes are
    applied, no axis is turned.

    Raises:
        InputError: Not a mesh of its format, cut off, too large, empty, a corner that does not
            exist.
    """
    name = path.name
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise InputError(f"'{name}' is neither {_FORMATS}")

    content = read_raw(path, MOST_BYTES)
    # Before minutes go into reading them.
    if reader is _obj and content.count(b"\nf ") > MOST_TRIANGLES:
        raise InputError(f"the mesh '{name}' has more than {MOST_TRIANGLES:,} faces: simplify it")

    try:
        vertices, faces = reader(content, path)
    except InputError:
        raise
    except Exception as error:  # trimesh raises whatever its readers stumble on
        reasons = {
            ImportError: "it is not text or binary of its format",
            IndexError: "a face names a missing corner",
        }
        why = next(
            (words for kind, words in reasons.items() if isinstance(error, kind)), str(error)
        )
        why = " ".join(why.split())[:200] or type(error).__name__
        raise InputError(
            f"cannot read the mesh '{name}': {why}", remedy="Export it again as OBJ, STL or PLY"
        ) from None

    if vertices.ndim != 2 or vertices.shape[1] != 3:
        raise InputError(f"cannot read the mesh '{name}': its corners have no three coordinates")
    if not len(vertices) or not len(faces):
        raise InputError(f"the mesh '{name}' is empty: it holds no triangles")
    if len(faces) > MOST_TRIANGLES:
        raise InputError(
            f"the mesh '{name}' has {len(faces):,} triangles: at most {MOST_TRIANGLES:,} are read"
        )
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise InputError(f"the mesh '{name}' names a corner that it does not hold")

    return vertices, faces


def quiet() -> None:
    """Keep trimesh from logging its own tracebacks; what it raises is told in our words."""
    logging.getLogger("trimesh").setLevel(logging.CRITICAL + 1)


def _obj(content: bytes, path: Path) -> Triangles:
    text = ascii_text(content)
    if _CORNER_0.search(text):
        raise InputError(
            f"cannot read the mesh '{path.name}': a face names corner 0, but they count from 1"
        )
    return _by_trimesh(text, "obj")


def _ply(content: bytes, path: Path) -> Triangles:
    end = content.find(b"end_header", 0, 100_000)
    if not content.startswith(b"ply") or end < 0:
        raise InputError(f"cannot read the mesh '{path.name}': it has no header of a PLY file")

    header, body = content[:end].replace(b"\r\n", b"\n").replace(b"\r", b"\n"), content[end:]
    header = _PLY_REMARK.sub(b"", header)

    claimed, rows = 0, 0
    for element, count in _PLY_COUNT.findall(header):
        if not count.isdigit() or len(count) > 12:
            raise InputError(
                f"cannot read the mesh '{path.name}': {count[:20]!r} is no number of elements"
            )
        claimed += int(count) * _ply_row(header, element)
        rows += int(count)

    text = b"format ascii" in header
    if claimed > len(body) or (text and rows > len(body.splitlines()) - 1):
        raise InputError(
            f"cannot read the mesh '{path.name}': it is cut off, its header tells of more "
            "than it holds"
        )
    return _by_trimesh(header + (ascii_text(body) if text else body), "ply")


def _ply_row(header: bytes, element: bytes) -> int:
    """Compute the fewest bytes of an element's row: in text a digit and a blank for each number."""
    rows = header.decode("latin-1").split("element")
    own = next((row for row in rows if row.split()[:1] == [element.decode("latin-1")]), "")
    properties = [line.split() for line in own.splitlines() if line.strip().startswith("property")]
    if b"format ascii" in header:
        return 2 * len(properties)
    # A list has at least its length.
    return sum(
        _PLY_SIZES.get(words[2 if words[1] == "list" else 1], 4)
        for words in properties
        if len(words) > 2
    )


def _stl(content: bytes, path: Path) -> Triangles:
    count = struct.unpack_from("<I", content, 80)[0] if len(content) >= 84 else -1
    if len(content) >= 84 and len(content) == 84 + 50 * count:
        return _soup(_stl_records(content, count))

    if content.lstrip()[:5].lower() == b"solid" and b"facet" in content[:100_000].lower():
        corners = _FACET.findall(content)
        if len(corners) % 3 or content.count(b"endfacet") not in (0, len(corners) // 3):
            raise InputError(
                f"cannot read the mesh '{path.name}': it is cut off in the middle of a triangle"
            )
        return _soup(np.array(corners, dtype="S32").astype(np.float64).reshape(-1, 3))

    if len(content) < 84:
        raise InputError(
            f"cannot read the mesh '{path.name}': it is no STL file, neither in text nor in binary"
        )

    held = (len(content) - 84) // 50
    if held >= count:  # something follows the triangles, which readers skip
        return _soup(_stl_records(content, count))

    raise InputError(
        f"cannot read the mesh '{path.name}': it is cut off (its header tells of {count:,} "
        f"triangles, it holds {held:,}), or no STL file"
    )


def _stl_records(content: bytes, count: int) -> Array:
    records = np.frombuffer(content, dtype=np.uint8, count=50 * count, offset=84).reshape(count, 50)
    corners = np.ascontiguousarray(records[:, 12:48]).view("<f4").reshape(-1, 3)
    with np.errstate(invalid="ignore"):  # bytes of anything may be a signalling NaN: refused later
        return corners.astype(np.float64)


def _soup(corners: Array) -> Triangles:
    return corners, np.arange(len(corners), dtype=np.int64).reshape(-1, 3)


def _dae(content: bytes, path: Path) -> Triangles:
    return read_collada(path, MOST_BYTES)


def _gltf(content: bytes, path: Path) -> Triangles:
    check_gltf(content, path.name)
    import trimesh

    quiet()
    beside: Any = Beside(path.parent)
    loaded: Any = trimesh.load_scene(
        io.BytesIO(content),
        file_type=path.suffix.lower()[1:],
        resolver=beside,
        process=False,
        skip_materials=True,
    )
    mesh: Any = loaded.to_mesh()
    return np.array(mesh.vertices, dtype=float), np.array(mesh.faces, dtype=np.int64)


def check_gltf(content: bytes, name: str) -> None:
    """Refuse a glTF file that claims more than it can hold.

    Raises:
        InputError: No glTF, cut off, or accessors of more numbers than a mesh may have.
    """
    text = content
    if content[:4] == b"glTF":
        if len(content) < 20 or struct.unpack_from("<I", content, 8)[0] > len(content):
            raise InputError(f"cannot read the mesh '{name}': it is cut off")
        text = content[20 : 20 + struct.unpack_from("<I", content, 12)[0]]
    try:
        document = json.loads(text)
        counts = [accessor["count"] for accessor in document.get("accessors", [])]
        total = sum(max(0, int(count)) for count in counts)
        whole = all(isinstance(count, int) and count >= 0 for count in counts)
    except (ValueError, TypeError, KeyError, AttributeError, OverflowError, RecursionError):
        raise InputError(f"cannot read the mesh '{name}': it is no glTF file") from None
    if not whole or total > 10 * MOST_TRIANGLES:
        raise InputError(
            f"cannot read the mesh '{name}': it claims too many numbers, or less than none"
        )


class Beside:
    """The resolver of the files that a mesh names: only regular ones of a modest size, in the
    mesh's folder.

    Args:
        folder: The mesh's folder.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder.resolve()

    def get(self, name: str) -> bytes:
        """Return the content of a file beside the mesh, or below; text is made ASCII where its
        suffix says that it is text.

        Raises:
            InputError: It is elsewhere, no regular file, or too large.
        """
        file = (self._folder / str(name).strip().replace("\\", "/")).resolve()
        if not file.is_relative_to(self._folder):
            raise InputError(f"'{file.name}' is not in the folder of its mesh")
        content = read_raw(file, MOST_BYTES)
        return ascii_text(content) if file.suffix.lower() == ".mtl" else content

    def __getitem__(self, name: str) -> bytes:
        return self.get(name)

    def namespaced(self, namespace: str) -> Beside:
        """Return the same for a folder below."""
        return Beside(self._folder / namespace)


def ascii_text(content: bytes) -> bytes:
    """Return the text with only ASCII in it: names and comments in any encoding lose their other
    letters, numbers nothing.
    """
    if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
        content = content.decode("utf-16", errors="replace").encode("utf-8")
    content = content.removeprefix(b"\xef\xbb\xbf")
    content = content.replace(b"\r\n", b"\n").replace(b"\r", b"\n").replace(b"\\\n", b" ")
    return content.translate(_ASCII)


def _by_trimesh(content: bytes, kind: str) -> Triangles:
    import trimesh

    quiet()
    loaded: Any = trimesh.load(
        io.BytesIO(content), file_type=kind, force="mesh", process=False, skip_materials=True
    )  # fmt: skip
    return np.array(loaded.vertices, dtype=float), np.array(loaded.faces, dtype=np.int64)


_ASCII = bytes(code if code < 128 else ord("_") for code in range(256))
_READERS: dict[str, Callable[[bytes, Path], Triangles]] = {
    ".obj": _obj, ".stl": _stl, ".ply": _ply, ".dae": _dae, ".glb": _gltf, ".gltf": _gltf,
}  # fmt: skip
