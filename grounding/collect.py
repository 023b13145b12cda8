"""Demonstrations of a relation of one's own: scenes as problem files, with what holds in them as
their goal.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grounding.dataset import Dataset
from grounding.relation_scene import Region, region_of
from grounding.relational.measures import RegionFrame
from grounding.variety import contradictions
from tamp.errors import InputError
from tamp.geometric.loading.load import load_scene
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Part, Scene
from tamp.geometric.stability.stable_poses import SNAP_TILT
from tamp.symbolic.pddl.nodes import Group, Node, Symbol, error
from tamp.symbolic.pddl.sexpr import read

KINDS = ("holds", "does not hold")

HANGS = 0.005
"""Metres by which a body may be off its place: physics leaves a millimetre or two."""


@dataclass(frozen=True, eq=False)
class Demonstration:
    """A scene in which a relation holds, or does not.

    Attributes:
        scene: Everything stands where the label is about.
        arguments: The relation's: a body, and the surface or container that it stands to.
        holds: The label.
        source: Where it is said, for messages: "lying.yaml:9".
    """

    scene: Scene
    arguments: tuple[str, str]
    holds: bool = True
    source: str = ""


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
        if not len(view.faces) or np.linalg.norm(measured.tilt) > math.sin(SNAP_TILT):
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
    for path in _files(files):
        loaded = load_scene(path)
        goal = loaded.goal
        said: list[Demonstration] = []
        for form in read(goal.text, path, line_offset=goal.line - 1, column_offset=goal.column - 1):
            for group, holds in _facts(form, relation.lower()):
                where = f"{path}:{group.place.line}:{group.place.column}"
                demonstration = Demonstration(
                    loaded.scene, _names(group, loaded.scene), holds, where
                )
                try:
                    _bodies(demonstration)
                except InputError as found:
                    raise found.at(path, group.place.line) from None
                said.append(demonstration)

        if not said:
            remedy = f"goal: ({relation} BODY PLACE), or goal: (not ({relation} BODY PLACE))"
            raise InputError(
                f"the goal says nothing of '{relation}'", file=path, line=goal.line, remedy=remedy
            )

        yield from said


def _files(files: Sequence[Path]) -> Iterator[Path]:
    for path in files:
        if not path.is_dir():
            yield path
            continue
        inside = sorted(path.glob("*.yaml"))
        if not inside:
            raise InputError("no .yaml files in this folder", file=path)
        yield from inside


def _facts(form: Node, relation: str, holds: bool = True) -> Iterator[tuple[Group, bool]]:
    """Yield the relation's facts in a formula, and whether they are asserted or denied."""
    if isinstance(form, Symbol):
        return
    if form.head == relation:
        yield form, holds
    elif form.head in ("and", "not"):
        for part in form.items[1:]:
            yield from _facts(part, relation, holds != (form.head == "not"))


def _names(group: Group, scene: Scene) -> tuple[str, str]:
    known = {name.lower(): name for name in (*scene.bodies, *scene.surfaces, *scene.cavities)}
    words = [part for part in group.items[1:] if isinstance(part, Symbol)]
    if len(words) != 2 or len(group.items) != 3:
        raise error(group.place, "a demonstration names a body, and a surface or container")
    for word in words:
        if word.text not in known:
            raise error(
                word, f"unknown object '{word.written}'", found=word.written, choices=known.values()
            )
    return known[words[0].text], known[words[1].text]


def _bodies(one: Demonstration) -> tuple[list[str], Region]:
    """Return the bodies of a scene, what the place is of first, then the body, then the others; and
    the place.
    """
    scene, (name, place_name) = one.scene, one.arguments
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
