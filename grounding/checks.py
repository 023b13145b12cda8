"""Validation of a data set's arrays: every row, type, shape and range, before anything is made of
them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tamp.errors import InputError

Arrays = Mapping[str, NDArray[Any]]

FARTHEST_M = 1e4
"""No body of a scene is farther from its origin, metres."""

LARGEST_SIZE_M = 1e3
"""No body or place is larger, metres, and no scale, a factor."""

RIGIDITY_TOLERANCE = 1e-4
"""By so much the entries of R^T R of a pose's rotation R may differ from those of the identity."""

SCENE_COLUMNS: Mapping[str, tuple[str, tuple[int | str, ...]]] = {
    "holds": ("b", ()),
    "kind": ("i", ()),
    "body": ("i", ("b",)),
    "scale": ("f", ("b",)),
    "pose": ("f", ("b", 4, 4)),
    "hollow": ("b", ()),
    "region": ("f", (4, 4)),
    "size": ("f", (3,)),
    "box": ("f", (2, 3)),
}
"""Of each array with a row a scene: b for truth values, i for integers, f for numbers, and the
shape of a row.
"""

PART_COLUMNS: Mapping[str, tuple[str, tuple[int | str, ...]]] = {
    "part_template": ("i", ()),
    "part_shape": ("i", ()),
    "part_size": ("f", (3,)),
    "part_pose": ("f", (7,)),
    "part_vertices": ("i", ()),
    "part_faces": ("i", ()),
}
"""The same of those with a row a part of a body."""

HULL_COLUMNS: Mapping[str, tuple[str, tuple[int | str, ...]]] = {
    "vertices": ("f", (3,)),
    "faces": ("i", (3,)),
}
"""The same of the hulls' corners and triangles."""

SCENES_PER_BLOCK = 4096
"""Scenes whose poses are checked at a time, so that the check takes little memory."""

BOX, CYLINDER, SPHERE, HULL = range(4)
"""The numbers of the shapes in `part_shape`."""

KIND_WORDS = {"b": "truth values (0 or 1)", "i": "integers", "f": "numbers"}


def check_card(card: Mapping[str, Any]) -> None:
    """Refuse a data set's card whose entries are of other kinds.

    Raises:
        InputError: Which entry, and what it should be.
    """
    relation = card.get("relation")
    if (
        not isinstance(relation, str)
        or not relation
        or not relation.isprintable()
        or len(relation) > 200
    ):
        raise InputError(f"'relation' of the card is {_shown(relation)}, not a name")

    for name in ("kinds", "templates"):
        found = card.get(name)
        if (
            not isinstance(found, list)
            or not found
            or not all(isinstance(one, str) for one in found)
        ):
            raise InputError(f"'{name}' of the card is {_shown(found)}, not a list of names")

    if len(set(card["templates"])) != len(card["templates"]):
        raise InputError("'templates' of the card has a name twice")
    for name in ("count", "seed"):
        if name in card and (
            not isinstance(card[name], int) or isinstance(card[name], bool) or card[name] < 0
        ):
            raise InputError(f"'{name}' of the card is {_shown(card[name])}, not a number")

    if not isinstance(card.get("split", ""), str):
        raise InputError(f"'split' of the card is {_shown(card['split'])}, not a name")
    if not isinstance(card.get("by type", {}), dict):
        raise InputError(f"'by type' of the card is {_shown(card['by type'])}, not counts by name")


def check_arrays(arrays: Arrays, card: Mapping[str, Any]) -> None:
    """Refuse arrays that are no data set of this card.

    Args:
        arrays: All of a file.
        card: As `check_card` left it.

    Raises:
        InputError: The first array that is wrong, and its row, counted from 0.
    """
    for name in (*SCENE_COLUMNS, *PART_COLUMNS, *HULL_COLUMNS):
        if name not in arrays:
            raise InputError(f"array '{name}' is missing")
    scenes, bodies = _length(arrays, "holds"), 0
    if arrays["body"].ndim == 2:
        bodies = arrays["body"].shape[1]
    if scenes == 0:
        raise InputError("it has no scene")
    for names, length in (
        (SCENE_COLUMNS, scenes),
        (PART_COLUMNS, _length(arrays, "part_template")),
        (HULL_COLUMNS, None),
    ):
        for name, (kind, row) in names.items():
            _check(
                name, arrays[name], kind, tuple(bodies if n == "b" else int(n) for n in row), length
            )
    for name, array in arrays.items():
        if name not in (*SCENE_COLUMNS, *PART_COLUMNS, *HULL_COLUMNS) and (
            array.ndim == 0 or len(array) != scenes
        ):
            rows = len(array) if array.ndim else 1
            raise InputError(f"array '{name}' has {rows:,} rows, 'holds' has {scenes:,}")
        if name not in (*SCENE_COLUMNS, *PART_COLUMNS, *HULL_COLUMNS) and array.dtype.kind == "f":
            _refuse(name, ~np.isfinite(array), "is not finite")
    if card.get("count", scenes) != scenes:
        raise InputError(f"the card says {card['count']:,} scenes, array 'holds' has {scenes:,}")

    _check_scenes(arrays, len(card["kinds"]), len(card["templates"]))
    _check_parts(arrays, len(card["templates"]))


def _check_scenes(arrays: Arrays, kinds: int, templates: int) -> None:
    kind, body, size, box = (arrays[name] for name in ("kind", "body", "size", "box"))
    _refuse("kind", (kind < 0) | (kind >= kinds), f"is none of the card's {kinds} kinds")
    _refuse(
        "body",
        (body < -1) | (body >= templates),
        f"is none of the card's {templates} templates, nor -1 for none",
    )
    if body.shape[1] < 2:
        raise InputError("array 'body' has no room for two arguments")
    _refuse("body", body[:, :2] < 0, "is missing: a scene has two arguments")
    there = body >= 0
    scale = arrays["scale"]
    _refuse("scale", there & ~((scale > 0.0) & (scale <= LARGEST_SIZE_M)), "is no scale")
    _check_rigid("pose", arrays["pose"])
    _check_rigid("region", arrays["region"])
    _refuse("size", ~(size[:, :2] > 0.0) | (size[:, :2] > LARGEST_SIZE_M), "is no size")
    _refuse("size", ~(size[:, 2] > 0.0), "is no height")  # that above an open surface is infinite
    _refuse("box", ~(np.abs(box) <= FARTHEST_M), "is too far away")
    _refuse("box", box[:, 0] > box[:, 1], "is beyond the other corner")


def _check_parts(arrays: Arrays, templates: int) -> None:
    template, shape, size, pose = (
        arrays[f"part_{name}"] for name in ("template", "shape", "size", "pose")
    )
    _refuse(
        "part_template",
        (template < 0) | (template >= templates),
        f"is none of the card's {templates} templates",
    )
    without = np.setdiff1d(np.arange(templates), template)
    if len(without):
        raise InputError(f"array 'part_template': template {without[0]} of the card has no part")
    _refuse("part_shape", (shape < 0) | (shape > HULL), "is none of box, cylinder, sphere, hull")
    lengths = np.array([3, 2, 1, 0])[shape]
    used = np.arange(3) < lengths[:, None]
    _refuse("part_size", used & ~((size > 0.0) & (size <= LARGEST_SIZE_M)), "is no length")
    _refuse("part_pose", ~(np.abs(pose[:, :3]) <= FARTHEST_M), "is too far away")
    _refuse(
        "part_pose",
        ~(np.abs(np.linalg.norm(pose[:, 3:], axis=1) - 1.0) <= RIGIDITY_TOLERANCE),
        "is no unit quaternion",
    )

    hull = shape == HULL
    counts = {name: arrays[f"part_{name}"] for name in ("vertices", "faces")}
    for name, count in counts.items():
        _refuse(f"part_{name}", (count < 0) | (~hull & (count != 0)), "is no count of a hull")
        rows = len(arrays[name])
        _refuse(f"part_{name}", count > rows, f"is more than the {rows:,} rows of '{name}'")
        if int(count.sum()) != rows:
            raise InputError(
                f"array 'part_{name}' counts {int(count.sum()):,}, '{name}' has {rows:,} rows"
            )
    _refuse("part_vertices", hull & (counts["vertices"] < 4), "says fewer corners than a solid has")
    _refuse("part_faces", hull & (counts["faces"] < 4), "says fewer triangles than a solid has")
    _refuse("vertices", ~(np.abs(arrays["vertices"]) <= FARTHEST_M), "is too far away")
    most = np.repeat(counts["vertices"], counts["faces"])[:, None]
    _refuse(
        "faces", (arrays["faces"] < 0) | (arrays["faces"] >= most), "is none of its hull's corners"
    )


def _check(
    name: str, array: NDArray[Any], kind: str, row: Sequence[int], length: int | None
) -> None:
    allowed = {"b": "biu", "i": "iu", "f": "f"}[kind]
    if array.dtype.kind not in allowed:
        raise InputError(f"array '{name}' holds '{array.dtype}', not {KIND_WORDS[kind]}")
    if array.ndim != 1 + len(row) or array.shape[1:] != tuple(row):
        wanted = "rows" if not row else f"rows of shape {'x'.join(map(str, row))}"
        raise InputError(
            f"array '{name}' has shape {'x'.join(map(str, array.shape)) or 'of one number'}, "
            f"not {wanted}"
        )
    if length is not None and len(array) != length:
        other = "holds" if name in SCENE_COLUMNS else "part_template"
        raise InputError(f"array '{name}' has {len(array):,} rows, '{other}' has {length:,}")
    if kind == "b" and array.dtype.kind != "b":
        _refuse(name, (array < 0) | (array > 1), "is neither 0 nor 1")
    if kind == "f" and name != "size":
        _refuse(name, ~np.isfinite(array), "is not finite")
    if name == "size":
        _refuse(name, np.isnan(array), "is not a number")


def _check_rigid(name: str, matrices: NDArray[Any]) -> None:
    """Check that T_world_body or T_body_region, shape (..., 4, 4), are rigid transforms."""
    _refuse(
        name,
        np.asarray(~(np.abs(matrices[..., :3, 3]) <= FARTHEST_M).all(axis=-1)),
        "is too far away",
    )
    wrong = np.zeros(matrices.shape[:-2], dtype=bool)
    for start in range(0, len(matrices), SCENES_PER_BLOCK):
        some = matrices[start : start + SCENES_PER_BLOCK]
        turn = some[..., :3, :3]
        product = np.swapaxes(turn, -1, -2) @ turn
        wrong[start : start + SCENES_PER_BLOCK] = (
            ~(np.abs(product - np.eye(3)) <= RIGIDITY_TOLERANCE).all(axis=(-1, -2))
            | ~(np.linalg.det(turn) > 0.0)
            | ~(np.abs(some[..., 3, :] - [0.0, 0.0, 0.0, 1.0]) <= RIGIDITY_TOLERANCE).all(axis=-1)
        )
    _refuse(name, wrong, "is no pose: a rotation and a place")


def _refuse(name: str, wrong: NDArray[np.bool_], what: str) -> None:
    """Raise an error that names the first entry that is wrong."""
    if wrong.any():
        row, *others = (int(index) for index in np.argwhere(wrong)[0])
        where = f"row {row}" + (f", entry {', '.join(map(str, others))}" if others else "")
        raise InputError(f"array '{name}', {where}: it {what}")


def _length(arrays: Arrays, name: str) -> int:
    return len(arrays[name]) if arrays[name].ndim else 0


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 40 else f"{text[:37]}..."
