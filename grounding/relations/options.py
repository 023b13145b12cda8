"""The options of tamp-learn's commands for relations from a few demonstrations."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from tamp.errors import InputError

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")

TAKEN = frozenset(
    ("and", "or", "not", "imply", "exists", "forall", "when", "on", "inside", "pose", "at-pose")
)
"""Names that mean something else in every domain."""


@dataclass(frozen=True)
class New:
    """Learn a relation of one's own from a handful of demonstrations, and put it into a domain."""

    relation: Annotated[str, tyro.conf.Positional]
    """Its name: a letter, then letters, digits, _ or -."""
    demos: Path = Path("demos")
    """A demonstration file, or a folder of them (docs/adding-a-predicate.md)."""
    out: Path | None = None
    """The weights; by default weights/RELATION.safetensors."""
    add_to: Path | None = None
    """A domain's file that gets the predicate, its rule and its two streams, with the streams
    beside it; one that is not there begins as the shipped cupboard. What changes is shown.
    """
    dry_run: bool = False
    """Show what would change in the domain, and write nothing."""
    seed: int = 0
    """Of chance and of the parts for cross-validation."""


@dataclass(frozen=True)
class Ask:
    """Be asked about scenes in which the explanations of a relation differ most, and keep the
    answers as demonstrations.

    What is missing is told first. Each scene is written with a picture beside it; the answer is
    read from the standard input, a line each: yes, no, skip or quit.
    """

    relation: Annotated[str, tyro.conf.Positional]
    """Its name."""
    demos: Path = Path("demos")
    """The folder of its demonstrations, which gets those that are answered."""
    count: int = 5
    """Questions."""
    pool: int = 60
    """Scenes of which they are chosen."""
    pictures: bool = True
    """Whether each has a picture beside it."""
    seed: int = 0
    """Of the scenes."""


def check_name(name: str) -> None:
    """Check the name of a relation of one's own.

    Raises:
        InputError: It is no name, or is taken.
    """
    if not NAME.fullmatch(name):
        raise InputError(f"'{name:.60}' is no name: a letter, then letters, digits, _ or -")
    if name.lower() in TAKEN:
        raise InputError(f"the name '{name}' is taken", remedy="Choose another name")
