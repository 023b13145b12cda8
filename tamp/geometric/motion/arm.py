"""Motions of the arm while the base stands."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.collision.arrangement import Arrangement
from tamp.geometric.motion.checker import Checker, Limits
from tamp.geometric.motion.compiled_planner import Moving, Shortening, connect_compiled
from tamp.geometric.motion.planners import COMPILED
from tamp.geometric.motion.result import Failure, MotionResult
from tamp.geometric.motion.shortcut import shortcut
from tamp.geometric.scene.pose import Array
from tamp.system.deadline import Deadline

if TYPE_CHECKING:
    from jaxtyping import Float

MAX_EDGE_CHECKS = 250
"""Edges that RRTConnect may ask for at effort 0; each level allows four times as many."""

MAX_EDGE_RAD = 0.6
"""Radians, the longest edge of the trees: short ones cost little when they are blocked."""

SAMPLING_DOMAIN_RAD = 4.0
"""Radians that a sample may be away from where an edge was blocked."""

REACH_OMPL = 0.7
"""The same for OMPL's planner."""

SHORTCUT_TRIES = 30
SHORTCUT_PATIENCE = 5


def plan_arm(
    checker: Checker,
    base: Float[Array, " 3"],
    start: Float[Array, " joints"],
    goals: Float[Array, "... joints"],
    robot: Limits,
    rng: np.random.Generator,
    deadline: Deadline,
    *,
    effort: int = 1,
    shortcuts: int = SHORTCUT_TRIES,
    planner: str = COMPILED,
) -> MotionResult:
    """Plan a collision-free path of the arm from `start` to one of `goals`.

    The straight line is tried first, then RRTConnect, whose path is shortened; every edge of the
    result has been certified by `checker.edge_free` as it is returned. Deterministic, as long as
    the deadline does not cut it.

    Args:
        checker: The robot among the bodies.
        base: x, y in metres and yaw, shape (3,).
        start: Joint angles, shape (n,), radians.
        goals: One goal (n,) or several (k, n); those in collision are left out.
        robot: Gives the joint limits.
        rng: Advanced by two draws at most per call, plus those of the shortcuts.
        deadline: Outer cap; the effort is the bound that keeps results reproducible.
        effort: 0, 1, 2, ...: RRTConnect may check MAX_EDGE_CHECKS * 4**effort edges.
        shortcuts: Random cuts to try.
        planner: One of `planners.PLANNERS`; checkers other than an `Arrangement` get OMPL's.

    Returns:
        The path (m, n), beginning with `start` and ending with one of `goals`, both exactly.
    """
    start = np.asarray(start, dtype=float)
    candidates = np.atleast_2d(np.asarray(goals, dtype=float))
    lower, upper = np.asarray(robot.lower, dtype=float), np.asarray(robot.upper, dtype=float)

    def conf(arm: Array) -> Array:
        return np.concatenate([base, arm])

    def edge_free(a: Array, b: Array) -> bool:
        return checker.edge_free(conf(a), conf(b))

    def inside(arm: Array) -> bool:
        return bool(((lower <= arm) & (arm <= upper)).all())

    candidates = candidates[[inside(goal) for goal in candidates]]
    if not inside(start) or not len(candidates):
        return MotionResult(None, Failure.LIMITS, 0)
    if not checker.free(conf(start)):
        return MotionResult(None, Failure.START, 0)
    candidates = candidates[[checker.free(conf(goal)) for goal in candidates]]
    if not len(candidates):
        return MotionResult(None, Failure.GOAL, 0)

    candidates = candidates[np.argsort(np.linalg.norm(candidates - start, axis=1), kind="stable")]
    checks = 0
    for goal in candidates:
        checks += 1
        if edge_free(start, goal):
            return MotionResult(np.array([start, goal]), None, checks)
        if deadline.passed:
            return MotionResult(None, Failure.TIME, checks)

    seed, budget = int(rng.integers(1, 2**31)), MAX_EDGE_CHECKS * 4**effort
    if planner == COMPILED and isinstance(checker, Arrangement):
        moving = Moving(3, lower, upper, np.ones(len(lower)))
        found, asked = connect_compiled(
            checker, moving, conf(start), np.array([conf(goal) for goal in candidates]), seed=seed,
            checks=budget, deadline=deadline, reach=MAX_EDGE_RAD, domain=SAMPLING_DOMAIN_RAD,
            shortening=Shortening(shortcuts, SHORTCUT_PATIENCE),
        )  # fmt: skip
        path = None if found is None else found[:, 3:]
    else:
        from tamp.geometric.motion.sampling_based import JointSpace, connect

        path, asked = connect(
            JointSpace(tuple(lower), tuple(upper)), start, list(candidates), edge_free, seed=seed,
            checks=budget, deadline=deadline, reach=REACH_OMPL,
        )  # fmt: skip
        if path is not None:
            path, more = shortcut(path, edge_free, rng, tries=shortcuts, patience=SHORTCUT_PATIENCE)
            asked += more

    if path is None:
        failure = Failure.TIME if deadline.passed else Failure.EXHAUSTED
        return MotionResult(None, failure, checks + asked)

    checks += asked + len(path) - 1
    certified = all(edge_free(a, b) for a, b in pairwise(path))
    return MotionResult(
        path if certified else None, None if certified else Failure.EXHAUSTED, checks
    )
