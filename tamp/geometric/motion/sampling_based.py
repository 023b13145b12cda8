"""RRTConnect, the bidirectional sampling-based planner. The only file that knows OMPL.

Kuffner and LaValle, "RRT-Connect: An efficient approach to single-query path planning", ICRA 2000.
OMPL's states are read by explicit slices: iterating over one crashes the process, and nothing
checks bounds.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import ompl.base as ob
import ompl.geometric as og
import ompl.util as ou

from tamp.geometric.motion.checker import EdgeTest
from tamp.geometric.scene.pose import Array
from tamp.system.deadline import Deadline

if TYPE_CHECKING:
    from jaxtyping import Float


SHORTEST_CURVE_M = 1e-9
"""Metres: ends nearer to each other than this are one."""

KIND_STEP_M = 1e-6
"""Metres of a curve over which it is looked at whether the car drives forwards, and where it turns;
the places where that changes are found as exactly."""

KIND_LOOKS_M = 0.02
"""Metres of a curve between those looks: pieces that are shorter may be overlooked."""

ITERATIONS_PER_CHECK = 20  # an iteration may ask for no check at all; it costs about 1 us


@dataclass(frozen=True)
class JointSpace:
    """The Euclidean space of joint angles between limits, shape (d,) each, radians."""

    lower: Sequence[float]
    upper: Sequence[float]

    def build(self) -> Any:
        """Build OMPL's space."""
        space = ob.RealVectorStateSpace(len(self.lower))
        bounds = ob.RealVectorBounds(len(self.lower))
        for i, (low, high) in enumerate(zip(self.lower, self.upper, strict=True)):
            bounds.setLow(i, float(low))
            bounds.setHigh(i, float(high))
        space.setBounds(bounds)
        return space

    def read(self, state: Any) -> list[float]:
        """Return the numbers of a state."""
        return state[0 : len(self.lower)]

    def write(self, state: Any, conf: Float[Array, " d"]) -> None:
        """Put the numbers into a state."""
        state[0 : len(self.lower)] = [float(value) for value in conf]


@dataclass(frozen=True)
class PlaneSpace:
    """Positions and headings in a rectangle: x and y limits in metres; the yaw wraps.

    Attributes:
        turning_radius: None for a base that moves in any direction; a radius in metres makes the
            edges Reeds-Shepp curves (Reeds and Shepp, "Optimal paths for a car that goes both
            forwards and backwards", 1990).
    """

    x: tuple[float, float]
    y: tuple[float, float]
    turning_radius: float | None = None

    def build(self) -> Any:
        """Build OMPL's space."""
        space = (
            ob.SE2StateSpace()
            if self.turning_radius is None
            else ob.ReedsSheppStateSpace(self.turning_radius)
        )
        bounds = ob.RealVectorBounds(2)
        for i, (low, high) in enumerate((self.x, self.y)):
            bounds.setLow(i, float(low))
            bounds.setHigh(i, float(high))
        space.setBounds(bounds)
        return space

    def read(self, state: Any) -> tuple[float, float, float]:
        """Return the numbers of a state."""
        return state.getX(), state.getY(), state.getYaw()

    def write(self, state: Any, conf: Float[Array, " d"]) -> None:
        """Put the numbers into a state, the yaw wrapped into [-pi, pi): pi itself is out of OMPL's
        bounds.
        """
        state.setXY(float(conf[0]), float(conf[1]))
        yaw = math.atan2(math.sin(conf[2]), math.cos(conf[2]))
        state.setYaw(-math.pi if yaw >= math.pi else yaw)


class _WholeEdges(ob.MotionValidator):
    """Asks for a whole edge in one call, and counts."""

    def __init__(
        self, information: ob.SpaceInformation, space: JointSpace | PlaneSpace, edge_free: EdgeTest
    ) -> None:
        super().__init__(information)
        self.space = space
        self.edge_free = edge_free
        self.checks = 0

    def checkMotion(self, start: Any, end: Any) -> bool:
        """Check an edge that the planner wants to add, which calls this back; it plans from the
        goals to the start.
        """
        self.checks += 1
        return bool(
            self.edge_free(np.array(self.space.read(end)), np.array(self.space.read(start)))
        )


def connect(
    space: JointSpace | PlaneSpace,
    start: Float[Array, " d"],
    goals: Sequence[Float[Array, " d"]],
    edge_free: EdgeTest,
    *,
    seed: int,
    checks: int,
    deadline: Deadline,
    reach: float,
) -> tuple[Float[Array, "n d"] | None, int]:
    """Search a path from `start` to any of `goals`, all of which the caller knows to be free and
    within the limits.

    The result depends on the arguments alone, as long as the deadline does not cut the search. An
    exception raised by `edge_free` (or by a signal handler while it runs) ends the search and
    reaches the caller.

    Args:
        space: What the numbers of a configuration mean, and their limits.
        start: Shape (d,).
        goals: One or more of shape (d,).
        edge_free: Whether the edge between two configurations is free.
        seed: Of OMPL's generator; any positive integer.
        checks: The most edges to ask for.
        deadline: Outer cap on the time.
        reach: The longest edge of the trees, in the space's unit (radians or metres).

    Returns:
        The vertices of the path (n, d), from exactly `start` to exactly one of `goals` (in a
        PlaneSpace: yaws in [-pi, pi)), or None; and the number of edges asked for. None at once
        when the space's bounds leave out the start or all goals: OMPL would wait for others until
        the time is up.
    """
    # setSeed logs an error that is none: the generators made below are all seeded by it.
    ou.setLogLevel(ou.LOG_NONE)
    ou.RNG.setSeed(seed)

    built = space.build()
    information = ob.SpaceInformation(built)
    validator = _WholeEdges(information, space, edge_free)
    information.setMotionValidator(validator)
    # An edge's test covers its ends.
    information.setStateValidityChecker(ob.AllValidStateValidityChecker(information))
    information.setup()
    problem = ob.ProblemDefinition(information)

    # Planned backwards: OMPL plants all of its starts at once, but a second goal only when the tree
    # of the first has grown, which it never does where the first is shut in.
    first, ends = (
        _state(built, space, start),
        [_state(built, space, goal) for goal in goals if _finite(goal)],
    )
    inside = [state for state in ends if built.satisfiesBounds(state)]
    if not inside or not _finite(start) or not built.satisfiesBounds(first):
        return None, 0

    for state in inside:
        problem.addStartState(state)

    root = ob.GoalStates(information)
    root.addState(first)
    problem.setGoal(root)

    planner = og.RRTConnect(information)
    planner.setRange(reach)
    planner.setProblemDefinition(problem)
    planner.setup()

    iterations = 0

    def finished() -> bool:
        nonlocal iterations
        iterations += 1
        return (
            validator.checks >= checks
            or iterations >= ITERATIONS_PER_CHECK * checks
            or deadline.passed
        )

    planner.solve(ob.PlannerTerminationCondition(finished))
    if not problem.hasExactSolution():
        return None, validator.checks

    solution: Any = problem.getSolutionPath()
    states = (solution.getState(i) for i in reversed(range(solution.getStateCount())))
    return np.array([space.read(state) for state in states]), validator.checks


def curve(
    plane: PlaneSpace, start: Float[Array, " 3"], end: Float[Array, " 3"], step: float
) -> Float[Array, "n 3"]:
    """Sample the shortest Reeds-Shepp curve of `plane`, at most `step` metres apart, where the car
    reverses and where it steers otherwise; shape (n, 3).

    The ends are exactly `start` and `end`.
    """
    built, radius = plane.build(), plane.turning_radius
    first, last, between = (_state(built, plane, conf) for conf in (start, end, start))
    length = float(built.distance(first, last))
    if radius is None or length < SHORTEST_CURVE_M:
        return np.array([start, end], dtype=float)

    def at(share: float) -> Array:
        built.interpolate(first, last, share, between)
        return np.array(plane.read(between))

    near = KIND_STEP_M / length

    def kind(share: float) -> tuple[bool, int]:
        """Say whether it drives forwards just there, and to which side it turns."""
        before, after = at(max(0.0, share - near)), at(min(1.0, share + near))
        way = after - before
        turn = math.remainder(way[2], math.tau)
        ahead = way[0] * math.cos(before[2] + turn / 2) + way[1] * math.sin(before[2] + turn / 2)
        return ahead > 0.0, round(turn * radius / (2 * near * length))

    changes = [0.0]
    looks = np.linspace(2 * near, 1.0 - 2 * near, max(2, math.ceil(length / KIND_LOOKS_M) + 1))
    kinds = [kind(share) for share in looks]
    for (low, before), (last_look, after) in pairwise(zip(looks.tolist(), kinds, strict=True)):
        while before != after:  # more than once where a piece is short
            high = last_look
            while high - low > near:
                middle = (low + high) / 2
                low, high = (middle, high) if kind(middle) == before else (low, middle)
            changes.append((low + high) / 2)
            low = min(last_look, high + 2 * near)
            before = kind(low)

    shares: list[float] = []
    for low, high in pairwise([*changes, 1.0]):
        pieces = max(1, math.ceil((high - low) * length / step))
        shares += np.linspace(low, high, pieces + 1)[:-1].tolist()
    return np.array([start, *(at(share) for share in shares[1:]), end], dtype=float)


def _finite(conf: Array) -> bool:
    """Check whether all numbers are finite: OMPL holds what is none to be within any bounds."""
    return bool(np.isfinite(conf).all())


def _state(built: Any, space: JointSpace | PlaneSpace, conf: Array) -> Any:
    state = built.allocState()
    space.write(state, conf)
    return state
