"""The surfaces and cavities that a problem file declares for a body, and their names."""

from __future__ import annotations

import re
from collections.abc import Mapping

from tamp.geometric.loading.yaml_nodes import YamlNode
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Cavity, Surface

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
"""What PDDL takes for a name."""


def read_surfaces(body: str, node: YamlNode) -> tuple[Surface, ...]:
    """Read the `surfaces:` of a body."""
    surfaces: list[Surface] = []
    for name, entry in node.mapping().items():
        entries = entry.mapping(("at", "yaw", "size", "clearance"), required=("at", "size"))
        width, depth = entries["size"].numbers(2, positive=True)
        clearance = (
            entries["clearance"].number(positive=True) if "clearance" in entries else float("inf")
        )
        surfaces.append(
            Surface(check_name(name, entry), body, _frame(entries), (width, depth), clearance)
        )
    return tuple(surfaces)


def read_cavities(body: str, node: YamlNode) -> tuple[Cavity, ...]:
    """Read the `cavities:` of a body."""
    cavities: list[Cavity] = []
    for name, entry in node.mapping().items():
        entries = entry.mapping(("at", "yaw", "size"), required=("at", "size"))
        width, depth, height = entries["size"].numbers(3, positive=True)
        cavities.append(
            Cavity(check_name(name, entry), body, _frame(entries), (width, depth, height))
        )
    return tuple(cavities)


def check_name(name: str, node: YamlNode) -> str:
    """Check that a word can be a name in PDDL, and return it."""
    if not NAME.fullmatch(name):
        raise node.error(
            f"'{name}' is not a name", remedy="A name is a letter, then letters, digits, '_' or '-'"
        )
    return name


def _frame(entries: Mapping[str, YamlNode]) -> Pose:
    x, y, z = entries["at"].numbers(3)
    return Pose.from_xyz_yaw(x, y, z, entries["yaw"].angle() if "yaw" in entries else 0.0)
