"""Scenes to demonstrate in: generated ones, each with other bodies, sizes, heights and yaws, or a
problem file's with its bodies somewhere else.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.random import Generator as Random

from grounding.demonstrate.models import sample_body, sample_furniture
from grounding.demonstrate.relation import Argument, DemonstratedRelation
from grounding.demonstrate.viewer import nearest_side, stand_of
from grounding.relations.demonstration_file import Label
from grounding.relations.demonstration_text import (
    BodyEntry,
    DemonstrationFile,
    demonstration_text,
    read_entries,
)
from tamp.errors import InputError
from tamp.geometric.loading.load import load_scene
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import CONTACT_GAP, Body, Scene
from tamp.geometric.stability.stable_poses import stable_faces_of
from tamp.system.files import find_problem
from tamp.system.scratch import scratch_folder

COLOURS = ("red", "blue", "green", "orange")
"""Of the bodies that the relation is about, by argument."""

OTHER = ([0.80, 0.80, 0.78], [0.72, 0.75, 0.78], [0.78, 0.74, 0.70])
"""Of the other bodies."""

OTHERS = 2
"""Other bodies in a generated scene, at most."""

UPRIGHT_SHARE = 0.6
"""Share of bodies that stand at first as they are modelled; the rest on any of their faces."""

TRIES = 60
"""Places that are tried for a body."""

APART = 0.02
"""Metres between the boxes of bodies at first."""


@dataclass(frozen=True, eq=False)
class Stage:
    """A scene, and what the relation's arguments are in it.

    Attributes:
        entries: The bodies as a problem file describes them, where they are at first.
        scene: The same, read.
        arguments: Names of bodies and places, in the relation's order.
    """

    entries: Mapping[str, BodyEntry]
    scene: Scene
    arguments: tuple[str, ...]

    @property
    def movable(self) -> tuple[str, ...]:
        """Return the bodies that a hand may move: the movable ones, and containers that stand
        somewhere.
        """
        return tuple(
            name for name in self.scene.bodies if name in self.scene.movable or name in self._boxes
        )

    @property
    def _boxes(self) -> tuple[str, ...]:
        return tuple(
            name for name, body in self.scene.bodies.items() if body.cavities and not body.surfaces
        )

    def posed(self, poses: Mapping[str, Pose]) -> dict[str, Body]:
        """Return the bodies, some of them at other poses T_world_body."""
        return {
            name: replace(body, pose=poses.get(name, body.pose))
            for name, body in self.scene.bodies.items()
        }

    def moved(self, poses: Mapping[str, Pose]) -> Stage:
        """Return the same scene with bodies at other poses T_world_body.

        Raises:
            InputError: No problem file could say so: a body is below the floor.
        """
        entries = {
            name: replace(entry, pose=poses.get(name, entry.pose))
            for name, entry in self.entries.items()
        }
        return replace(self, entries=entries, scene=_read(entries))

    def fronted(self, eye: float) -> Stage:
        """Return the same scene, in which what the arguments stand on has its front on the side
        that is nearest to the viewer.

        Args:
            eye: The direction from there to the viewer's eye, radians in the world.

        Raises:
            InputError: The arguments stand on nothing.
        """
        stand = stand_of(self.scene, self.arguments)
        if stand is None:
            raise InputError("the arguments stand on nothing that has a front")
        entry = self.entries[stand.name]
        shape = {**entry.shape, "front": f"{nearest_side(stand, eye)} deg"}
        entries = {**self.entries, stand.name: replace(entry, shape=shape)}
        return replace(self, entries=entries, scene=_read(entries))

    def file(self, label: Label, note: str = "") -> DemonstrationFile:
        """Return the demonstration file of this scene."""
        return DemonstrationFile(self.entries, (label,), note)


def sample_stage(relation: DemonstratedRelation, rng: Random) -> Stage:
    """Sample a scene for a relation: furniture of any height somewhere, turned anyhow; on it bodies
    for the arguments and up to OTHERS more, apart from each other.
    """
    while True:  # a crowded table has no room for a large plate: then another table
        kind, entry, surface = sample_furniture(rng)
        yaw = float(rng.uniform(-math.pi, math.pi))
        x, y = (round(float(v), 3) for v in rng.uniform(-1.5, 1.5, 2))
        stand = Pose.from_xyz_yaw(x, y, 0.0, yaw)
        entries = {kind: BodyEntry({**entry, "colour": "wood"}, stand)}
        arguments: list[str] = []
        for number, argument in enumerate(relation.arguments):
            if argument.kind == "surface":
                arguments.append(surface)
                continue
            name, shape = _argument(argument, COLOURS[number], rng)
            arguments.append(name)
            entries[name] = BodyEntry(shape, Pose())
        for number in range(int(rng.integers(OTHERS + 1))):
            model, shape = sample_body("object", rng)
            colour = list(OTHER[number])
            entries[f"other_{model}_{number + 1}"] = BodyEntry({**shape, "colour": colour}, Pose())

        placed = _spread(kind, entries, surface, rng)
        if placed is not None:
            return Stage(placed, _read(placed), tuple(arguments))


def open_stage(
    file: str | Path, relation: DemonstratedRelation, chosen: Mapping[str, str]
) -> Stage:
    """Open a problem file as a scene to demonstrate in.

    Args:
        file: The problem's file, or the name of a shipped one.
        relation: What is demonstrated.
        chosen: Argument to body or place, as far as it has been said; the rest is taken in the
            file's order.

    Raises:
        InputError: It is none, has too few bodies for the arguments, or not what was chosen.
    """
    file = find_problem(file)
    entries = read_entries(file)
    scene = load_scene(file, demonstration=True).scene
    free = [name for name in scene.movable if name not in chosen.values()]
    arguments: list[str] = []
    for argument in relation.arguments:
        choices = choices_of(argument, scene)
        wanted = chosen.get(argument.name)
        if wanted is not None and wanted not in choices:
            what = f"'{wanted}' cannot be the argument {argument.name}"
            raise InputError(what, file=file, found=wanted, choices=choices)
        remaining = [name for name in (free if choices[0] in scene.movable else choices)]
        remaining = [name for name in remaining if name not in arguments]
        if wanted is None and not remaining:
            what = f"too few bodies or places for {relation}"
            raise InputError(what, file=file, remedy="Leave the scene out: one is generated")
        arguments.append(wanted or remaining[0])

    return Stage(entries, scene, tuple(arguments))


def choices_of(argument: Argument, scene: Scene) -> list[str]:
    """List what an argument can be in a scene.

    Raises:
        InputError: Nothing.
    """
    if argument.kind == "surface":
        found = list(scene.surfaces)
    elif argument.kind == "container":
        found = list(scene.cavities)
    else:
        found = [*scene.movable, *scene.surfaces, *scene.cavities]
    if not found:
        raise InputError(f"the scene has no {argument.kind} for the argument {argument.name}")
    return found


def shuffled(stage: Stage, rng: Random) -> Stage:
    """Return a problem file's scene with its movable bodies elsewhere on what they stand on."""
    scene = stage.scene
    entries = dict(stage.entries)
    boxes = [bounds(scene.bodies[name].parts, scene.bodies[name].pose) for name in scene.fixed]
    for name in scene.movable:
        body = scene.bodies[name]
        place = scene.surfaces.get(body.support or "") or scene.cavities.get(body.support or "")
        if place is None:
            boxes.append(bounds(body.parts, body.pose))
            continue
        inside = place.size[:2]
        T_world_place = scene.world_pose(place)
        own = bounds(scene.bodies[place.body].parts, scene.bodies[place.body].pose)
        around = [box for box in boxes if not np.array_equal(box, own)]
        pose = _free_pose(body, T_world_place, inside, around, rng) or body.pose
        boxes.append(bounds(body.parts, pose))
        entries[name] = replace(entries[name], pose=pose)
    return replace(stage, entries=entries, scene=_read(entries))


def _argument(argument: Argument, colour: str, rng: Random) -> tuple[str, dict[str, object]]:
    """Sample the body of an argument; it is called by its colour, as people would."""
    kind, shape = sample_body(argument.kind, rng)
    return f"{colour}_{kind}", {**shape, "colour": colour}


def _read(entries: Mapping[str, BodyEntry]) -> Scene:
    """Read entries as a problem file is read, so that what is shown is what will be saved."""
    label = Label("shown", (next(iter(entries)),), True)
    with scratch_folder() as folder:
        file = Path(folder) / "scene.yaml"
        file.write_text(demonstration_text(DemonstrationFile(entries, (label,))), encoding="utf-8")
        return load_scene(file, demonstration=True).scene


def _spread(
    stand: str, entries: Mapping[str, BodyEntry], surface: str, rng: Random
) -> dict[str, BodyEntry] | None:
    """Put the bodies somewhere on the surface, apart from each other; None where they find no
    room.
    """
    drafts = {
        name: entry if name == stand else replace(entry, pose=Pose((9.0 * number, 9.0, 0.5)))
        for number, (name, entry) in enumerate(entries.items())
    }
    scene = _read(drafts)
    T_world_surface = scene.world_pose(scene.surfaces[surface])
    placed, boxes = {stand: entries[stand]}, list[tuple[Array, Array]]()
    for name, entry in entries.items():
        if name == stand:
            continue
        size = scene.surfaces[surface].size
        pose = _free_pose(scene.bodies[name], T_world_surface, size, boxes, rng)
        if pose is None:
            return None
        boxes.append(bounds(scene.bodies[name].parts, pose))
        placed[name] = replace(entry, pose=pose)
    return placed


def _free_pose(
    body: Body,
    T_world_place: Pose,
    size: tuple[float, float],
    boxes: list[tuple[Array, Array]],
    rng: Random,
) -> Pose | None:
    """Sample T_world_body at rest on a place, its box apart from others; None where none is
    found.
    """
    faces = stable_faces_of(replace(body, pose=Pose(), support=None)).faces if body.movable else ()
    for _ in range(TRIES):
        rotation = np.eye(3)
        if faces and rng.random() > UPRIGHT_SHARE:
            rotation = faces[int(rng.integers(len(faces)))].rotation
        turn = Pose.from_xyz_yaw(0.0, 0.0, 0.0, float(rng.uniform(-math.pi, math.pi)))
        local = np.eye(4)
        local[:3, :3] = turn.rotation @ rotation
        low, high = bounds(body.parts, Pose.from_matrix(local))
        room = np.array(size) / 2 - (high - low)[:2] / 2 - APART
        if (room < 0).any():
            continue

        local[:2, 3] = rng.uniform(-room, room) - (low + high)[:2] / 2
        local[2, 3] = CONTACT_GAP - low[2]
        pose = Pose.from_matrix(T_world_place.matrix @ local)
        low, high = bounds(body.parts, pose)
        if all(
            (low > other[1] + APART).any() or (other[0] > high + APART).any() for other in boxes
        ):
            return pose
    return None
