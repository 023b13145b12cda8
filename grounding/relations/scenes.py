"""Generated scenes of a relation's kind: demonstrations' bodies in other sizes, on furniture of
another height that faces elsewhere, the other arguments anywhere on it.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.random import Generator as Random

from grounding.body_geometry import geometry_of
from grounding.relation_scene import Placed
from grounding.relations.demonstration_file import Demonstration, Label
from grounding.relations.demonstration_text import (
    BodyEntry,
    DemonstrationFile,
    demonstration_text,
    read_entries,
)
from grounding.relations.null_hypothesis import FACES, about_z
from grounding.relations.situation import support_of
from grounding.separation import Obstacles, separations
from tamp.errors import InputError
from tamp.geometric.loading.load import load_scene
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import CONTACT_GAP, Scene

EXAMPLES = 8
"""Demonstrations whose bodies are kept with the weights."""

TRIES = 60
"""Places in which a body is tried."""

AIR = 0.01
"""Metres between bodies of a generated scene."""


@dataclass(frozen=True)
class DemonstratedBodies:
    """The bodies of a demonstration.

    Attributes:
        arguments: Of the relation.
        bodies: By name.
    """

    arguments: tuple[str, ...]
    bodies: Mapping[str, BodyEntry]

    def plain(self) -> dict[str, Any]:
        """Return it as JSON has it."""
        bodies = {
            name: [dict(entry.shape), [*entry.pose.position, *entry.pose.quaternion]]
            for name, entry in self.bodies.items()
        }
        return {"arguments": list(self.arguments), "bodies": bodies}


def examples_of(shown: Sequence[Demonstration]) -> list[DemonstratedBodies]:
    """Take the bodies of some demonstrations in which the relation holds."""
    positive = [one for one in shown if one.holds]
    chosen = positive[:: max(1, len(positive) // EXAMPLES)][:EXAMPLES]
    return [
        DemonstratedBodies(
            one.arguments, read_entries(Path(one.source.rpartition(":")[0].rpartition(":")[0]))
        )
        for one in chosen
    ]


def read_examples(plain: Any) -> list[DemonstratedBodies]:
    """Return the examples of a card.

    Raises:
        InputError: They are none.
    """
    try:
        return [
            DemonstratedBodies(
                tuple(map(str, one["arguments"])),
                {
                    str(name): BodyEntry(dict(shape), _pose(pose))
                    for name, (shape, pose) in one["bodies"].items()
                },
            )
            for one in plain
        ]
    except (AttributeError, KeyError, IndexError, TypeError, ValueError):
        raise InputError("the card's 'examples' are not those of a relation") from None


def _pose(numbers: Sequence[Any]) -> Pose:
    x, y, z, a, b, c, d = (float(one) for one in numbers)
    return Pose((x, y, z), (a, b, c, d))


def loaded(bodies: Mapping[str, BodyEntry], arguments: Sequence[str]) -> Scene:
    """Return the scene of bodies, as the file of a demonstration would be read.

    Raises:
        InputError: They make no scene.
    """
    text = demonstration_text(DemonstrationFile(bodies, [Label("shown", tuple(arguments), True)]))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.yaml"
        path.write_text(text, encoding="utf-8")
        return load_scene(path, demonstration=True).scene


def made(example: DemonstratedBodies, rng: Random) -> dict[str, BodyEntry]:
    """Make a scene of an example's kind; argument 0 stands somewhere on the furniture.

    Raises:
        InputError: Its bodies do not fit onto the furniture in any of TRIES places.
    """
    before = loaded(example.bodies, example.arguments)
    owner = _owner(before, example.arguments)
    turn, scale = float(rng.uniform(-np.pi, np.pi)), rng.uniform(0.75, 1.25, 3)
    bodies = {
        name: BodyEntry(
            _resized(entry.shape, scale if name == owner else np.full(3, rng.uniform(0.8, 1.25))),
            _turned(entry.pose, turn),
        )
        for name, entry in example.bodies.items()
        if name in example.arguments or name == owner
    }
    return _arranged(bodies, example.arguments, owner, rng)


def _owner(scene: Scene, arguments: Sequence[str]) -> str | None:
    """Find the body on which the arguments stand; None for the ground."""
    for name in arguments[1:]:
        place = scene.surfaces.get(name) or scene.cavities.get(name)
        if place is not None and not scene.bodies[place.body].movable:
            return place.body
    body = scene.bodies[arguments[min(1, len(arguments) - 1)]]
    at = np.array(body.pose.position)
    foot = float((geometry_of(body.parts).vertices @ body.pose.rotation[2]).min() + at[2])
    row = support_of(scene, at[:2], foot, arguments)
    for other in scene.bodies.values():
        for place in () if other.movable else (*other.surfaces, *other.cavities):
            if abs((other.pose @ place.pose).position[2] - row[0]) < 1e-6:
                return other.name
    return None


def _arranged(
    bodies: dict[str, BodyEntry], arguments: Sequence[str], owner: str | None, rng: Random
) -> dict[str, BodyEntry]:
    """Put the arguments anywhere on the furniture, apart from each other."""
    scene = loaded(bodies, arguments)
    place = next(
        (one for one in scene.surfaces.values() if one.body == owner),
        next((one for one in scene.cavities.values() if one.body == owner), None),
    )
    T = np.eye(4) if place is None else scene.world_pose(place).matrix
    half = np.array([0.8, 0.8] if place is None else place.size[:2]) / 2
    placed: list[Placed] = []

    for name in (*arguments[1:], arguments[0]):
        if name not in bodies or name == owner:
            continue
        form, R = geometry_of(scene.bodies[name].parts), scene.bodies[name].pose.rotation
        for attempt in range(TRIES):
            matrix = np.eye(4)
            matrix[:3, :3] = about_z(rng.uniform(-np.pi, np.pi)) @ R
            spot = T[:3, :3] @ np.array([*(rng.uniform(-0.8, 0.8, 2) * half), 0.0]) + T[:3, 3]
            low = float((form.vertices @ matrix[2, :3]).min())
            matrix[:3, 3] = (*spot[:2], T[2, 3] + CONTACT_GAP - low)
            if not placed or attempt == TRIES - 1:
                break
            if separations(form, matrix[None], Obstacles(placed)).min() > AIR:
                break
        placed.append(Placed(form, matrix))
        bodies[name] = replace(bodies[name], pose=Pose.from_matrix(matrix))
    return bodies


def _turned(pose: Pose, turn: float) -> Pose:
    """Turn a pose about the world's origin."""
    matrix = np.eye(4)
    matrix[:3, :3] = about_z(turn)
    return Pose.from_matrix(matrix @ pose.matrix)


def _resized(shape: Mapping[str, Any], scale: Array) -> dict[str, Any]:
    """Return a shape of another size; declared places are not resized, so such a body is not."""
    new = dict(shape)
    if "surfaces" in new or "cavities" in new:
        return new
    if "box" in new:
        new["box"] = _scaled(new["box"], scale)
    elif "size" in new:
        new["size"] = _scaled(new["size"], scale)
    elif "cylinder" in new or "capsule" in new:
        kind = "cylinder" if "cylinder" in new else "capsule"
        new[kind] = {key: _scaled([value], scale)[0] for key, value in new[kind].items()}
    elif "sphere" in new:
        new["sphere"] = _scaled([new["sphere"]], scale)[0]
    elif "mesh" in new:
        old = new.get("scale", 1.0)
        new["scale"] = _scaled(old, scale) if isinstance(old, list) else _scaled([old], scale)[0]
    return new


def _scaled(values: Sequence[Any], scale: Array) -> list[float]:
    return [round(float(one) * float(scale[axis % 3]), 5) for axis, one in enumerate(values)]


def otherwise(pose: Pose, rng: Random) -> Pose:
    """Return a pose that is a little or quite different: moved, turned, or on another side."""
    matrix = pose.matrix.copy()
    what = rng.integers(3)
    if what == 0:
        away = rng.uniform(0.03, 0.2)
        angle = rng.uniform(-np.pi, np.pi)
        matrix[:2, 3] += away * np.array([np.cos(angle), np.sin(angle)])
    elif what == 1:
        matrix[:3, :3] = about_z(rng.uniform(-np.pi, np.pi)) @ matrix[:3, :3]
    else:
        matrix[:3, :3] = matrix[:3, :3] @ FACES[int(rng.integers(1, 6))]
    return Pose.from_matrix(matrix)
