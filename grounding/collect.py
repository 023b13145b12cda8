"""Demonstrations of a relation of one's own: scenes as problem files, with what holds in them as
their goal.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grounding.dataset import Dataset
from grounding.relation_scene import Region, region_of
from grounding.relational.measures import RegionFrame
from grounding.relations.demonstration_file import (
    Demonstration,
    demonstration_files,
    read_labels,
)
from grounding.variety import contradictions
from tamp.errors import InputError
from tamp.geometric.loading.load import load_scene
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Part
from tamp.geometric.stability.stable_poses import SNAP_TILT_RAD

KINDS = ("holds", "does not hold")

HANGS = 0.005
"""Metres by which a body may be off its place: physics leaves a millimetre or two."""


def collect(relation: str, demonstrations: Iterable[Demonstration]) -> Dataset:
    """Collect demonstrations into a data set, for `tamp-learn train` and `grounding.train.train`.

    Args:
        relation: Its name.
        demonstrations: In the order in which `--samples` takes them.

    Raises:
        InputError: There are none, arguments that are not a body and a surface or container of
            another one, or the same situation is said to hold and not to hold.
    """
    sources: list[str] = []
    rows: list[tuple[bool, Region, list[tuple[int, Array]]]] = []
    templates: dict[tuple[Part, ...], str] = {}
    numbers: dict[tuple[Part, ...], int] = {}
    for number, one in enumerate(demonstrations):
        sources.append(one.source or f"demonstration {number + 1}")
        bodies, region = _bodies(one)
        placed: list[tuple[int, Array]] = []
        for name in bodies:
            body = one.scene.bodies[name]
            if body.parts not in numbers:
                numbers[body.parts] = len(numbers)
                taken = sum(other.partition("#")[0] == name for other in templates.values())
                templates[body.parts] = f"{name}#{taken + 1}" if taken else name
            placed.append((numbers[body.parts], body.pose.matrix))
        rows.append((one.holds, region, placed))

    if not rows:
        raise InputError(f"no demonstrations of '{relation}'")
    arrays = _arrays(rows)
    by_type = {kind: int((arrays["kind"] == row).sum()) for row, kind in enumerate(KINDS)}
    card = {
        "relation": relation,
        "split": "train",
        "count": len(rows),
        "by type": by_type,
        "feasible": 1.0,
    }
    data = Dataset(arrays, {name: parts for parts, name in templates.items()}, KINDS, card)
    data.sources = tuple(sources)
    for first, second in contradictions(data):
        places = f"{sources[first]} and {sources[second]}"
        what = f"'{relation}' is said to hold and not to hold in the same situation: {places}"
        raise InputError(what, remedy="Take one of the two away")

    return data


def unstable(data: Dataset) -> list[str]:
    """Return warnings of bodies for which the relation holds where no plan will put them, each with
    its first place.

    They stand on none of their stable faces, hang in the air, or are sunk into the place.
    """
    found: Counter[tuple[str, str]] = Counter()
    first: dict[tuple[str, str], str] = {}
    for row, example in enumerate(data):
        if not example.holds:
            continue
        view = RegionFrame(example.situation)
        measured = view.measure((view.T_region_world @ example.situation.body.matrix)[None])
        low, nearest = float(measured.low[0, 2]), float(measured.nearest[0])
        wrong: list[str] = []
        if not len(view.faces) or np.linalg.norm(measured.tilt) > math.sin(SNAP_TILT_RAD):
            wrong.append("stands on none of its stable faces")
        if min(low, nearest) > HANGS:
            wrong.append(f"hangs {low * 1e3:.0f} mm above the place")
        if low < -HANGS:
            wrong.append(f"is sunk {-low * 1e3:.0f} mm into the place")
        for what in wrong:
            entry = (example.names[1], what)
            found[entry] += 1
            first.setdefault(entry, data.sources[row] if data.sources else f"row {row}")

    return [
        f"{first[name, what]}: {name} {what} ({count} scene{'s' * (count > 1)}): "
        f"no plan will put it down so"
        for (name, what), count in found.items()
    ]


def read_demonstrations(relation: str, files: Sequence[Path]) -> Iterator[Demonstration]:
    """Read demonstrations from problem files: every `(RELATION body place)` and `(not (RELATION
    body place))` in their goals.

    Args:
        relation: Its name.
        files: Problem files; of a folder all its .yaml files.

    Raises:
        InputError: A file is no problem, or its goal says nothing of the relation, or what it says
            is not about a body and a surface or container.
    """
    for path in demonstration_files(files):
        loaded = load_scene(path, demonstration=True)
        for label in read_labels(loaded, relation):
            where = f"{path}:{label.line}:{label.column}"
            demonstration = Demonstration(loaded.scene, label.arguments, label.holds, where)
            try:
                _bodies(demonstration)
            except InputError as found:
                raise found.at(path, label.line) from None
            yield demonstration


def _bodies(one: Demonstration) -> tuple[list[str], Region]:
    """Return the bodies of a scene, what the place is of first, then the body, then the others; and
    the place.
    """
    scene = one.scene
    if len(one.arguments) != 2:
        raise InputError(
            "a demonstration names a body, and a surface or container",
            remedy="Of one body, or of several, learn it so: tamp-learn new NAME --demos FOLDER",
        )
    name, place_name = one.arguments
    if name not in scene.bodies:
        raise InputError(f"'{name}' is no body", found=name, choices=scene.bodies)
    place = scene.surfaces.get(place_name) or scene.cavities.get(place_name)
    if place is None:
        choices = (*scene.surfaces, *scene.cavities)
        raise InputError(
            f"'{place_name}' is no surface or container", found=place_name, choices=choices
        )
    if place.body == name:
        raise InputError(f"'{place_name}' is a part of '{name}' itself")
    others = [other for other in scene.bodies if other not in (name, place.body)]
    return [place.body, name, *others], region_of(scene.bodies[place.body], place)


def _arrays(
    rows: Sequence[tuple[bool, Region, list[tuple[int, Array]]]],
) -> dict[str, NDArray[Any]]:
    count, most = len(rows), max(len(placed) for _, _, placed in rows)
    arrays: dict[str, NDArray[Any]] = {
        "holds": np.array([holds for holds, _, _ in rows]),
        "kind": np.array(
            [KINDS.index("holds" if holds else "does not hold") for holds, _, _ in rows],
            dtype=np.int8,
        ),
        "feasible": np.ones(count, dtype=bool),
        "body": np.full((count, most), -1, dtype=np.int16),
        "scale": np.ones((count, most)),
        "pose": np.tile(np.eye(4), (count, most, 1, 1)),
        "hollow": np.array([region.hollow for _, region, _ in rows]),
        "region": np.stack([region.matrix for _, region, _ in rows]),
        "size": np.stack([region.size for _, region, _ in rows]),
        "box": np.stack([region.box for _, region, _ in rows]),
    }
    for row, (_, _, placed) in enumerate(rows):
        arrays["body"][row, : len(placed)] = [number for number, _ in placed]
        arrays["pose"][row, : len(placed)] = [matrix for _, matrix in placed]

    return arrays
