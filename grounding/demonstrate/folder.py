"""The folder of a relation's demonstrations: files that the page writes, and those that
others wrote into it.
"""

from __future__ import annotations

import contextlib
import re
from dataclasses import dataclass
from pathlib import Path

from grounding.demonstrate.relation import Argument, DemonstratedRelation
from grounding.relations.demonstration_file import (
    MOST_FILES,
    Demonstration,
    Label,
    read_labels,
)
from grounding.relations.demonstration_text import DemonstrationFile, write_demonstration
from tamp.errors import InputError
from tamp.geometric.loading.load import load_scene
from tamp.geometric.scene.scene import Scene
from tamp.system.outputs import check_writable, locked_folder, write_whole
from tamp.system.reading import is_file

FIRST_FACT = re.compile(r"[\s(]*(?:(?:and|not)[\s(]+)*([a-z][\w-]*)", re.IGNORECASE)
"""What a goal says first, behind all `and` and `not`."""


@dataclass(frozen=True)
class SceneSource:
    """The origin of scenes, and the place of demonstrations.

    Attributes:
        scene: A problem file to demonstrate in; None for generated scenes.
        out: The folder of the demonstrations; None for demos/RELATION.
    """

    scene: Path | None = None
    out: Path | None = None

    def folder(self, relation: DemonstratedRelation) -> Path:
        """Return the folder of a relation's demonstrations."""
        return self.out or Path("demos") / relation.name


@dataclass(frozen=True, eq=False)
class Card:
    """A file of the folder.

    Attributes:
        name: Of the file.
        scene: What it shows; None where it cannot be read.
        labels: What it says of the relation.
        error: Why it cannot be read, or that it says nothing of the relation.
        stamp: Changes when the file does.
    """

    name: str
    scene: Scene | None
    labels: tuple[Label, ...]
    error: str
    stamp: tuple[int, int]

    @property
    def demonstrations(self) -> list[Demonstration]:
        """Return what is demonstrated in it."""
        if self.scene is None:
            return []
        return [
            Demonstration(self.scene, label.arguments, label.holds, f"{self.name}:{label.line}")
            for label in self.labels
        ]


class DemonstrationFolder:
    """The demonstrations of a relation on disk. Each is a file of its own, written whole or not at
    all at the moment when it is labelled: ending the command loses nothing.

    Args:
        path: The folder; it is made with the first demonstration.
        relation: The relation that they are about.

    Raises:
        InputError: The path is no folder, holds more files than anybody demonstrates, or has
            demonstrations of a relation of that name with another number of arguments.
    """

    def __init__(self, path: Path, relation: DemonstratedRelation) -> None:
        self.path, self.relation = path, relation.name
        self._cards: dict[str, Card] = {}
        self._removed: list[tuple[str, bytes]] = []
        wanted = len(relation.arguments)
        for card in self.cards():
            for label in card.labels:
                if len(label.arguments) != wanted:
                    what = f"{relation.name} has {len(label.arguments)} arguments here"
                    remedy = f"{relation} has {wanted}: choose another name, or another --out"
                    raise InputError(what, file=path / card.name, line=label.line, remedy=remedy)

    def cards(self) -> list[Card]:
        """Return what is in the folder now, by name; files are read again when they have changed.

        Raises:
            InputError: The path is no folder, or has too many files.
        """
        if not self.path.exists():
            self._cards = {}
            return []
        if not self.path.is_dir():
            raise InputError("demonstrations go into a folder, and this is none", file=self.path)
        files = sorted(self.path.glob("*.yaml"))
        if len(files) > MOST_FILES:
            raise InputError(f"more than {MOST_FILES:,} .yaml files in this folder", file=self.path)
        self._cards = {file.name: self._card(file) for file in files if is_file(file)}
        return list(self._cards.values())

    def demonstrations(self) -> list[Demonstration]:
        """Return all demonstrations that can be read, file by file."""
        return [one for card in self.cards() for one in card.demonstrations]

    def add(self, shown: DemonstrationFile) -> str:
        """Write a demonstration to a file of its own; return the file's name.

        Raises:
            InputError: It cannot be written.
        """
        try:
            with locked_folder(self.path):  # another page may write there, too
                name = self._next()
                write_demonstration(self.path / name, shown)
        except OSError as error:
            raise InputError(f"cannot be written: {error.strerror}", file=self.path) from None
        return name

    def flip(self, name: str) -> None:
        """Say the opposite of a demonstration that the page wrote: it was labelled by mistake.

        Raises:
            InputError: There is no such file, or it is one of somebody else's with several labels.
        """
        content = self._content(name).decode("utf-8", "replace")
        card = self._cards.get(name)
        if card is None or len(card.labels) != 1:
            raise InputError("only a file with one label can be turned", file=self.path / name)
        label = card.labels[0]
        fact = f"({label.relation} {' '.join(label.arguments)})"
        lines = content.rstrip("\n").split("\n")
        if lines[-1] not in (f"goal: {fact}", f"goal: (not {fact})"):
            what = "another hand wrote this file: change its label there"
            raise InputError(what, file=self.path / name)
        lines[-1] = f"goal: (not {fact})" if label.holds else f"goal: {fact}"
        self._save(name, ("\n".join(lines) + "\n").encode())

    def remove(self, name: str) -> None:
        """Delete a file; `restore` brings it back.

        Raises:
            InputError: There is none.
        """
        content = self._content(name)
        try:
            (self.path / name).unlink()
        except OSError as error:
            raise InputError(
                f"cannot be deleted: {error.strerror}", file=self.path / name
            ) from None
        self._removed.append((name, content))

    def restore(self) -> str | None:
        """Bring back the file that was deleted last; return its name, or None for none."""
        if not self._removed:
            return None
        name, content = self._removed.pop()
        self._save(name, content)
        return name

    @property
    def restorable(self) -> bool:
        """Check whether a deleted file can be brought back."""
        return bool(self._removed)

    def _next(self) -> str:
        """Return the next free name: a number is never given twice, so that order is history."""
        pattern = re.compile(rf"{re.escape(self.relation)}_(\d{{1,9}})\.yaml")
        there = [file.name for file in self.path.glob("*.yaml")]
        names = [*there, *(name for name, _ in self._removed)]
        taken = [int(found[1]) for name in names if (found := pattern.fullmatch(name))]
        return f"{self.relation}_{max(taken, default=0) + 1:03d}.yaml"

    def _content(self, name: str) -> bytes:
        """Read a file of the folder by its name, which comes from a browser."""
        if name not in self._cards:
            raise InputError(f"there is no demonstration '{name}'", file=self.path)
        try:
            return (self.path / name).read_bytes()
        except OSError as error:
            raise InputError(f"cannot be read: {error.strerror}", file=self.path / name) from None

    def _save(self, name: str, content: bytes) -> None:
        try:
            write_whole(self.path / name, content)
        except OSError as error:
            raise InputError(
                f"cannot be written: {error.strerror}", file=self.path / name
            ) from None

    def _card(self, file: Path) -> Card:
        state = file.stat()
        stamp = (state.st_mtime_ns, state.st_size)
        cached = self._cards.get(file.name)
        if cached is not None and cached.stamp == stamp:
            return cached
        try:
            loaded = load_scene(file, demonstration=True)
            labels = read_labels(loaded, self.relation)
        except InputError as error:
            return Card(file.name, None, (), error.message, stamp)
        return Card(file.name, loaded.scene, tuple(labels), "", stamp)


def check_folder(path: Path) -> None:
    """Refuse a folder that cannot be written before anybody demonstrates anything.

    Raises:
        InputError: It is a file, or one cannot write there.
    """
    if path.exists() and not path.is_dir():
        raise InputError("demonstrations go into a folder, and this is none", file=path)
    check_writable(path / "demonstration.yaml")


def relation_of_folder(path: Path) -> DemonstratedRelation | None:
    """Find the relation that the first demonstration in a folder is about, with its arguments; None
    where there is none.
    """
    if not path.is_dir():
        return None
    for file in sorted(path.glob("*.yaml"))[:20]:
        with contextlib.suppress(InputError):
            loaded = load_scene(file, demonstration=True)
            name = FIRST_FACT.match(loaded.goal.text)
            if name is not None:
                return _relation(read_labels(loaded, name[1])[0], loaded.scene)
    return None


def _relation(label: Label, scene: Scene) -> DemonstratedRelation:
    """Tell what the arguments of a label are from what they are in its scene."""
    arguments: list[Argument] = []
    for letter, name in zip("abcdef", label.arguments, strict=False):
        kind = "object"
        if name in scene.surfaces:
            kind = "surface"
        elif name in scene.cavities:
            kind = "container"
        arguments.append(Argument(letter, kind))
    return DemonstratedRelation(label.relation, tuple(arguments))
