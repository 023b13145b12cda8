"""Collision detection along motions: the robot and the body in its hand against the scene."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array
from tamp.simulation.solid import Solid
from tamp.simulation.world import World
from tamp.verification.broad_phase import (
    Advancement,
    Still,
    at_rest,
    near_itself,
    near_still,
    radius,
)
from tamp.verification.execution_state import Held, carried
from tamp.verification.trajectory_sampling import SampledMotion, Sampler

MAX_PENETRATION_M = 0.001
"""Metres of penetration that are not yet a collision."""
DEEPENING_M = 0.0003
"""Metres that bodies in each other at the start may get deeper: an arm's way is not straight."""
CLEARANCE_RANGE_M = 0.02
"""Metres up to which clearance is measured."""
SAMPLES_PER_BLOCK = 512
"""Samples that are looked at together."""


@dataclass(frozen=True)
class PairDistance:
    """Two things at a distance (m, negative when they penetrate) at a time (s)."""

    first: str
    second: str
    distance: float
    time: float


@dataclass(frozen=True)
class ExpectedContacts:
    """Contact that belongs to grasping and standing.

    Attributes:
        touching: Bodies that the hand and fingers may touch: one that they are closing on or
            letting go of.
        grasped: Bodies that the hand and fingers may be near: one that they are reaching for or
            have let go of.
        supporting: Bodies that the held one may be near: those that it stood on or will stand on.
    """

    touching: frozenset[str] = frozenset()
    grasped: frozenset[str] = frozenset()
    supporting: frozenset[str] = frozenset()


@dataclass
class CollisionFindings:
    """Findings of a sweep: deepest penetration of each pair, nearest miss, number of states.

    It ends, somewhere in the motion, when they are more than `most`. Without `clearance` nobody
    asks after the nearest miss.
    """

    worst: dict[tuple[str, str], PairDistance] = field(default_factory=dict)
    nearest: PairDistance | None = None
    states: int = 0
    most: float = math.inf
    clearance: bool = True

    def record(
        self, contact: PairDistance, unexpected: bool, tolerance: float = MAX_PENETRATION_M
    ) -> None:
        """Take note of a contact or near miss."""
        pair = (contact.first, contact.second)
        if contact.distance < -tolerance and (
            pair not in self.worst or contact.distance < self.worst[pair].distance
        ):
            self.worst[pair] = contact
        if unexpected and (self.nearest is None or contact.distance < self.nearest.distance):
            self.nearest = contact

    @property
    def full(self) -> bool:
        """Tell whether as many states as wanted were looked at."""
        return self.states > self.most

    @property
    def margin(self) -> float:
        """Return metres beyond which a pair is of no interest."""
        if not self.clearance:
            return 0.0
        return CLEARANCE_RANGE_M if self.nearest is None else max(0.0, self.nearest.distance)


class Sweeper:
    """Looks for collisions of a world's robot. A state is [x, y, yaw, then q1..qn, opening of each
    arm], m and rad.

    Attributes:
        together: How deep bodies, sorted by name, lie in each other at the start, metres; they may
            be moved apart.
    """

    def __init__(self, world: World, robot: Robot) -> None:
        self._world = world
        self._sampler = Sampler(world, robot)
        self._names = list(world.links)
        self._solids = list(world.links.values())
        self._hands = [arm.grippers for arm in robot.arms]
        self.hand = frozenset[str]().union(*self._hands)
        self.together: dict[tuple[str, str], float] = {}
        count = len(self._names)
        pairs = [(i, j) for i in range(count) for j in range(i + 1, count)]
        self._self_pairs = [
            (i, j) for i, j in pairs if _sorted(self._names[i], self._names[j]) not in robot.allowed
        ]

    def tool(self, row: Array, arm: int = 0) -> Array:
        """Compute T_world_tool (4, 4) of an arm in a state, by the engine's forward kinematics."""
        return self._sampler.tool(row, arm)

    def hand_may_meet(self, other: str, T_tool_other: Array, opening: float, arm: int = 0) -> bool:
        """Tell whether the hand may be within CLEARANCE_RANGE_M of a body.

        The body is at T_tool_other in the tool frame.
        """
        far = (
            self._sampler.hand_radius(opening, arm)
            + radius(self._world.solids[other])
            + CLEARANCE_RANGE_M
        )
        return float(np.linalg.norm(T_tool_other[:3, 3])) <= far

    def sweep(
        self,
        rows: Array,
        times: Array,
        held: Sequence[Held],
        findings: CollisionFindings,
        usual: ExpectedContacts = ExpectedContacts(),
        against: frozenset[str] | None = None,
    ) -> None:
        """Look for collisions on the polyline through some states.

        Args:
            rows: Shape (n, 4 + joints).
            times: Seconds, shape (n,).
            held: What is in the hands; it follows them.
            findings: Receives what is met.
            usual: Nearness that is no matter of clearance, and contact that is no collision.
            against: Look only at these bodies, and not at the robot itself.
        """
        taken = {one.body for one in carried(held)}
        asked = self._world.solids if against is None else against
        bodies = [body for body in self._world.solids if body in asked and body not in taken]
        still = at_rest(self._world, bodies)
        expected = self._expected(still, held, usual)

        for motion in self._sampler.motions(rows, times, held):
            if findings.full:
                return
            findings.states += len(motion.rows)
            among, within = Advancement(self._world), Advancement(self._world)
            for start in range(0, len(motion.rows), SAMPLES_PER_BLOCK):
                block = motion.part(slice(start, start + SAMPLES_PER_BLOCK))
                self._against_bodies(block, held, findings, still, expected, among)
                if against is None:
                    self._against_itself(block, held, findings, within)

    def _expected(self, still: Still, held: Sequence[Held], usual: ExpectedContacts) -> Array:
        """Mark pairs of movers and pieces at rest, shape (movers, pieces): 1 where a contact counts
        and a near miss does, 0 where only a contact does, -1 where neither.
        """
        movers = self._sampler.movers(held)
        marks = np.ones((len(movers), len(still.solids)))
        owners = [solid.owner for solid in still.solids]
        by_hand = [solid.owner in self.hand for solid in movers[: len(self._solids)]]
        by_hand += [False] * (len(movers) - len(by_hand))
        in_hand = np.arange(len(movers)) >= len(self._solids)
        for which, near, mark in (
            (by_hand, usual.grasped, 0.0), (in_hand, usual.supporting, 0.0),
            (by_hand, usual.touching, -1.0),
        ):  # fmt: skip
            marks[np.ix_(np.array(which), np.array([owner in near for owner in owners]))] = mark
        marks[0, -1] = -1.0  # the base drives on the floor
        return marks

    def _against_bodies(
        self,
        motion: SampledMotion,
        held: Sequence[Held],
        findings: CollisionFindings,
        still: Still,
        expected: Array,
        advancement: Advancement,
    ) -> None:
        movers = self._sampler.movers(held)
        within = np.where(expected > 0.0, findings.margin, np.where(expected < 0.0, -np.inf, 0.0))
        current = -1
        for state, mover, other, bound in near_still(motion, still, within):
            counts = expected[mover, other] > 0.0
            reach = findings.margin if counts else 0.0
            pair, way = (mover, other), float(motion.ways[mover, state])
            if bound >= reach or advancement.apart(pair, way, reach):
                continue

            if state != current:
                self._pose(motion, state, held)
                current = state
            first, second = movers[mover], still.solids[other]
            distance = advancement.distance(pair, (first, second), way, reach)
            if distance < CLEARANCE_RANGE_M:
                contact = PairDistance(
                    first.owner, second.owner, distance, float(motion.times[state])
                )
                tolerance = max(
                    MAX_PENETRATION_M,
                    self.together.get(_sorted(first.owner, second.owner), 0.0) + DEEPENING_M,
                )
                findings.record(contact, counts and findings.clearance, tolerance)

    def _against_itself(
        self,
        motion: SampledMotion,
        held: Sequence[Held],
        findings: CollisionFindings,
        advancement: Advancement,
    ) -> None:
        movers = self._sampler.movers(held)
        pairs = [*self._self_pairs, *self._pairs_of_held(movers, held)]

        current = -1
        for state, number in near_itself(motion, np.array(pairs)):
            i, j = pairs[number]
            way = float(motion.ways[i, state] + motion.ways[j, state])
            if advancement.apart((i, j), way, 0.0):
                continue
            if state != current:
                self._pose(motion, state, held)
                current = state
            distance = advancement.distance((i, j), (movers[i], movers[j]), way, 0.0)
            if distance < 0:
                time = float(motion.times[state])
                findings.record(
                    PairDistance(movers[i].owner, movers[j].owner, distance, time), False
                )

    def _pairs_of_held(
        self, movers: Sequence[Solid], held: Sequence[Held]
    ) -> Iterator[tuple[int, int]]:
        """Yield which movers what is held may meet: all links but those that hold it, and what
        another hand holds.
        """
        first = len(self._solids)
        arms = {one.body: one.arm for one in carried(held)}
        holders = {one.body: self._hands[one.arm] for one in held}
        for k in range(first, len(movers)):
            body = movers[k].owner
            own = holders.get(body, frozenset[str]())
            yield from ((k, i) for i in range(first) if self._names[i] not in own)
            yield from ((k, i) for i in range(first, k) if arms[movers[i].owner] != arms[body])

    def _pose(self, motion: SampledMotion, state: int, held: Sequence[Held]) -> None:
        row = motion.rows[state]
        self._world.set_state(row)
        piece = len(self._solids)
        for one in carried(held):
            self._world.place(one.body, motion.frames[piece, state])
            piece += len(self._world.solids[one.body])


def _sorted(first: str, second: str) -> tuple[str, str]:
    return (min(first, second), max(first, second))
