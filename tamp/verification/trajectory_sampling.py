"""Sample a motion so finely that nothing can hide between two samples."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.states import rest_row, with_arm
from tamp.geometric.scene.pose import Array
from tamp.simulation.solid import Solid
from tamp.simulation.world import World
from tamp.verification.execution_state import Held, carried
from tamp.verification.link_frames import LinkFrames, base_frames, matrices
from tamp.verification.makers_limits import limits_of

POINT_STEP_M = 0.005
"""Metres that any point of the robot or the held body moves between two samples, at most."""
JOINT_STEP_RAD = math.radians(0.5)
"""Radians that any joint or the base turns between two samples, at most."""
FIRST_STEP_RAD = 0.2
"""Radians that all joints together turn between first samples, so that chords tell arcs."""
STEP_SAFETY_FACTOR = 1.1
"""How much finer than the chords ask for."""
MAX_REFINEMENTS = 4
ROUGH_REACH_M = 2.0
"""Metres from any joint to any point of the robot and its load, roughly: for piece sizes only."""
MAX_PIECE_SAMPLES = 4096
"""Samples of a piece of a motion that are made at once, at most, by a rough count."""
MAX_PIECE_ROWS = 64
"""Rows of a piece, at most."""
MOTIONS = 2
"""Motions that are remembered: facts about one reach, which has two, come one after the other."""
KEPT = 4096
"""States of a motion that is remembered, at most."""


@dataclass(frozen=True, eq=False)
class SampledMotion:
    """A motion, sampled: n states, and what moves in them, the links and the pieces held.

    Attributes:
        rows, times: The states, shape (n, 4 + joints), and their seconds, shape (n,).
        shaped: Whether the robot's shape differs from the one of the state before, shape (n,).
        frames: T_world_link of the links and after them of the held pieces' owners, shape
            (movers, n, 4, 4).
        low, high: Corners of the axis-aligned boxes around the movers, shape (movers, n, 3).
        ways: Metres that no point of a mover has moved more than since the first state, shape
            (movers, n).
    """

    rows: Array
    times: Array
    shaped: NDArray[np.bool_]
    frames: Array
    low: Array
    high: Array
    ways: Array

    @cached_property
    def swept(self) -> tuple[Array, Array]:
        """Box all that each mover sweeps: corners, each (movers, 3)."""
        return self.low.min(axis=1), self.high.max(axis=1)

    def part(self, some: slice) -> SampledMotion:
        """Take some of the states."""
        if some.start == 0 and len(self.rows) <= some.stop:
            return self
        moving = (self.frames, self.low, self.high, self.ways)
        return SampledMotion(
            self.rows[some], self.times[some], self.shaped[some], *(one[:, some] for one in moving)
        )


class Sampler:
    """Samples motions of a world's robot. A state is [x, y, yaw, q1..qn, opening], m and rad."""

    def __init__(self, world: World, robot: Robot) -> None:
        self._world, self._robot = world, robot
        self._links: list[Solid] = list(world.links.values())
        self._hands = [list(world.links).index(arm.hand) for arm in robot.arms]
        self._T_hand_tools = [arm.T_hand_tool.matrix for arm in robot.arms]
        self._rest = rest_row(robot)
        self._frames_of = LinkFrames(world, robot)
        self._hand_radii: dict[tuple[int, float], float] = {}
        self._lately: dict[bytes, list[SampledMotion]] = {}

    def tool(self, row: Array, arm: int = 0) -> Array:
        """Compute T_world_tool (4, 4) of an arm in a state, by the engine's forward kinematics."""
        self._world.set_state(row)
        hand = self._world.link_frames()[self._hands[arm]]
        return matrices(hand[None])[0] @ self._T_hand_tools[arm]

    def hand_radius(self, opening: float, arm: int = 0) -> float:
        """Bound the distance of an arm's tool frame from any point of hand and fingers, metres."""
        if (arm, opening) not in self._hand_radii:
            row = with_arm(self._robot, self._rest, arm, None, opening)
            frames = self._frames(row[None], ())
            points = frames[:, 0] @ _corners(self._links)
            tool = (frames[self._hands[arm], 0] @ self._T_hand_tools[arm])[:3, 3]
            own = [link.owner in self._robot.arms[arm].grippers for link in self._links]
            reaches = np.linalg.norm(points[own, :3] - tool[:, None], axis=1)
            self._hand_radii[arm, opening] = float(reaches.max())
        return self._hand_radii[arm, opening]

    def movers(self, held: Sequence[Held]) -> list[Solid]:
        """List what moves: the links, and the pieces of what is in the hands."""
        bodies = [one.body for one in carried(held)]
        return self._links + [piece for body in bodies for piece in self._world.solids[body]]

    def motions(self, rows: Array, times: Array, held: Sequence[Held]) -> Iterator[SampledMotion]:
        """Yield a motion, sampled, in pieces that fit memory; the last few are remembered."""
        parts = [rows, times, *(one.T_tool_body for one in carried(held))]
        names = " ".join(f"{one.body} {one.arm}" for one in carried(held))
        key = b" ".join([names.encode(), *(np.ascontiguousarray(part).tobytes() for part in parts)])
        if key in self._lately:
            yield from self._lately[key]
            return

        made: list[SampledMotion] = []
        states = 0
        for some, then in self.pieces(rows, times):
            motion = self.sampled(some, then, held)
            states += len(motion.rows)
            if states <= KEPT:
                made.append(motion)
            yield motion
        if states <= KEPT:
            while len(self._lately) >= MOTIONS:
                del self._lately[next(iter(self._lately))]
            self._lately[key] = made

    def clipped(self, rows: Array) -> Array:
        """Clip rows to no farther out of the limits than matters; being out is reported elsewhere.

        The yaw has no limits: it stays as it is.
        """
        room = self._world.scene.room
        low, high = [room.x[0] - 1, room.y[0] - 1, -np.inf], [room.x[1] + 1, room.y[1] + 1, np.inf]
        for arm in map(limits_of, self._robot.arms):
            low += [*(limit - 1 for limit in arm.lower), 0.0]
            high += [*(limit + 1 for limit in arm.upper), arm.opening]
        return np.clip(rows, np.array(low), np.array(high))

    def pieces(self, rows: Array, times: Array) -> Iterator[tuple[Array, Array]]:
        """Yield a motion's rows and times in pieces that fit memory, however far its rows are."""
        rows = _unwound(self.clipped(rows))
        if len(rows) == 1:
            yield rows, times
            return
        change = np.abs(np.diff(rows, axis=0))
        ways = np.linalg.norm(change[:, :2], axis=1) + ROUGH_REACH_M * change[:, 2:-1].sum(axis=1)
        first, cost = 0, 0.0
        for edge, needs in enumerate((ways / POINT_STEP_M).tolist()):
            if edge > first and (
                cost + needs > MAX_PIECE_SAMPLES or edge - first >= MAX_PIECE_ROWS
            ):
                yield rows[first : edge + 1], times[first : edge + 1]
                first, cost = edge, 0.0
            cost += needs
            if needs > MAX_PIECE_SAMPLES:
                yield from _cut(
                    rows[edge : edge + 2],
                    times[edge : edge + 2],
                    math.ceil(needs / MAX_PIECE_SAMPLES),
                )
                first, cost = edge + 1, 0.0
        if first < len(rows) - 1:
            yield rows[first:], times[first:]

    def sampled(self, rows: Array, times: Array, held: Sequence[Held]) -> SampledMotion:
        """Interpolate rows and times, in steps of POINT_STEP_M and JOINT_STEP_RAD at most."""
        if len(rows) > 1:
            turned = np.abs(np.diff(rows[:, 2:-1], axis=0)).sum(axis=1)
            rows, times = _divided(rows, times, np.ceil(turned / FIRST_STEP_RAD))
        solids = self.movers(held)
        corners = _corners(solids)
        frames = self._frames(rows, held)
        chords = _chords(frames, corners)
        for _ in range(MAX_REFINEMENTS):
            change = np.abs(np.diff(rows[:, 2:-1], axis=0)).max(axis=1, initial=0.0)
            moved = chords.max(axis=0, initial=0.0)
            parts = np.maximum(moved / POINT_STEP_M, change / JOINT_STEP_RAD)
            if (parts <= 1 + 1e-6).all():
                break
            rows, times = _divided(rows, times, np.ceil(parts * STEP_SAFETY_FACTOR))
            frames = self._frames(rows, held)
            chords = _chords(frames, corners)

        shaped = np.ones(len(rows), dtype=bool)
        shaped[1:] = (rows[1:, 3:] != rows[:-1, 3:]).any(axis=1)
        ways = np.zeros((len(solids), len(rows)))
        np.cumsum(chords, axis=1, out=ways[:, 1:])
        return SampledMotion(rows, times, shaped, frames, *_boxes(solids, frames), ways)

    def _frames(self, rows: Array, held: Sequence[Held]) -> Array:
        """Compute the movers' frames, shape (movers, n, 4, 4); rigid while only the base moves."""
        first = np.ones(len(rows), dtype=bool)
        first[1:] = (rows[1:, 3:] != rows[:-1, 3:]).any(axis=1)
        frames = self._frames_of(rows[first])
        if not first.all():
            T_base_links = np.linalg.inv(frames[:1]) @ frames
            frames = base_frames(rows[:, :3]) @ T_base_links[:, np.cumsum(first) - 1]
        if not held:
            return frames
        tools = [frames[hand] @ T for hand, T in zip(self._hands, self._T_hand_tools, strict=True)]
        moved = [
            tools[one.arm] @ one.T_tool_body
            for one in carried(held)
            for _ in self._world.solids[one.body]
        ]
        return np.concatenate([frames, np.stack(moved)])


def _corners(solids: Sequence[Solid]) -> Array:
    """List the corners of solids' boxes in their owners' frames, shape (solids, 4, 8)."""
    signs = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
    points = np.stack([solid.centre + signs * solid.half for solid in solids])
    return np.concatenate([points, np.ones((len(solids), 8, 1))], axis=2).transpose(0, 2, 1)


def _chords(frames: Array, corners: Array) -> Array:
    """Measure how far any point of a solid moves from state to state, shape (solids, n - 1).

    The farthest is a corner: what rigid motion adds to a point is affine in the point.
    """
    count, states = frames.shape[:2]
    points = (frames.reshape(count, states * 4, 4) @ corners).reshape(count, states, 4, 8)
    squares = np.square(points[:, 1:, :3] - points[:, :-1, :3])
    lengths = squares[:, :, 0] + squares[:, :, 1] + squares[:, :, 2]
    for half in (4, 2, 1):  # a reduction along so short an axis is slow
        lengths = np.maximum(lengths[..., :half], lengths[..., half:])
    return np.sqrt(lengths[..., 0])


def _boxes(solids: Sequence[Solid], frames: Array) -> tuple[Array, Array]:
    """Compute axis-aligned boxes of solids at these frames: corners, each (solids, n, 3)."""
    centres = np.array([[*solid.centre, 1.0] for solid in solids])[:, None, :, None]
    halves = np.array([solid.half for solid in solids])[:, None, :, None]
    middles = (frames[:, :, :3] @ centres)[..., 0]
    extents = (np.abs(frames[:, :, :3, :3]) @ halves)[..., 0]
    return middles - extents, middles + extents


def _divided(rows: Array, times: Array, parts: Array) -> tuple[Array, Array]:
    """Divide a polyline: its i-th edge in parts[i] equal pieces (at least one)."""
    counts = np.maximum(parts, 1).astype(np.intp)
    edges = np.repeat(np.arange(len(counts)), counts)
    number = np.arange(len(edges)) - (np.cumsum(counts) - counts)[edges]
    share = (edges + number * (1.0 / counts)[edges]) - edges
    columns = np.column_stack([times, rows])
    between = share[:, None] * np.diff(columns, axis=0)[edges] + columns[edges]
    divided = np.concatenate([between, columns[-1:]])
    return divided[:, 1:], divided[:, 0]


def _unwound(rows: Array) -> Array:
    """Unwind yaws: the same motion near zero, with no more turns than make a difference.

    A base that turns on the spot is everywhere after one turn; one that moves on by less than
    POINT_STEP_M in a turn is, after as many turns as it goes steps of that length, within
    POINT_STEP_M of wherever it was.
    """
    turning = np.diff(rows[:, 2])
    moved = np.linalg.norm(np.diff(rows[:, :2], axis=0), axis=1)
    kept = math.tau * np.maximum(1.0, np.ceil(moved / POINT_STEP_M))
    turning = np.where(
        np.abs(turning) > kept, np.sign(turning) * kept + np.fmod(turning, math.tau), turning
    )
    rows = rows.copy()
    rows[:, 2] = rows[0, 2] % math.tau + np.concatenate([[0.0], np.cumsum(turning)])
    return rows


def _cut(edge: Array, times: Array, count: int) -> Iterator[tuple[Array, Array]]:
    """Cut an edge of two rows in equal pieces."""
    for piece in range(count):
        share = np.array([[piece / count], [(piece + 1) / count]])
        yield edge[0] + share * (edge[1] - edge[0]), times[0] + share[:, 0] * (times[1] - times[0])
