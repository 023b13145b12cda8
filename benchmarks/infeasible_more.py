"""More problems without a plan whose cause is known: goals that exclude each other, doors, heights, shapes, loads."""

from __future__ import annotations

from collections.abc import Callable

from numpy.random import Generator as Random

from benchmarks.infeasible_scenes import Case, box, case, cupboard, name_of

MANY = (1, 4, 8, 12, 20)
"""Movable bodies where goals exclude each other."""


def _crowd(rng: Random, count: int) -> tuple[str, str]:
    """So many boxes on a table of their own, and the name of one of them."""
    text = "  long_table: {furniture: table, size: [2.0, 0.7, 0.72], at: [0.0, 2.0, 0.0]}\n"
    for i in range(count):
        x, y = -0.85 + 0.19 * (i % 10), -0.15 + 0.25 * (i // 10)
        text += (
            f"  box_{i}: {{box: [0.05, 0.05, {rng.uniform(0.08, 0.15):.3f}], on: long_table, at: [{x:.2f}, {y:.2f}]}}\n"
        )
    return text, f"box_{int(rng.integers(count))}"


EXCLUDE = ("cannot both", "cannot hold together")


def in_and_on(rng: Random) -> Case:
    """One of many bodies shall be in the cupboard and on it."""
    text, name = _crowd(rng, int(rng.choice(MANY)))
    goal = f"(and (inside {name} cupboard_1) (on {name} cupboard_top))"
    return case("in_and_on", rng, cupboard() + text, goal, (("inside " + name,), ("on " + name,), EXCLUDE))


def all_and_one(rng: Random) -> Case:
    """All of many bodies shall be on one table, and one of them on the other."""
    text, name = _crowd(rng, int(rng.choice(MANY[1:])))
    goal = f"(and (forall (?o - movable) (on ?o long_table)) (on {name} table))"
    cause = ((f"(on {name} long_table)",), (f"(on {name} table)",), EXCLUDE)
    return case("all_and_one", rng, text, goal, cause)


def two_in_hand(rng: Random) -> Case:
    """Two of many bodies shall be in the hand at the end."""
    text, name = _crowd(rng, int(rng.choice(MANY[1:])))
    other = "box_0" if name != "box_0" else "box_1"
    goal = " ".join(f"(exists (?g - grasp) (holding {one} ?g))" for one in (name, other))
    cause = ((f"holding {name}",), (f"holding {other}",), EXCLUDE)
    return case("two_in_hand", rng, text, f"(and {goal})", cause)


def out_of_hand(rng: Random) -> Case:
    """The hand shall be empty and hold a body."""
    text, name = _crowd(rng, int(rng.choice(MANY)))
    goal = f"(and (hand-empty) (exists (?g - grasp) (holding {name} ?g)))"
    return case("out_of_hand", rng, text, goal, (("hand-empty",), (f"holding {name}",), EXCLUDE))


def rather_high(rng: Random) -> Case:
    """The body stands on a board that the arm's length would get up to, but no hand that holds something."""
    name, height = name_of(rng), rng.uniform(1.55, 1.7)
    board = f"  board: {{box: [0.8, 0.3, 0.03], at: [-1.6, 0.4, {height:.2f}], yaw: 90 deg, fixed: true}}\n"
    text = board + box(rng, name, "board", at="[0.0, 0.0]")
    return case("rather_high", rng, text, f"(on {name} table)", ((name,), ("too high",), ("the hand reaches to 1.",)))


def goal_rather_high(rng: Random) -> Case:
    """The surface that the goal names is as high."""
    name, height = name_of(rng), rng.uniform(1.55, 1.7)
    board = f"  loft: {{box: [0.8, 0.3, 0.03], at: [-1.6, 0.4, {height:.2f}], yaw: 90 deg, fixed: true}}\n"
    text = board + box(rng, name, "table")
    return case("goal_rather_high", rng, text, f"(on {name} loft)", ((name, "loft"), ("too high",), ("reaches to 1.",)))


def too_flat(rng: Random) -> Case:
    """A plate lies on the table: wide all around, and no finger gets under it."""
    name, side = name_of(rng), rng.uniform(0.12, 0.18)
    text = cupboard() + box(rng, name, "table", (side, side, rng.uniform(0.004, 0.008)))
    return case("too_flat", rng, text, f"(on {name} cupboard_top)", ((name,), ("too flat to be grasped",)))


def laden(rng: Random) -> Case:
    """On the body stands one that nobody can take away: too wide for the hand."""
    name, other = name_of(rng), "crate"
    width = rng.uniform(0.1, 0.13)
    text = cupboard() + box(rng, name, "table", (0.07, 0.07, 0.1), at="[0.0, 0.0]")
    text += f"  {other}: {{box: [{width:.3f}, {width:.3f}, {width:.3f}], on: {name}, at: [0.0, 0.0]}}\n"
    return case("laden", rng, text, f"(on {name} cupboard_top)", ((name,), (f"loaded with {other}",)))


def ball(rng: Random) -> Case:
    """A ball shall be put down on a plain surface."""
    name = name_of(rng)
    ring = f"  {name}: {{sphere: {rng.uniform(0.025, 0.035):.3f}, on: table, at: [0.0, -0.1]}}\n"
    return case("ball", rng, cupboard() + ring, f"(on {name} cupboard_top)", (("a sphere rests on no stable face",),))


def _wall(door: float, middle: float = 0.3) -> str:
    """A wall through the room with a door in it, and a table behind."""
    text = "  side_table: {furniture: table, size: [0.6, 0.6, 0.7], at: [-2.1, 0.0, 0.0]}\n"
    for i, (low, high) in enumerate(((-3.0, middle - door / 2), (middle + door / 2, 3.0))):
        size, y = f"[0.05, {high - low:.4f}, 2.0]", (low + high) / 2
        text += f"  wall_{i}: {{box: {size}, at: [-0.8, {y:.4f}, 1.0], fixed: true, surfaces: {{}}}}\n"
    return text


def narrow_door(rng: Random) -> Case:
    """The door between the robot and the body is much narrower than the base."""
    name, door = name_of(rng), round(rng.uniform(0.4, 0.62), 2)
    text = _wall(door) + box(rng, name, "side_table", at="[0.0, 0.0]")
    return case("narrow_door", rng, text, f"(on {name} table)", ((f"the door is {door:.2f} m",), ("the base 0.70 m",)))


def tight_door(rng: Random) -> Case:
    """The door is as wide as the base."""
    name = name_of(rng)
    text = _wall(0.7) + box(rng, name, "side_table", at="[0.0, 0.0]")
    return case("tight_door", rng, text, f"(on {name} table)", (("the door is 0.70 m",), ("the base 0.70 m",)))


def on_a_tray(rng: Random) -> Case:
    """The body shall stand on one that may be moved itself."""
    name = name_of(rng)
    top = "surfaces: {tray_top: {at: [0.0, 0.0, 0.01], size: [0.3, 0.2]}}"
    text = box(rng, name, "table") + f"  tray: {{box: [0.3, 0.2, 0.02], on: table, at: [0.3, 0.0], {top}}}\n"
    return case("on_a_tray", rng, text, f"(on {name} tray_top)", (("tray",), ("may be moved",)))


MORE: tuple[Callable[[Random], Case], ...] = (
    in_and_on, all_and_one, two_in_hand, out_of_hand, rather_high, goal_rather_high, too_flat, laden, ball, narrow_door,
    tight_door, on_a_tray,
)  # fmt: skip
