"""Problems without a plan whose cause is known, because each was built around it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from numpy.random import Generator as Random

HEAD = """\
name: {name}
domain: cupboard
robot: {{model: panda_mobile, base: [0.0, 0.0, 0 deg]}}
room: {{x: [-2.5, 2.5], y: [-2.5, 2.5]}}

bodies:
  table: {{furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0.0, 0.0], yaw: 90 deg}}
"""

CANDIDATES = ("soup_can", "mustard", "sugar_box", "tuna_can", "cracker_box")
"""Names for what the goal is about, so that no cause hangs on one."""


@dataclass(frozen=True)
class Case:
    """A problem without a plan.

    Attributes:
        kind: What is wrong with it.
        text: The problem file.
        cause: What one line of the explanation must contain to name the cause: every group by one of its words.
    """

    kind: str
    text: str
    cause: tuple[tuple[str, ...], ...]


def case(kind: str, rng: Random, bodies: str, goal: str, cause: tuple[tuple[str, ...], ...]) -> Case:
    """A case with some bodies that have nothing to do with it."""
    others = "".join(
        f"  other_{i}: {{box: [0.06, 0.06, {rng.uniform(0.08, 0.15):.3f}], on: table, "
        f"at: [{-0.45 + 0.3 * i:.2f}, {rng.uniform(0.2, 0.26):.3f}]}}\n"
        for i in range(int(rng.integers(0, 3)))
    )
    return Case(kind, f"{HEAD.format(name=kind)}{bodies}{others}\ngoal: {goal}\n", cause)


def name_of(rng: Random) -> str:
    return str(rng.choice(CANDIDATES))


def box(rng: Random, name: str, place: str, size: tuple[float, float, float] | None = None, at: str = "") -> str:
    x, y, z = size or (rng.uniform(0.04, 0.06), rng.uniform(0.04, 0.06), rng.uniform(0.08, 0.16))
    where = at or f"[{rng.uniform(-0.2, 0.2):.3f}, {rng.uniform(-0.15, 0.1):.3f}]"
    return f"  {name}: {{box: [{x:.3f}, {y:.3f}, {z:.3f}], on: {place}, at: {where}}}\n"


def cupboard(size: str = "[0.9, 0.42, 0.9]", options: str = "compartments: 2") -> str:
    return f"  cupboard: {{furniture: cupboard, size: {size}, {options}, at: [-1.6, 0.3, 0.0], yaw: 90 deg}}\n"


def start_too_high(rng: Random) -> Case:
    """The body stands on a board that no arm gets up to."""
    name, height = name_of(rng), rng.uniform(2.2, 2.6)
    board = f"  board: {{box: [0.8, 0.3, 0.03], at: [-1.6, 0.4, {height:.2f}], yaw: 90 deg, fixed: true}}\n"
    bodies = board + box(rng, name, "board", at="[0.0, 0.0]")
    return case("start_too_high", rng, bodies, f"(on {name} table)", ((name,), ("out of reach",)))


def start_outside(rng: Random) -> Case:
    """The body stands on a table far outside of the room."""
    name = name_of(rng)
    far = f"  far_table: {{furniture: table, size: [0.6, 0.6, 0.7], at: [{rng.uniform(4.6, 6):.2f}, 0.0, 0.0]}}\n"
    bodies = far + box(rng, name, "far_table", at="[0.0, 0.0]")
    return case("start_outside", rng, bodies, f"(on {name} table)", ((name,), ("outside of the room",)))


def goal_too_high(rng: Random) -> Case:
    """The surface that the goal names is out of the arm's reach."""
    name, height = name_of(rng), rng.uniform(2.2, 2.6)
    board = f"  loft: {{box: [0.8, 0.3, 0.03], at: [-1.6, 0.4, {height:.2f}], yaw: 90 deg, fixed: true}}\n"
    bodies = board + box(rng, name, "table")
    return case("goal_too_high", rng, bodies, f"(on {name} loft)", (("loft",), ("out of reach",)))


def too_tall(rng: Random) -> Case:
    """The body fits into the compartment neither upright nor lying."""
    name, side = name_of(rng), rng.uniform(0.2, 0.23)
    bodies = cupboard(f"[0.46, {side:.2f}, 0.86]", "compartments: [2, 2], plinth: 0.4")
    bodies += box(rng, name, "table", (0.07, rng.uniform(0.24, 0.28), rng.uniform(0.26, 0.32)))
    return case("too_tall", rng, bodies, f"(inside {name} cupboard_1)", ((name,), ("cupboard_1",), ("protrudes",)))


def too_wide(rng: Random) -> Case:
    """No edge of the body is narrower than the open hand."""
    name = name_of(rng)
    size = (rng.uniform(0.1, 0.2), rng.uniform(0.1, 0.2), rng.uniform(0.1, 0.2))
    bodies = cupboard() + box(rng, name, "table", size)
    return case("too_wide", rng, bodies, f"(on {name} cupboard_top)", ((name,), ("no grasp",)))


def fixed(rng: Random) -> Case:
    """The goal wants a fixed body elsewhere."""
    name = name_of(rng)
    size = f"[{rng.uniform(0.05, 0.07):.3f}, 0.06, 0.12]"
    bodies = cupboard() + f"  {name}: {{box: {size}, on: table, at: [0.0, 0.0], fixed: true}}\n"
    return case("fixed", rng, bodies, f"(on {name} cupboard_top)", ((name,), ("fixed",)))


def two_places(rng: Random) -> Case:
    """The goal wants one body in two places."""
    name, compartment = name_of(rng), int(rng.integers(1, 3))
    bodies = cupboard() + box(rng, name, "table")
    goal = f"(and (on {name} cupboard_top) (inside {name} cupboard_{compartment}))"
    return case("two_places", rng, bodies, goal, ((name,), ("cannot both", "exclude", "at once")))


def too_small_for_all(rng: Random) -> Case:
    """The boxes that shall stand on a tray need more room than it has."""
    side = rng.uniform(0.05, 0.055)  # of three points in this square two are nearer than 0.06 m
    width = rng.uniform(0.062, 0.066)
    bodies = f"  pedestal: {{box: [{side:.3f}, {side:.3f}, 0.7], at: [-1.4, 0.3, 0.35], fixed: true}}\n"
    names = [str(name) for name in rng.permutation(CANDIDATES)[:3]]
    for name, x in zip(names, (-0.4, -0.1, 0.2), strict=True):
        bodies += box(rng, name, "table", (width, width, 0.1), at=f"[{x}, 0.0]")
    goal = f"(and {' '.join(f'(on {name} pedestal)' for name in names)})"
    others = tuple(f"hits {name}" for name in names)
    return case("too_small_for_all", rng, bodies, goal, (("pedestal",), others))


def covered(rng: Random) -> Case:
    """A fixed body covers the surface that the goal names."""
    name = name_of(rng)
    bodies = "  stand: {box: [0.4, 0.4, 0.6], at: [-1.4, 0.3, 0.3], fixed: true}\n"
    height = rng.uniform(0.2, 0.4)
    bodies += (
        f"  monitor: {{box: [0.39, 0.39, {height:.2f}], on: stand, at: [0.0, 0.0], fixed: true, surfaces: {{}}}}\n"
    )
    bodies += box(rng, name, "table")
    return case("covered", rng, bodies, f"(on {name} stand)", ((name,), ("stand",), ("hits monitor",)))


def caged(rng: Random) -> Case:
    """Fixed walls around the body leave no room for the hand."""
    name = name_of(rng)
    inner, height = rng.uniform(0.085, 0.1), rng.uniform(0.3, 0.4)
    at = (inner + 0.024) / 2
    bodies = ""
    for i in range(4):
        angle = i * math.pi / 2
        x, y, long = at * math.cos(angle), at * math.sin(angle), inner + (0.044 if i % 2 else 0.0)
        bodies += (
            f"  wall_{i}: {{box: [0.02, {long:.3f}, {height:.2f}], on: table, at: [{x:.3f}, {y:.3f}], "
            f"yaw: {90 * i} deg, fixed: true, surfaces: {{}}}}\n"
        )
    bodies += f"  {name}: {{box: [0.05, 0.05, 0.1], on: table, at: [0.0, 0.0]}}\n"
    bodies = cupboard() + bodies
    return case("caged", rng, bodies, f"(on {name} cupboard_top)", ((name,), ("hits wall_", "hand hits wall_")))


def walled_in(rng: Random) -> Case:
    """A wall through the room separates the robot from the table with the body."""
    name, x = name_of(rng), rng.uniform(-0.9, -0.7)
    size = f"[0.05, 6.0, {rng.uniform(1.6, 2.2):.2f}]"
    bodies = f"  wall: {{box: {size}, at: [{x:.2f}, 0.0, 1.1], fixed: true, surfaces: {{}}}}\n"
    bodies += "  side_table: {furniture: table, size: [0.6, 0.6, 0.7], at: [-2.1, 0.0, 0.0]}\n"
    bodies += box(rng, name, "side_table", at="[0.0, 0.0]")
    reasons = ("straight ahead: wall", "no way leads there: wall")
    return case("walled_in", rng, bodies, f"(on {name} table)", ((name, "move"), reasons))


def loaded(rng: Random) -> Case:
    """On the body stands another one that is too wide for the hand."""
    name = name_of(rng)
    bodies = cupboard() + box(rng, name, "table", (0.07, 0.07, 0.1), at="[0.0, 0.0]")
    width = rng.uniform(0.1, 0.13)
    bodies += f"  slab: {{box: [{width:.3f}, {width:.3f}, {width:.3f}], on: {name}, at: [0.0, 0.0]}}\n"
    return case("loaded", rng, bodies, f"(on {name} cupboard_top)", (("slab",), ("no grasp",)))


KINDS: tuple[Callable[[Random], Case], ...] = (
    start_too_high, start_outside, goal_too_high, too_tall, too_wide, fixed, two_places, too_small_for_all, covered,
    caged, walled_in, loaded,
)  # fmt: skip
