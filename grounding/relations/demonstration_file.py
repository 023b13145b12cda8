"""Demonstration files: a scene as a problem file, with what holds in it as its goal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from tamp.errors import InputError
from tamp.geometric.loading.load import LoadedProblem, load_scene
from tamp.geometric.scene.scene import Scene
from tamp.symbolic.pddl.nodes import Group, Node, Symbol, error
from tamp.symbolic.pddl.sexpr import read

MOST_ARGUMENTS = 6
"""Arguments of a relation that a file may name."""

MOST_FILES = 5_000
"""Demonstration files of a folder that are read."""


@dataclass(frozen=True, eq=False)
class Demonstration:
    """A scene in which a relation holds, or does not.

    Attributes:
        scene: Everything stands where the label is about.
        arguments: The relation's: names of bodies, surfaces and containers; the first is the body
            that would be placed.
        holds: The label.
        source: Where it is said, for messages: "lying.yaml:9".
    """

    scene: Scene
    arguments: tuple[str, ...]
    holds: bool = True
    source: str = ""


@dataclass(frozen=True)
class Label:
    """A fact of a file's goal: `(stack mug plate)`, or `(not (stack mug plate))`."""

    relation: str
    arguments: tuple[str, ...]
    holds: bool
    line: int = 0
    column: int = 0


def read_labels(loaded: LoadedProblem, relation: str) -> list[Label]:
    """Read what the goal of a problem file says of a relation, with its line and column.

    Raises:
        InputError: It says nothing of it; a fact names what is not in the scene, or more than
            MOST_ARGUMENTS.
    """
    goal, labels = loaded.goal, list[Label]()
    for form in read(
        goal.text, loaded.path, line_offset=goal.line - 1, column_offset=goal.column - 1
    ):
        for group, holds in _facts(form, relation.lower()):
            names, place = _names(group, loaded.scene), group.place
            labels.append(Label(relation.lower(), names, holds, place.line, place.column))
    if not labels:
        raise InputError(
            f"the goal says nothing of '{relation}'",
            file=loaded.path,
            line=goal.line,
            remedy=f"goal: ({relation} BODY PLACE), or goal: (not ({relation} BODY PLACE))",
        )
    return labels


def demonstrations_of(relation: str, files: Sequence[Path]) -> Iterator[Demonstration]:
    """Read the demonstrations of a relation of any bodies and places from problem files.

    Args:
        relation: Its name; upper and lower case count as the same.
        files: Problem files; of a folder all its .yaml files, by name.

    Raises:
        InputError: A file is no problem, or its goal says nothing of the relation; what it says
            does not begin with a body, or has another number of arguments than the first.
    """
    count: int | None = None
    for path in demonstration_files(files):
        loaded = load_scene(path, demonstration=True)

        for label in read_labels(loaded, relation):
            try:
                _check(label, loaded.scene, count)
            except InputError as found:
                raise found.at(path, label.line) from None

            count = len(label.arguments)
            source = f"{path}:{label.line}:{label.column}"
            yield Demonstration(loaded.scene, label.arguments, label.holds, source)


def _check(label: Label, scene: Scene, count: int | None) -> None:
    names = label.arguments
    if names[0] not in scene.bodies:
        raise InputError(f"'{names[0]}' is no body", found=names[0], choices=scene.bodies)
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError(f"'{twice}' stands twice among the arguments")
    if count is not None and len(names) != count:
        raise InputError(f"'{label.relation}' has {len(names)} arguments here, and {count} before")


def demonstration_files(files: Sequence[Path]) -> Iterator[Path]:
    """List problem files, a folder by its .yaml files.

    Raises:
        InputError: A folder has none, or more than MOST_FILES.
    """
    for path in files:
        if not path.is_dir():
            yield path
            continue
        inside = sorted(path.glob("*.yaml"))
        if not inside:
            raise InputError("no .yaml files in this folder", file=path)
        if len(inside) > MOST_FILES:
            raise InputError(f"more than {MOST_FILES} .yaml files in this folder", file=path)
        yield from inside


def _facts(form: Node, relation: str, holds: bool = True) -> Iterator[tuple[Group, bool]]:
    """Generate the relation's facts in a formula, and whether they are asserted or denied."""
    if isinstance(form, Symbol):
        return
    if form.head == relation:
        yield form, holds
    elif form.head in ("and", "not"):
        for part in form.items[1:]:
            yield from _facts(part, relation, holds != (form.head == "not"))


def _names(group: Group, scene: Scene) -> tuple[str, ...]:
    scene_names = {name.lower(): name for name in (*scene.bodies, *scene.surfaces, *scene.cavities)}
    words = [part for part in group.items[1:] if isinstance(part, Symbol)]
    if not 1 <= len(words) <= MOST_ARGUMENTS or len(words) != len(group.items) - 1:
        what = f"a demonstration names one to {MOST_ARGUMENTS} bodies, surfaces or containers"
        raise error(group.place, what)

    for word in words:
        if word.text not in scene_names:
            raise error(
                word,
                f"unknown object '{word.written}'",
                found=word.written,
                choices=scene_names.values(),
            )
    return tuple(scene_names[word.text] for word in words)
