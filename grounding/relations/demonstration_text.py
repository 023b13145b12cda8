"""Writing demonstration files, and taking up again what one says of each body."""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from grounding.relations.demonstration_file import Label
from tamp.errors import InputError
from tamp.geometric.loading.bodies import PLACEMENT_KEYS
from tamp.geometric.loading.declared_places import NAME
from tamp.geometric.loading.load import load_scene
from tamp.geometric.loading.meshes import find_mesh
from tamp.geometric.loading.yaml_file import read_yaml
from tamp.geometric.loading.yaml_nodes import YamlNode
from tamp.geometric.scene.pose import Pose
from tamp.system.outputs import write_whole

ROBOT = "{model: panda_mobile, base: [0.0, 0.0, 0 deg]}"
"""Any robot, so that a demonstration is a whole problem file; no relation depends on it."""

ROOM = "{x: [-5.0, 5.0], y: [-5.0, 5.0]}"

PLAIN = re.compile(r"[A-Za-z_./][A-Za-z0-9_./-]*")
"""Words that need no quotes in YAML, but for those that YAML reads otherwise."""


@dataclass(frozen=True)
class BodyEntry:
    """A body as a demonstration file describes it.

    Attributes:
        shape: The keys of docs/problem-format.md but for those that say where it is: {"box": [0.1,
            0.1, 0.2], "colour": "red"}, {"furniture": "table", "size": [1.2, 0.7, 0.7]}.
        pose: T_world_body.
    """

    shape: Mapping[str, Any]
    pose: Pose


@dataclass(frozen=True)
class DemonstrationFile:
    """A demonstration file: bodies where they are, and what holds.

    Attributes:
        bodies: By name, in the file's order.
        labels: What is said of them.
        note: One line of text for the reader.
    """

    bodies: Mapping[str, BodyEntry]
    labels: Sequence[Label]
    note: str = ""


def write_demonstration(path: Path, shown: DemonstrationFile) -> None:
    """Write a demonstration file, whole or not at all; what is written is read again.

    Raises:
        InputError: Names that a problem file does not take, no label, numbers that are not finite.
        OSError: The folder cannot be made or written.
    """
    write_whole(path, demonstration_text(shown).encode())


def demonstration_text(shown: DemonstrationFile) -> str:
    """Return a demonstration as the YAML of a problem file.

    Raises:
        InputError: As for `write_demonstration`.
    """
    if not shown.labels:
        raise InputError("a demonstration needs a label: what holds in it, or does not")
    names = [*shown.bodies, *(label.relation for label in shown.labels)]
    for name in names:
        if not NAME.fullmatch(name):
            what = f"'{name}' is no name: a letter, then letters, digits, _ or -"
            raise InputError(what)

    lines = [f"# {' '.join(shown.note.split())}"] if shown.note.strip() else []
    lines += [f"robot: {ROBOT}", f"room: {ROOM}", "", "bodies:"]
    lines += [f"  {name}: {{{_entry(entry)}}}" for name, entry in shown.bodies.items()]
    facts = [
        f"({label.relation} {' '.join(label.arguments)})"
        if label.holds
        else f"(not ({label.relation} {' '.join(label.arguments)}))"
        for label in shown.labels
    ]
    goal = facts[0] if len(facts) == 1 else f"(and {' '.join(facts)})"
    return "\n".join([*lines, "", f"goal: {goal}", ""])


def read_entries(path: Path) -> dict[str, BodyEntry]:
    """Read the bodies of a problem or demonstration file as entries that can be written again; mesh
    files by their whole path.

    Raises:
        InputError: It is no such file.
    """
    scene = load_scene(path, demonstration=True).scene
    bodies = read_yaml(path).mapping()["bodies"].mapping()
    return {
        name: BodyEntry(_shape(node, path.parent), scene.bodies[name].pose)
        for name, node in bodies.items()
    }


def _shape(node: YamlNode, folder: Path) -> dict[str, Any]:
    entries = {
        key: _plain(value) for key, value in node.mapping().items() if key not in PLACEMENT_KEYS
    }
    if "mesh" in entries:
        entries["mesh"] = os.path.abspath(find_mesh(str(entries["mesh"]), folder))
    return entries


def _plain(node: YamlNode) -> Any:
    """Return words, lists and mappings as they are written."""
    if node.is_list():
        return [_plain(item) for item in node.items()]
    try:
        return node.text()
    except InputError:  # a mapping, or an error of its own
        return {key: _plain(value) for key, value in node.mapping().items()}


def _entry(entry: BodyEntry) -> str:
    position = [_rounded(value) for value in entry.pose.position]
    quaternion = [_rounded(value, 9) for value in entry.pose.quaternion]
    shape = ", ".join(f"{key}: {_flow(value)}" for key, value in entry.shape.items())
    return f"{shape}, pose: {{position: {_flow(position)}, quaternion: {_flow(quaternion)}}}"


def _flow(value: Any) -> str:
    """Return a value in YAML's flow style; words are quoted where they need it."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_flow(key)}: {_flow(one)}" for key, one in value.items()) + "}"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        if not math.isfinite(value):
            raise InputError(f"{value} is not a finite number")
        return repr(value)
    if isinstance(value, str):
        number = re.fullmatch(r"-?[0-9.]+(e-?[0-9]+)?( ?(deg|rad|°))?", value)
        return value if number or PLAIN.fullmatch(value) else json.dumps(value)
    return "[" + ", ".join(_flow(one) for one in value) + "]"


def _rounded(value: float, digits: int = 7) -> float:
    if not math.isfinite(value):
        raise InputError(f"{value} is not a finite number")
    return round(float(value), digits) + 0.0
