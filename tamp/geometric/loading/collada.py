"""The triangles in a COLLADA file: transforms and unit applied, axes as they are.

pybullet and most of robotics do not turn a file whose `<up_axis>` is Y; many writers say Y_UP
whatever they write.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from tamp.errors import InputError
from tamp.geometric.loading.xml_file import read_xml
from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float, Int

_MOST_INSTANCES = 10_000
_MOST_DEPTH = 100


def read_collada(
    path: Path, most: int
) -> tuple[Float[Array, "n 3"], Int[NDArray[np.int64], "m 3"]]:
    """Read vertices (n, 3) in metres and triangles (m, 3) of all that the file's scene shows, or of
    all its geometries when it has no scene.

    Args:
        path: The file.
        most: Bytes beyond which it is refused.

    Raises:
        InputError: Not COLLADA, broken, a unit that is no length, or nothing in it.
    """
    root = read_xml(path, most)
    for element in root.iter():  # the namespace has changed with the version, the names have not
        element.tag = str(element.tag).rpartition("}")[2]
    if root.tag != "COLLADA":
        raise InputError(
            f"cannot read the mesh '{path.name}': it is no COLLADA file, but <{root.tag[:40]}>"
        )
    return _Document(path, root).triangles()


class _Document:
    def __init__(self, path: Path, root: ElementTree.Element) -> None:
        self.path = path
        self.root = root
        self.named = {
            element.get("id", ""): element for element in root.iter() if element.get("id")
        }
        self.vertices: list[Array] = []
        self.faces: list[NDArray[np.int64]] = []
        self.count = 0
        self.shown = 0

    def triangles(self) -> tuple[Array, NDArray[np.int64]]:
        unit = self.root.find("asset/unit")
        metres = 1.0 if unit is None else self.numbers(unit.get("meter", "1"), "<unit>", 1)[0]
        if not 1e-9 < metres < 1e9:
            raise self.error(f"its unit is {metres:g} m")
        instance = self.root.find("scene/instance_visual_scene")
        scene = None if instance is None else self.named.get(instance.get("url", "")[1:])
        scene = self.root.find("library_visual_scenes/visual_scene") if scene is None else scene
        start = np.diag([metres, metres, metres, 1.0])
        if scene is not None:
            for node in scene.findall("node"):
                self.node(node, start, 0)
        if not self.shown:
            for geometry in self.root.findall("library_geometries/geometry"):
                self.geometry(geometry, start)
        if not self.faces:
            return np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)
        return np.concatenate(self.vertices), np.concatenate(self.faces)

    def node(self, node: ElementTree.Element, above: Array, depth: int) -> None:
        """Return the triangles that a node shows, in a frame in which it stands by `above` (4, 4)
        and its own transforms.
        """
        if depth > _MOST_DEPTH:
            raise self.error("its nodes are nested too deeply")
        matrix = above
        for child in node:
            if child.tag in _TRANSFORMS:
                length, transform = _TRANSFORMS[child.tag]
                matrix = matrix @ transform(
                    self.numbers(child.text or "", f"<{child.tag}>", length)
                )
        for child in node:
            if child.tag == "node":
                self.node(child, matrix, depth + 1)
            elif child.tag in ("instance_geometry", "instance_node", "instance_controller"):
                self.shown += 1
                if self.shown > _MOST_INSTANCES:
                    raise self.error(f"it shows more than {_MOST_INSTANCES} things")
                self.instance(child, matrix, depth)

    def instance(self, instance: ElementTree.Element, matrix: Array, depth: int) -> None:
        target = self.named.get(instance.get("url", "")[1:])
        if target is not None and target.tag == "controller":
            skin = target.find("skin")
            target = None if skin is None else self.named.get(skin.get("source", "")[1:])
        if target is None:
            raise self.error(f"it shows '{instance.get('url', '')[:60]}', which it does not hold")
        if target.tag == "node":
            self.node(target, matrix, depth + 1)
        elif target.tag == "geometry":
            self.geometry(target, matrix)

    def geometry(self, geometry: ElementTree.Element, matrix: Array) -> None:
        """Return the triangles of a geometry; lines and splines are passed over."""
        mesh = geometry.find("mesh")
        if mesh is None:
            return
        for kind in ("triangles", "polylist", "polygons", "trifans", "tristrips"):
            for group in mesh.findall(kind):
                self.group(group, matrix)

    def group(self, group: ElementTree.Element, matrix: Array) -> None:
        inputs = group.findall("input")
        stride = 1 + max((self.whole(one.get("offset", "0")) for one in inputs), default=0)
        vertex = next((one for one in inputs if one.get("semantic") == "VERTEX"), None)
        if vertex is None or stride > 64:
            raise self.error("triangles without corners")

        offset = self.whole(vertex.get("offset", "0"))
        positions = self.positions(vertex.get("source", "")[1:])

        lists = [self.indices(one.text)[offset::stride] for one in group.findall("p")]
        lists += [self.indices(one.text)[offset::stride] for one in group.findall("ph/p")]
        counts = self.indices(group.findtext("vcount"))
        faces = [_faces(group.tag, corners, counts) for corners in lists]

        joined = np.concatenate(faces) if faces else np.zeros((0, 3), dtype=np.int64)
        if not len(joined):
            return
        if joined.min() < 0 or joined.max() >= len(positions):
            raise self.error("a face names a missing corner")

        if np.linalg.det(matrix[:3, :3]) < 0:  # mirrored: what was outside must stay outside
            joined = joined[:, ::-1]

        self.vertices.append(positions @ matrix[:3, :3].T + matrix[:3, 3])
        self.faces.append(joined + self.count)
        self.count += len(positions)

    def positions(self, source: str) -> Array:
        """Return the corners (n, 3) of a <source>, or of the <vertices> that name one."""
        element = self.named.get(source)
        if element is not None and element.tag == "vertices":
            inputs = [one for one in element.findall("input") if one.get("semantic") == "POSITION"]
            element = self.named.get(inputs[0].get("source", "")[1:]) if inputs else None
        array = None if element is None else element.find("float_array")
        if element is None or array is None:
            raise self.error("it has no positions of its corners")
        accessor = element.find("technique_common/accessor")
        stride = 3 if accessor is None else self.whole(accessor.get("stride", "3"))
        start = 0 if accessor is None else self.whole(accessor.get("offset", "0"))
        numbers = np.array(self.numbers(array.text or "", "<float_array>", None))[start:]
        if stride < 3 or len(numbers) < 3:
            raise self.error("its corners have no three coordinates")
        whole = len(numbers) - len(numbers) % stride
        return numbers[:whole].reshape(-1, stride)[:, :3]

    def indices(self, text: str | None) -> NDArray[np.int64]:
        try:
            return np.array((text or "").split(), dtype=np.int64)
        except (ValueError, OverflowError):
            raise self.error("the list of a face's corners is not made of whole numbers") from None

    def numbers(self, text: str, where: str, count: int | None) -> list[float]:
        try:
            values = [float(word) for word in text.split()]
        except ValueError:
            raise self.error(f"{where} is not made of numbers") from None
        if count is not None and len(values) != count:
            raise self.error(f"{where} has {len(values)} numbers, not {count}")
        return values

    def whole(self, text: str) -> int:
        if not text.isdecimal() or len(text) > 9:
            raise self.error(f"'{text[:20]}' is no whole number")
        return int(text)

    def error(self, why: str) -> InputError:
        return InputError(f"cannot read the mesh '{self.path.name}': {why}")


def _faces(kind: str, corners: NDArray[np.int64], counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the triangles (m, 3) of one list of corners."""
    if kind == "triangles":
        return corners[: len(corners) - len(corners) % 3].reshape(-1, 3)
    if kind == "tristrips":
        strip = [corners[i : i + 3][:: -1 if i % 2 else 1] for i in range(len(corners) - 2)]
        return np.array(strip, dtype=np.int64).reshape(-1, 3)
    if kind != "polylist":  # one polygon or fan a list
        counts = np.array([len(corners)], dtype=np.int64)
    starts = np.cumsum(np.concatenate([[0], counts]))
    fans: list[NDArray[np.int64]] = []
    for size in np.unique(counts):
        first = starts[:-1][counts == size]
        first = first[first + size <= len(corners)]
        fans += [
            np.stack([corners[first], corners[first + i], corners[first + i + 1]], axis=1)
            for i in range(1, int(size) - 1)
        ]
    return np.concatenate(fans) if fans else np.zeros((0, 3), dtype=np.int64)


def _translate(values: list[float]) -> Array:
    matrix = np.eye(4)
    matrix[:3, 3] = values
    return matrix


def _rotate(values: list[float]) -> Array:
    """Return the rotation about an axis by degrees (Rodrigues)."""
    axis, angle = np.array(values[:3]), np.radians(values[3])
    axis = axis / max(float(np.linalg.norm(axis)), 1e-12)
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    matrix = np.eye(4)
    matrix[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return matrix


_TRANSFORMS = {
    "matrix": (16, lambda values: np.array(values).reshape(4, 4)),
    "translate": (3, _translate),
    "rotate": (4, _rotate),
    "scale": (3, lambda values: np.diag([*values, 1.0])),
}
