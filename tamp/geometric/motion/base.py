"""Motions of the base through the room while the arm keeps its configuration."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.collision.arrangement import Arrangement
from tamp.geometric.motion.car import drive_curves
from tamp.geometric.motion.checker import Checker, EdgeTest
from tamp.geometric.motion.compiled_planner import Moving, connect_compiled
from tamp.geometric.motion.differential import RETREATS_M, YAW_COLUMNS, turn_and_drive
from tamp.geometric.motion.path import edge_lengths, inside, length, nearest, unwrap
from tamp.geometric.motion.planners import COMPILED, STEERINGS
from tamp.geometric.motion.result import Failure, MotionResult
from tamp.geometric.motion.shortcut import shortcut
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Room
from tamp.system.deadline import Deadline

if TYPE_CHECKING:
    from jaxtyping import Float

DISTANCE_WEIGHTS = np.array([1.0, 1.0, 0.5])
"""A radian of turning weighs half a metre, as in OMPL's SE2 space."""

MAX_EDGE_CHECKS = 200
"""Edges that RRTConnect may ask for at effort 0; each level allows four times as many."""

MAX_EDGE_M = 1.0
"""The longest edge of the trees, weighted metres."""

SAMPLING_DOMAIN_M = 10.0
"""Weighted metres that a sample may be away from where an edge was blocked."""

SHORTCUT_TRIES = 30
SHORTCUT_PATIENCE = 8
TURNING_RADIUS_M = 0.5
"""Of a base that may go sideways but is asked to drive like a car, metres."""

MAX_PAIRS = 12
"""Most combinations of a way out of the start and a way into the goal to try."""


def plan_base(
    checker: Checker,
    arm: Float[Array, " joints"],
    start: Float[Array, " 3"],
    goal: Float[Array, " 3"],
    room: Room,
    rng: np.random.Generator,
    deadline: Deadline,
    *,
    steering: str = "se2",
    turning_radius: float = TURNING_RADIUS_M,
    effort: int = 1,
    shortcuts: int = SHORTCUT_TRIES,
    planner: str = COMPILED,
) -> MotionResult:
    """Plan a collision-free path of the base from `start` to `goal`.

    With "se2" the base moves in any direction: the straight line (translating and turning at once),
    turning before or after driving, and backing away first are tried in this order, then
    RRTConnect; the path is shortened. With "reeds-shepp" it drives like a car, along sampled curves
    of `turning_radius` metres. With "differential" it turns on the spot and drives straight ahead
    or backwards. Every edge of the result has been certified by `checker.edge_free`
    as it is returned. Deterministic, as long as the deadline does not cut it.

    Args:
        checker: The robot, with what it holds, among the bodies.
        arm: Joint angles, shape (n,), radians.
        start: x, y in metres and yaw in radians, shape (3,).
        goal: The same; its yaw is meant up to whole turns.
        room: Where the base's centre may be.
        rng: The source of the planner's seed and of the shortcuts.
        deadline: Outer cap; the effort is the bound that keeps results reproducible.
        steering: One of STEERINGS.
        turning_radius: For "reeds-shepp", metres.
        effort: 0, 1, 2, ...: RRTConnect may check MAX_EDGE_CHECKS * 4**effort edges.
        shortcuts: Random cuts to try (not with "reeds-shepp").
        planner: One of `planners.PLANNERS`, for "se2"; other steerings and checkers other than an
            `Arrangement` get OMPL's.

    Returns:
        The path (n, 3) from exactly `start`; its last row is `goal`, the yaw up to whole turns; the
        numbers are unwrapped, so that no edge turns the longer way round.

    Raises:
        ValueError: Unknown steering.
    """
    if steering not in STEERINGS:
        raise ValueError(f"unknown steering '{steering}'. Choices: {', '.join(STEERINGS)}")
    start = np.asarray(start, dtype=float)
    goal = nearest(start, np.asarray(goal, dtype=float), YAW_COLUMNS)
    checks = 0

    def conf(base: Array) -> Array:
        return np.concatenate([base, arm])

    def edge_free(a: Array, b: Array) -> bool:
        nonlocal checks
        checks += 1
        return checker.edge_free(conf(a), conf(nearest(a, b, YAW_COLUMNS)))

    if not (inside(room, start) and inside(room, goal)):
        return MotionResult(None, Failure.LIMITS, checks)
    if not checker.free(conf(start)):
        return MotionResult(None, Failure.START, checks)
    if not checker.free(conf(goal)):
        return MotionResult(None, Failure.GOAL, checks)

    seed = int(rng.integers(1, 2**31))
    budget = MAX_EDGE_CHECKS * 4**effort
    if steering == "se2":
        path = _simple(start, goal, room, edge_free, deadline)
        if path is None:
            found, asked = _grown(
                checker, conf(start), conf(goal), room, edge_free, planner, seed, budget, deadline
            )
            checks += asked
            path = (
                None
                if found is None
                else unwrap(np.array([start, *found[1:-1], goal]), YAW_COLUMNS)
            )

        if path is not None and len(path) > 2:
            path, _ = shortcut(
                path, edge_free, rng, tries=shortcuts, patience=SHORTCUT_PATIENCE,
                weights=DISTANCE_WEIGHTS,
                periodic=YAW_COLUMNS,
            )  # fmt: skip
    elif steering == "differential":
        path = turn_and_drive(
            start, goal, room, edge_free, rng, seed=seed, checks=budget, deadline=deadline,
            tries=shortcuts,
        )  # fmt: skip
    else:
        path = drive_curves(
            start, goal, room, edge_free, turning_radius=turning_radius, seed=seed, checks=budget,
            deadline=deadline,
        )  # fmt: skip

    if path is not None and all(edge_free(a, b) for a, b in pairwise(path)):
        return MotionResult(path, None, checks)
    late = path is None and deadline.passed
    return MotionResult(None, Failure.TIME if late else Failure.EXHAUSTED, checks)


def _grown(
    checker: Checker, start: Array, goal: Array, room: Room, edge_free: EdgeTest, planner: str,
    seed: int, budget: int, deadline: Deadline,
) -> tuple[Array | None, int]:  # fmt: skip
    """Search a path (n, 3) between two configurations by trees; also the edges asked for that
    `edge_free` did not count.
    """
    if planner == COMPILED and isinstance(checker, Arrangement):
        lower, upper = (np.array([room.x[k], room.y[k], (2 * k - 1) * np.pi]) for k in (0, 1))
        found, asked = connect_compiled(
            checker, Moving(0, lower, upper, DISTANCE_WEIGHTS, YAW_COLUMNS[0]), start, goal[None],
            seed=seed, checks=budget, deadline=deadline, reach=MAX_EDGE_M, domain=SAMPLING_DOMAIN_M,
        )  # fmt: skip
        return None if found is None else found[:, :3], asked

    from tamp.geometric.motion.sampling_based import PlaneSpace, connect

    found, _ = connect(
        PlaneSpace(room.x, room.y), start[:3], [goal[:3]], edge_free, seed=seed, checks=budget,
        deadline=deadline, reach=MAX_EDGE_M,
    )  # fmt: skip
    return found, 0


def _simple(
    start: Array, goal: Array, room: Room, edge_free: EdgeTest, deadline: Deadline
) -> Array | None:
    """Return the first free one of the paths that a driver would think of."""
    for path in _turn_and_drive(start, goal):
        if deadline.passed:
            return None
        if all(edge_free(a, b) for a, b in pairwise(path)):
            return path
    ways_out = [start, *_retreats(start, room, edge_free)]
    ways_in = [goal, *_retreats(goal, room, edge_free)]
    paths = [np.array([start, out, into, goal]) for out in ways_out for into in ways_in]
    paths.sort(key=lambda path: length(path, DISTANCE_WEIGHTS))
    for path in paths[1 : MAX_PAIRS + 1]:  # the first is the straight line
        if deadline.passed:
            return None
        if edge_free(path[1], path[2]):
            return path[np.concatenate([[True], edge_lengths(path) > 0.0])]
    return None


def _turn_and_drive(start: Array, goal: Array) -> Iterator[Array]:
    yield np.array([start, goal])
    turned = np.array([start[0], start[1], goal[2]])
    arrived = np.array([goal[0], goal[1], start[2]])
    if start[2] != goal[2] and np.any(start[:2] != goal[:2]):
        yield np.array([start, turned, goal])
        yield np.array([start, arrived, goal])


def _retreats(base: Array, room: Room, edge_free: EdgeTest) -> Iterator[Array]:
    """List bases reached from `base` by sliding out, without turning: backwards first, then ever
    more to the sides.
    """
    for angle in np.pi + np.array([0.0, 1.0, -1.0, 2.0, -2.0]) * np.pi / 4:
        heading = base[2] + angle
        for distance in RETREATS_M:
            away = base + distance * np.array([np.cos(heading), np.sin(heading), 0.0])
            if not inside(room, away) or not edge_free(base, away):
                break
            yield away
