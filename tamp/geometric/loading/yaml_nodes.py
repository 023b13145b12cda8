"""YAML whose every value knows the line it stands on."""

from __future__ import annotations

import itertools
import math
from collections.abc import Collection, Iterable
from pathlib import Path

import yaml

from tamp.errors import InputError
from tamp.geometric.loading.passage import PddlPassage

_TAG = "tag:yaml.org,2002:"
_UNITS = ("deg", "rad", "°")

MAX_DEPTH = 100
"""Deeper nesting is refused."""

MAX_MERGES = 1000
"""Mappings that one may take in by `<<`, also those that these take in."""

_LONGEST = 500
_SHOWN = 60
"""Characters of a wrong word that are told."""


class YamlNode:
    """A value of a YAML file: its place, its name, and readers that say what is wrong with it.

    Words are taken as they are written, never as YAML 1.1 reads them: `on:` is a key, not the
    boolean true.

    Args:
        node: PyYAML's node.
        file: The file, for messages.
        source: The file's text by lines.
        name: Dotted path for messages, such as `bodies.mug.mass`.
        line: 1-based line; the key's line for a value of a mapping.
    """

    def __init__(
        self, node: yaml.Node, file: Path, source: list[str], name: str, line: int
    ) -> None:
        self._node = node
        self._file = file
        self._source = source
        self.name = name
        self.line = line

    def error(
        self,
        message: str,
        *,
        found: str | None = None,
        choices: Iterable[str] = (),
        remedy: str = "",
    ) -> InputError:
        """Return an error about this value, to be raised by the caller."""
        where = f"{self.name}: " if self.name else ""
        # A word of the file may hold line breaks, or a megabyte.
        message = " ".join(message[:_LONGEST].split())
        found = None if found is None else found[:_LONGEST]
        return InputError(
            where + message,
            file=self._file,
            line=self.line,
            found=found,
            choices=choices,
            remedy=remedy,
        )

    def mapping(
        self, allowed: Collection[str] | None = None, required: Collection[str] = ()
    ) -> dict[str, YamlNode]:
        """Return the entries of a mapping in the file's order.

        Args:
            allowed: The keys it may have; None when the keys are names chosen by the user.
            required: The keys it must have.

        Raises:
            InputError: Not a mapping, a key twice, an unknown key, a missing key.
        """
        if not isinstance(self._node, yaml.MappingNode):
            wanted = f" with {', '.join(allowed)}" if allowed else ""
            raise self.error(f"expected a mapping{wanted}, found {self._described()}")
        entries = self._entries(self._node, {}, 0)
        for key, entry in entries.items():
            if allowed is not None and key not in allowed:
                raise _at(
                    entry, self.error(f"unknown key '{_short(key)}'", found=key, choices=allowed)
                )
        for key in required:
            if key not in entries:
                raise self.error(f"'{key}' is missing")
        return entries

    def _entries(
        self, node: yaml.MappingNode, composed: dict[int, dict[str, YamlNode] | None], depth: int
    ) -> dict[str, YamlNode]:
        """Return a mapping's entries, those merged too; `composed`: merged before, by identity."""
        if id(node) in composed:
            found = composed[id(node)]
            if found is None:
                raise self.error("'<<' merges a mapping into itself")
            return found

        if depth > MAX_DEPTH or len(composed) > MAX_MERGES:
            raise self.error(
                f"'<<' merges more than {MAX_MERGES} mappings, or more than {MAX_DEPTH} deep"
            )

        composed[id(node)] = None
        entries: dict[str, YamlNode] = {}
        merged: list[yaml.Node] = []
        for key, value in node.value:
            if key.tag == _TAG + "merge":
                merged += value.value if isinstance(value, yaml.SequenceNode) else [value]
                continue
            if not isinstance(key, yaml.ScalarNode):
                raise self.error("a key must be a word")
            child = self._child(value, key.value, key.start_mark.line + 1)
            if key.value in entries:
                first = entries[key.value].line
                raise _at(
                    child, self.error(f"'{_short(key.value)}' stands twice, first in line {first}")
                )
            entries[key.value] = child

        if len(merged) > MAX_MERGES:
            raise self.error(f"'<<' merges more than {MAX_MERGES} mappings")
        for base in merged:
            if not isinstance(base, yaml.MappingNode):
                raise self.error("'<<' merges mappings only")
            for key, child in self._entries(base, composed, depth + 1).items():
                entries.setdefault(key, child)

        composed[id(node)] = entries
        return entries

    def items(self, count: int | None = None) -> list[YamlNode]:
        """Return the entries of a list.

        Raises:
            InputError: Not a list, or not of `count` entries.
        """
        if not isinstance(self._node, yaml.SequenceNode):
            wanted = "a list" if count is None else f"{count} numbers"
            raise self.error(f"expected {wanted}, found {self._described()}")
        if count is not None and len(self._node.value) != count:
            raise self.error(f"expected {count} numbers, found {len(self._node.value)}")
        return [
            self._child(item, f"[{index}]", item.start_mark.line + 1)
            for index, item in enumerate(self._node.value)
        ]

    def text(self, choices: Collection[str] | None = None, kind: str = "value") -> str:
        """Read a word or a sentence.

        Raises:
            InputError: Not text, empty, or not among the choices.
        """
        if not isinstance(self._node, yaml.ScalarNode):
            raise self.error(f"expected text, found {self._described()}")
        value = self._node.value.strip()
        if not value or self._node.tag == _TAG + "null":
            raise self.error("has no value")
        if choices is not None and value not in choices:
            raise self.error(f"unknown {kind} '{_short(value)}'", found=value, choices=choices)
        return value

    def number(
        self, *, positive: bool = False, low: float = -math.inf, high: float = math.inf
    ) -> float:
        """Read a finite number.

        Raises:
            InputError: Not a number, not finite, not positive, or outside of [low, high].
        """
        return self._checked(self.text(), positive, low, high)

    def integer(self, *, low: int, high: float = math.inf) -> int:
        """Read a whole number in [low, high]."""
        value = self.number(low=low, high=high)
        if value != int(value):
            raise self.error(f"{value:g} is not a whole number")
        return int(value)

    def numbers(
        self, count: int, *, positive: bool = False, low: float = -math.inf
    ) -> tuple[float, ...]:
        """Read a list of `count` finite numbers."""
        return tuple(item.number(positive=positive, low=low) for item in self.items(count))

    def angle(self) -> float:
        """Read an angle in radians, written `90 deg`, `1.57 rad` or as a plain number of radians.

        Raises:
            InputError: Not an angle, or a plain number beyond a full turn, which was surely meant
                in degrees.
        """
        text = self.text()
        unit = next((unit for unit in _UNITS if text.endswith(unit)), None)
        number = text.removesuffix(unit).rstrip() if unit else text
        value = self._checked(number, False, -math.inf, math.inf)
        if unit in ("deg", "°"):
            return math.radians(value)
        if unit is None and abs(value) > 2 * math.pi + 1e-9:
            raise self.error(
                f"{value:g} radians are more than a full turn",
                remedy=f"Write '{value:g} deg' or 'rad'",
            )
        return value

    def flag(self) -> bool:
        """Read a boolean: true or false."""
        value = self.text().lower()
        if value not in ("true", "yes", "false", "no"):
            raise self.error(f"'{_short(value)}' is neither true nor false")
        return value in ("true", "yes")

    def is_list(self) -> bool:
        """Check whether it is a list."""
        return isinstance(self._node, yaml.SequenceNode)

    def passage(self) -> PddlPassage:
        """Return the text as it stands in the file, so that a parser can say line and column."""
        text = self.text()
        start, end = self._node.start_mark, self._node.end_mark
        style = self._node.style if isinstance(self._node, yaml.ScalarNode) else None
        if style in ("|", ">"):
            # The indicator stands on the line before the text; what follows is less indented.
            below = self._source[start.line + 1 :]
            indent = next(_indent(line) for line in below if line.strip())
            block = list(
                itertools.takewhile(lambda line: not line.strip() or _indent(line) >= indent, below)
            )
            return PddlPassage("\n".join(block), start.line + 2, 1)
        lines = self._source[start.line : end.line + 1]
        lines[-1] = lines[-1][: end.column]
        lines[0] = lines[0][start.column :]
        raw = "\n".join(lines)
        if style in ("'", '"'):
            return PddlPassage(
                raw[1:-1] if "\\" not in raw else text, start.line + 1, start.column + 2
            )
        return PddlPassage(raw, start.line + 1, start.column + 1)

    def _checked(self, word: str, positive: bool, low: float, high: float) -> float:
        try:
            value = float(word.removeprefix(".") if word.lower() in (".nan", ".inf") else word)
        except ValueError:
            raise self.error(f"'{_short(word)}' is not a number") from None
        if not math.isfinite(value):
            raise self.error(f"{_short(word)} is not a finite number")
        if positive and value <= 0:
            raise self.error(f"must be positive, found {value:g}")
        if not low <= value <= high:
            bound = f"at least {low:g}" if value < low else f"at most {high:g}"
            raise self.error(f"must be {bound}, found {value:g}")
        return value

    def _child(self, node: yaml.Node, key: str, line: int) -> YamlNode:
        key = _short(key)
        name = (
            key
            if not self.name
            else f"{self.name}{key}"
            if key.startswith("[")
            else f"{self.name}.{key}"
        )
        return YamlNode(node, self._file, self._source, name, line)

    def _described(self) -> str:
        if isinstance(self._node, yaml.SequenceNode):
            return "a list"
        if isinstance(self._node, yaml.MappingNode):
            return "a mapping"
        word = str(self._node.value)
        return f"'{_short(word)}'" if word else "nothing"


def _short(word: str) -> str:
    """Shorten a word to what is told of it: not the megabyte that it may be."""
    return word if len(word) <= _SHOWN else f"{word[:_SHOWN]}..."


def _indent(line: str) -> int:
    return len(line) - len(line.lstrip(" "))


def _at(node: YamlNode, error: InputError) -> InputError:
    """Return the error moved to the line of a child."""
    error.line = node.line
    error.args = (error.at(None).args[0],)
    return error
