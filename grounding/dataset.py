"""Labelled situations on disk: NAME.npz with the scenes, NAME.json, the card, with what is in them.

A data set is self-contained: it carries the geometry of its bodies, so that nothing else is needed
to train on it.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grounding.body_geometry import BodyGeometry
from grounding.checks import check_arrays, check_card
from grounding.pair import read_pair, write_pair
from grounding.relation_scene import Placed, Region, RelationScene, near
from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Hull, Part, Sphere
from tamp.system.npz import read_npz

FORMAT = "tamp demonstrations 1"
"""What the card's `format` must say."""

MOST_BYTES = 400_000_000
"""Of all arrays together, unpacked: 200,000 scenes."""

MOST_ARRAYS = 100
"""Of a file; a data set has about twenty."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Example:
    """One labelled scene.

    Attributes:
        situation: The body stands where the label is about.
        holds: Whether the relation holds.
        kind: The sample's type, such as "among others" or "floating".
        names: The bodies' templates: the support, the body, the others.
        scales: Of those bodies, in the same order.
    """

    situation: RelationScene
    holds: bool
    kind: str
    names: tuple[str, ...]
    scales: tuple[float, ...]


class Dataset:
    """A sequence of examples, made when they are asked for.

    Args:
        examples: As many rows of each array: `holds`, `kind`, `body` (n, b), -1 for none, `scale`
            (n, b), `pose` (n, b, 4, 4), and the region's `hollow`, `region` (n, 4, 4), `size` (n,
            3), `box` (n, 2, 3).
        templates: Name to the parts of a body of scale 1.
        kinds: The names of the types of samples.
        card: Relation, seed, commit, counts, splits.

    Attributes:
        sources: Where each row is from, for messages, as far as that is known: "lying.yaml:9"; it
            is not written.
    """

    def __init__(
        self,
        examples: Mapping[str, NDArray[Any]],
        templates: Mapping[str, tuple[Part, ...]],
        kinds: Sequence[str],
        card: Mapping[str, Any],
    ) -> None:
        self.arrays, self.templates, self.kinds, self.card = (
            dict(examples),
            dict(templates),
            tuple(kinds),
            dict(card),
        )
        self.sources: tuple[str, ...] = ()
        self._names = tuple(templates)
        self._forms: dict[str, BodyGeometry] = {}

    @property
    def relation(self) -> str:
        """Return the relation that the labels are about."""
        return str(self.card["relation"])

    @cached_property
    def holds(self) -> NDArray[np.bool_]:
        """Return the labels, shape (n,)."""
        return self.arrays["holds"].astype(bool)

    def __len__(self) -> int:
        return len(self.arrays["holds"])

    def __iter__(self) -> Iterator[Example]:
        return (self[index] for index in range(len(self)))

    def __getitem__(self, index: int) -> Example:
        a = self.arrays
        rows = np.flatnonzero(a["body"][index] >= 0)
        names = tuple(self._names[a["body"][index, row]] for row in rows)
        scales = tuple(float(a["scale"][index, row]) for row in rows)
        placed = [
            Placed(self._form(name, scale), a["pose"][index, row])
            for name, scale, row in zip(names, scales, rows, strict=True)
        ]
        region = Region(
            bool(a["hollow"][index]), a["region"][index], a["size"][index], a["box"][index]
        )
        return Example(
            near(placed[0], region, placed[1], placed[2:]),
            bool(self.holds[index]),
            self.kinds[a["kind"][index]],
            names,
            scales,
        )

    def take(self, indices: NDArray[np.intp] | Sequence[int]) -> Dataset:
        """Return the examples at these indices."""
        chosen = np.asarray(indices)
        return Dataset(
            {k: v[chosen] for k, v in self.arrays.items()}, self.templates, self.kinds, self.card
        )

    def form(self, row: int, body: int) -> BodyGeometry:
        """Return the geometry of a scene's body: 0 for what the place is of, 1 for the relation's
        body, then the others.
        """
        return self._form(
            self._names[self.arrays["body"][row, body]], float(self.arrays["scale"][row, body])
        )

    def _form(self, name: str, scale: float) -> BodyGeometry:
        if name not in self._forms:
            self._forms[name] = BodyGeometry(self.templates[name])
        return self._forms[name].scaled(scale)


def write_dataset(path: Path, data: Dataset) -> None:
    """Write `path` (.npz) and its card beside it; the same data give the same bytes.

    Raises:
        OSError: The folder cannot be made or written.
    """
    card = {
        "format": FORMAT,
        **data.card,
        "kinds": list(data.kinds),
        "templates": list(data.templates),
    }
    arrays = {**data.arrays, **_packed(tuple(data.templates.values()))}
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, array in sorted(arrays.items()):
            entry = zipfile.ZipInfo(f"{name}.npy", date_time=(1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            content = io.BytesIO()
            np.lib.format.write_array(content, np.ascontiguousarray(array), allow_pickle=False)
            archive.writestr(entry, content.getvalue())
    write_pair(path, buffer.getvalue(), card)


def read_dataset(path: Path) -> Dataset:
    """Read the data set at `path`.

    Raises:
        InputError: A file is missing, damaged or of another format, the two do not belong together,
            or an array is not what it should be; then with the array and its row.
    """
    remedy = "Generate it again: tamp-learn generate --help, or collect it again"
    pair = read_pair(path, FORMAT, what="data set", most=MOST_BYTES, remedy=remedy)
    card = pair.card
    try:
        check_card(card)
    except InputError as error:
        raise InputError(error.message, file=path.with_suffix(".json"), remedy=remedy) from None

    try:
        arrays = read_npz(pair.content, most_bytes=MOST_BYTES, most_members=MOST_ARRAYS)
        check_arrays(arrays, card)
        geometry = _unpacked({name: arrays.pop(name) for name in _GEOMETRY})
        templates = dict(zip(card.pop("templates"), geometry, strict=True))
    except InputError as error:
        raise InputError(
            f"the data set is damaged: {error.message}", file=path, remedy=remedy
        ) from None
    except (ValueError, ArithmeticError) as error:  # a hull that is none
        raise InputError(f"the data set is damaged: {error}", file=path, remedy=remedy) from None

    if pair.stranger is not None:
        raise pair.stranger
    return Dataset(arrays, templates, card.pop("kinds"), card)


_GEOMETRY = (
    "part_template",
    "part_shape",
    "part_size",
    "part_pose",
    "part_vertices",
    "part_faces",
    "vertices",
    "faces",
)
_SHAPES = (Box, Cylinder, Sphere, Hull)


def _packed(templates: Sequence[tuple[Part, ...]]) -> dict[str, NDArray[Any]]:
    """Flatten parts into arrays: whose, which shape, its sizes, T_body_part, and how many rows of
    `vertices` and `faces`.
    """
    rows: list[tuple[Any, ...]] = []
    vertices, faces = [np.zeros((0, 3))], [np.zeros((0, 3), dtype=np.int64)]
    for number, parts in enumerate(templates):
        for part in parts:
            shape = part.shape
            size: tuple[float, ...] = (0.0, 0.0, 0.0)
            if isinstance(shape, Box):
                size = shape.size
            elif isinstance(shape, Cylinder):
                size = (shape.radius, shape.height, 0.0)
            elif isinstance(shape, Sphere):
                size = (shape.radius, 0.0, 0.0)
            else:
                vertices.append(shape.vertices)
                faces.append(np.asarray(shape.faces, dtype=np.int64))

            counts = (len(vertices[-1]), len(faces[-1])) if isinstance(shape, Hull) else (0, 0)
            pose = (*part.pose.position, *part.pose.quaternion)
            rows.append((number, _SHAPES.index(type(shape)), size, pose, *counts))

    columns = [np.array(column) for column in zip(*rows, strict=True)]
    return dict(
        zip(_GEOMETRY, [*columns, np.concatenate(vertices), np.concatenate(faces)], strict=True)
    )


def _unpacked(arrays: Mapping[str, NDArray[Any]]) -> list[tuple[Part, ...]]:
    """Rebuild the parts from arrays, the inverse of `_packed`."""
    templates: list[list[Part]] = [[] for _ in range(int(arrays["part_template"].max()) + 1)]
    vertex = face = 0
    for row, number in enumerate(arrays["part_template"]):
        kind, (a, b, c) = _SHAPES[arrays["part_shape"][row]], arrays["part_size"][row].tolist()
        x, y, z, *quaternion = arrays["part_pose"][row].tolist()
        count, triangles = int(arrays["part_vertices"][row]), int(arrays["part_faces"][row])
        if kind is Box:
            shape = Box((a, b, c))
        elif kind is Cylinder:
            shape = Cylinder(a, b)
        elif kind is Sphere:
            shape = Sphere(a)
        else:
            shape = Hull(
                arrays["vertices"][vertex : vertex + count],
                arrays["faces"][face : face + triangles],
            )

        vertex, face = vertex + count, face + triangles
        qx, qy, qz, qw = quaternion
        templates[number].append(Part(shape, Pose((x, y, z), (qx, qy, qz, qw))))

    return [tuple(parts) for parts in templates]
