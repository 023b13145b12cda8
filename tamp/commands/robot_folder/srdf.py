"""A robot's SRDF: MoveIt's groups, hands, states and pairs of links of a URDF."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element

from tamp.commands.robot_folder.description import Description
from tamp.errors import InputError
from tamp.geometric.loading.xml_file import read_numbered_xml

SHOWN = 3
"""Names or entries that a remark quotes."""


@dataclass(frozen=True)
class PlanningGroup:
    """A named group of joints: a chain between two links, or joints, links and other groups.

    Attributes:
        name: Its name.
        line: Of the file.
        chains: Pairs of a chain's first and last link.
        joints, links, groups: Names; a link stands for the joint that moves it.
    """

    name: str
    line: int
    chains: tuple[tuple[str, str], ...]
    joints: tuple[str, ...]
    links: tuple[str, ...]
    groups: tuple[str, ...]


@dataclass(frozen=True)
class EndEffector:
    """A hand: the group of its joints, and the link of the arm that it is bolted to."""

    name: str
    line: int
    parent: str
    group: str


@dataclass(frozen=True)
class GroupState:
    """A named state of a group: values by joint, radians or metres."""

    name: str
    line: int
    values: Mapping[str, float]


@dataclass(frozen=True)
class Disabled:
    """A pair of links that is not to be checked, and why: Adjacent, Never, Always, Default, ..."""

    first: str
    second: str
    reason: str
    line: int


@dataclass(frozen=True)
class Srdf:
    """The contents of an SRDF, without what names nothing of the URDF.

    Attributes:
        file: Where it stands.
        groups: By name.
        end_effectors: Its hands.
        states: Named configurations, in the file's order.
        disabled: Pairs that are not to be checked.
        unchecked: Links that are checked with none but those of `enabled`.
        enabled: Pairs that are checked in spite of `unchecked`.
        remarks: Sentences about what was left out.
    """

    file: Path
    groups: Mapping[str, PlanningGroup]
    end_effectors: tuple[EndEffector, ...]
    states: tuple[GroupState, ...]
    disabled: tuple[Disabled, ...]
    unchecked: Mapping[str, int]
    enabled: frozenset[tuple[str, str]]
    remarks: tuple[str, ...]

    def place(self, line: int) -> str:
        """Name a line of the file."""
        return f"{self.file.name}:{line}"


def read_srdf(file: Path, description: Description) -> Srdf:
    """Read the SRDF of a URDF's robot.

    Entries that name unknown links, joints or groups are left out, which `remarks` says; so is a
    name that is not the URDF's.

    Raises:
        InputError: It is no SRDF, or all links of its pairs are unknown: it is of another robot; a
            value that is no number.
    """
    root, lines = read_numbered_xml(file)
    if root.tag != "robot" or root.find("link") is not None:
        what = "a URDF" if root.tag == "robot" else f"its root is <{str(root.tag)[:40]}>"
        raise InputError(f"not an SRDF: {what}", file=file, line=lines[root])
    return _Reader(file, description, root, lines).read()


def links_above(description: Description, link: str) -> list[str]:
    """List a link and those that it hangs on, up to the root."""
    way = [link]
    while (joint := description.joint_to(way[-1])) is not None:
        way.append(joint.parent)
    return way


class _Reader:
    """The reading of one file.

    Args:
        file: The SRDF.
        description: Its URDF.
        root: Its root element.
        lines: Of each element.
    """

    def __init__(
        self, file: Path, description: Description, root: Element, lines: Mapping[Element, int]
    ) -> None:
        self._file, self._description = file, description
        self._root, self._lines = root, lines
        self._virtual = {one.get("name", "") for one in root.findall("virtual_joint")}
        self._unknown: list[tuple[int, str]] = []
        self._no_chains: list[str] = []
        self._counted = 0

    def read(self) -> Srdf:
        """Return what names something of the URDF."""
        names = [one.get("name", "") for one in self._root.findall("group")]
        groups = {group.name: group for group in self._groups(names)}
        end_effectors = tuple(self._end_effectors(names))
        states, disabled = tuple(self._states()), tuple(self._disabled())
        unchecked = {
            link: self._lines[one]
            for one in self._root.findall("disable_default_collisions")
            for link in self._named(one, ("link",))
        }
        enabled = frozenset(
            (min(pair), max(pair))
            for one in self._root.findall("enable_collisions")
            if len(pair := self._named(one, ("link1", "link2"))) == 2
        )
        remarks = (*self._remarks(), *self._no_chains)
        return Srdf(
            self._file, groups, end_effectors, states, disabled, unchecked, enabled, remarks
        )

    def _groups(self, names: list[str]) -> Iterator[PlanningGroup]:
        for element in self._root.findall("group"):
            chains: list[tuple[str, str]] = []
            for chain in element.findall("chain"):
                ends = self._named(chain, ("base_link", "tip_link"))
                if len(ends) == 2 and self._hangs(element, *ends):
                    chains.append((ends[0], ends[1]))
            yield PlanningGroup(
                element.get("name", ""),
                self._lines[element],
                tuple(chains),
                self._each(element, "joint", "joint"),
                self._each(element, "link", "link"),
                tuple(
                    name
                    for one in element.findall("group")
                    if (name := self._name(one, "name", "group", names))
                ),
            )

    def _end_effectors(self, names: list[str]) -> Iterator[EndEffector]:
        for element in self._root.findall("end_effector"):
            parents = self._named(element, ("parent_link",))
            group = self._name(element, "group", "group", names)
            if parents and group:
                name, line = element.get("name", ""), self._lines[element]
                yield EndEffector(name, line, parents[0], group)

    def _states(self) -> Iterator[GroupState]:
        for element in self._root.findall("group_state"):
            values: dict[str, float] = {}
            for one in element.findall("joint"):
                name = self._name(one, "name", "joint", self._description.joints)
                words = one.get("value", "").split()
                if not name or len(words) != 1:
                    continue  # a joint of several values is how the robot stands in the world
                values[name] = self._number(words[0], name, one)
            yield GroupState(element.get("name", ""), self._lines[element], values)

    def _number(self, word: str, joint: str, element: Element) -> float:
        try:
            value = float(word)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise InputError(
                f"joint '{joint}': its value '{word[:60]}' is no number",
                file=self._file,
                line=self._lines[element],
            )
        return value

    def _disabled(self) -> Iterator[Disabled]:
        for element in self._root.findall("disable_collisions"):
            pair = self._named(element, ("link1", "link2"))
            if len(pair) == 2:
                first, second = sorted(pair)
                yield Disabled(first, second, element.get("reason", ""), self._lines[element])

    def _each(self, element: Element, tag: str, kind: str) -> tuple[str, ...]:
        names = self._description.joints if kind == "joint" else self._description.links
        named = (self._name(one, "name", kind, names) for one in element.findall(tag))
        return tuple(dict.fromkeys(name for name in named if name))

    def _hangs(self, group: Element, base: str, tip: str) -> bool:
        """Check whether a chain is one, and note one that is none."""
        if base in links_above(self._description, tip):
            return True
        self._no_chains.append(
            f"{self._file.name}:{self._lines[group]}: the group '{group.get('name', '')}' is no "
            f"chain: '{tip}' does not hang on '{base}'"
        )
        return False

    def _named(self, element: Element, attributes: tuple[str, ...]) -> tuple[str, ...]:
        """Return the known links that attributes name."""
        links = self._description.links
        named = (self._name(element, attribute, "link", links) for attribute in attributes)
        return tuple(name for name in named if name)

    def _name(
        self, element: Element, attribute: str, kind: str, names: Mapping[str, object] | list[str]
    ) -> str:
        """Return a name that is known, or nothing, and note the line of one that is not."""
        name = element.get(attribute, "")
        if name in names:
            self._counted += kind != "group"
            return name
        if name not in self._virtual:  # by those a robot stands in its world
            self._unknown.append((self._lines[element], f"{kind} '{name}'"))
        return ""

    def _remarks(self) -> Iterator[str]:
        robot, line = self._root.get("name", ""), self._lines[self._root]
        self._unknown.sort()
        if self._unknown and not self._counted and len(self._unknown) >= SHOWN:
            line, what = self._unknown[0]
            raise InputError(
                f"it is of another robot: the URDF has no {what}, nor any link that it names",
                file=self._file, line=line, remedy="Name the SRDF of this URDF with --srdf",
            )  # fmt: skip
        if robot != self._description.name != "":
            yield (
                f"{self._file.name}:{line} is for the robot '{robot}', the URDF for "
                f"'{self._description.name}'"
            )
        if self._unknown:
            first = ", ".join(f"{what} (line {line})" for line, what in self._unknown[:SHOWN])
            more = len(self._unknown) - SHOWN
            yield (
                f"{self._file.name}: what the URDF does not have is left out: {first}"
                f"{f' and {more} more' if more > 0 else ''}"
            )
