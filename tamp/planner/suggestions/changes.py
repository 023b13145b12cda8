"""Changes that make a problem easier: a body gone, movable, smaller; places larger; goals less."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scaling import scale_part, scale_pose, scale_visual
from tamp.geometric.scene.scene import Body, Box, Cavity, Part, Scene, Surface
from tamp.planner.problem import Problem
from tamp.symbolic.pddl.atoms import atoms
from tamp.symbolic.pddl.structs import And, Atom, Formula

SHRINK_FACTORS = (
    (0.75, "a quarter smaller", 2),
    (0.5, "half its size", 3),
    (0.3, "a third of its size", 4),
)
"""Factors by which a body is scaled, in words, and how large a change that is."""

PLACE_GROWTH_FACTOR = 1.5
"""Factor by which the sides of a place are scaled."""

HANDY_HEIGHTS_M = (0.3, 1.1)
"""Heights between which nothing is too low or too high, metres."""

MIDDLE_HEIGHT_M = 0.75
"""The height to which something is brought that is not, metres."""

MAX_MOVABLE_EDGE_M = 0.6
"""A fixed body is thought of as movable when no edge is longer than this, metres."""


@dataclass(frozen=True)
class Change:
    """One change of a problem.

    Attributes:
        text: As the end of "It would be solvable ...".
        about: The things that it concerns.
        size: How much it asks for; small changes come first.
        scene: The changed scene, or
        goal: the changed goal.
    """

    text: str
    about: tuple[str, ...]
    size: int
    scene: Scene | None = None
    goal: Formula | None = None


def changes(problem: Problem) -> Iterator[Change]:
    """Yield all changes that are thought of, in no order that matters."""
    scene = problem.scene
    words = {word for atom in atoms(problem.stream_task.task.goal) for word in atom.terms}
    wanted = {
        name for name in (*scene.bodies, *scene.surfaces, *scene.cavities) if name.lower() in words
    }
    places = [*scene.surfaces.values(), *scene.cavities.values()]
    wanted |= {place.body for place in places if place.name in wanted}

    for name, body in scene.bodies.items():
        idle = name not in wanted and not _on(scene, body)
        if idle:
            others = {other: kept for other, kept in scene.bodies.items() if other != name}
            yield Change(
                f"without {name}", (name,), 1 if body.movable else 2, replace(scene, bodies=others)
            )

        if body.movable and (name in wanted or not idle):
            for factor, how, size in SHRINK_FACTORS:
                yield Change(
                    f"if {name} were {how}", (name,), size, _with(scene, _scaled(body, factor))
                )

        if not body.movable and _small(body) and not body.cavities and not _on(scene, body):
            loose = replace(body, movable=True, surfaces=(), support=_below(scene, body))
            yield Change(f"if {name} could be moved", (name,), 1, _with(scene, loose))

    for place in places:
        body = scene.bodies[place.body]
        if place.name in wanted and not body.movable:
            larger = _larger(body, place)
            if larger is not None and not (isinstance(place, Cavity) and _on(scene, body)):
                about = (place.name, body.name)
                yield Change(
                    f"if {place.name} were half as large again", about, 3, _with(scene, larger)
                )

    for body in scene.bodies.values():
        yield from _brought(scene, body)

    goal = problem.stream_task.task.goal
    if isinstance(goal, And) and len(goal.parts) > 1:
        for index, part in enumerate(goal.parts):
            if isinstance(part, Atom):
                others = And((*goal.parts[:index], *goal.parts[index + 1 :]))
                text = f"without the goal ({' '.join((part.predicate, *part.terms))})"
                yield Change(text, part.terms, 4, goal=others)


def _brought(scene: Scene, body: Body) -> Iterator[Change]:
    """Bring a piece of furniture within reach, with all that stands on it."""
    places = (*body.surfaces, *body.cavities)
    if body.movable or not places:
        return

    heights = [(body.pose @ place.pose).position[2] for place in places]
    x, y, z = body.pose.position
    if max(heights) < HANDY_HEIGHTS_M[0] or min(heights) > HANDY_HEIGHTS_M[1]:
        lifted = replace(
            body.pose, position=(x, y, z + MIDDLE_HEIGHT_M - sum(heights) / len(heights))
        )
        yield Change(
            f"if {body.name} were {MIDDLE_HEIGHT_M} m high",
            _around(scene, body),
            2,
            _moved(scene, body, lifted),
        )

    inside = [
        min(max(v, low), high)
        for v, (low, high) in zip((x, y), (scene.room.x, scene.room.y), strict=True)
    ]
    if inside != [x, y]:
        nearer = replace(body.pose, position=(*inside, z))
        text = f"if {body.name} stood at ({inside[0]:.1f}, {inside[1]:.1f}), in the room"
        yield Change(text, _around(scene, body), 2, _moved(scene, body, nearer))


def _around(scene: Scene, body: Body) -> tuple[str, ...]:
    own = (place.name for place in (*body.surfaces, *body.cavities))
    return (body.name, *own, *_on(scene, body))


def _moved(scene: Scene, body: Body, pose: Pose) -> Scene:
    """Return the scene with a body elsewhere, and all that stands on it."""
    shift = np.subtract(pose.position, body.pose.position)
    bodies = dict(scene.bodies)
    for name in (body.name, *_on(scene, body)):
        x, y, z = np.add(bodies[name].pose.position, shift)
        bodies[name] = replace(
            bodies[name], pose=replace(bodies[name].pose, position=(float(x), float(y), float(z)))
        )
    return replace(scene, bodies=bodies)


def _on(scene: Scene, body: Body) -> list[str]:
    """List the bodies that stand on a body or in it, or on those."""
    found: list[str] = []
    waiting = {body.name, *(place.name for place in (*body.surfaces, *body.cavities))}
    for name, other in scene.bodies.items():
        carried = other.support in waiting or body.name in other.carriers
        if carried or (other is not body and not other.movable and _below(scene, other) in waiting):
            found += [name, *_on(scene, other)]
    return list(dict.fromkeys(found))


def _below(scene: Scene, body: Body) -> str | None:
    """Find the surface or cavity right below a body's lowest point, to a centimetre."""
    low, high = bounds(body.parts, body.pose)
    middle = (low + high) / 2
    for place in (*scene.surfaces.values(), *scene.cavities.values()):
        if place.body == body.name:
            continue
        inside = scene.world_pose(place).inverse() @ Pose(
            (float(middle[0]), float(middle[1]), float(low[2]))
        )
        if abs(inside.position[2]) < 0.01 and all(
            abs(inside.position[i]) < place.size[i] / 2 for i in range(2)
        ):
            return place.name
    return None


def _small(body: Body) -> bool:
    low, high = bounds(body.parts, body.pose)
    return bool((high - low).max() <= MAX_MOVABLE_EDGE_M)


def _with(scene: Scene, body: Body) -> Scene:
    return replace(scene, bodies={**scene.bodies, body.name: body})


def _scaled(body: Body, factor: float) -> Body:
    """Scale a body down; it stands where it stood."""
    parts = tuple(scale_part(part, factor) for part in body.parts)
    sunk = float(bounds(body.parts, body.pose)[0][2] - bounds(parts, body.pose)[0][2])
    x, y, z = body.pose.position
    surfaces = tuple(
        replace(
            one,
            pose=scale_pose(one.pose, factor),
            size=(one.size[0] * factor, one.size[1] * factor),
        )
        for one in body.surfaces
    )
    return replace(
        body, parts=parts, surfaces=surfaces, pose=replace(body.pose, position=(x, y, z + sunk)),
        visuals=tuple(scale_visual(one, factor) for one in body.visuals),
        center_of_mass=body.center_of_mass and tuple(x * factor for x in body.center_of_mass),
    )  # fmt: skip


def _larger(body: Body, place: Surface | Cavity) -> Body | None:
    """Widen the places of a body of boxes, cavities in height too; None for other bodies."""
    if not all(
        isinstance(part.shape, Box) and part.pose.quaternion == Pose().quaternion
        for part in body.parts
    ):
        return None
    factors = np.array(
        (
            PLACE_GROWTH_FACTOR,
            PLACE_GROWTH_FACTOR,
            PLACE_GROWTH_FACTOR if isinstance(place, Cavity) else 1.0,
        )
    )

    def moved(pose: Pose) -> Pose:
        x, y, z = np.multiply(pose.position, factors)
        return replace(pose, position=(float(x), float(y), float(z)))

    parts: list[Part] = []
    for part in body.parts:
        if isinstance(part.shape, Box):
            x, y, z = np.multiply(part.shape.size, factors)
            parts.append(Part(Box((float(x), float(y), float(z))), moved(part.pose)))
    surfaces = tuple(
        replace(
            one,
            pose=moved(one.pose),
            size=(one.size[0] * PLACE_GROWTH_FACTOR, one.size[1] * PLACE_GROWTH_FACTOR),
            clearance=one.clearance * float(factors[2]),
        )
        for one in body.surfaces
    )
    cavities = tuple(
        replace(
            one,
            pose=moved(one.pose),
            size=(
                one.size[0] * PLACE_GROWTH_FACTOR,
                one.size[1] * PLACE_GROWTH_FACTOR,
                one.size[2] * float(factors[2]),
            ),
        )
        for one in body.cavities
    )
    return replace(body, parts=tuple(parts), surfaces=surfaces, cavities=cavities)
