"""Text of another language inside a YAML file."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class PddlPassage:
    """A piece of PDDL inside a YAML file, as it stands there, line breaks included.

    Attributes:
        text: The PDDL.
        line: 1-based line in the file of its first character.
        column: 1-based column of its first character.
    """

    text: str
    line: int
    column: int
