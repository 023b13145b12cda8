"""Collision detection along motions: the robot and the body in its hand against the scene."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array
from tamp.simulation.solid import Solid
from tamp.simulation.world import World
from tamp.verification.execution_state import Held
from tamp.verification.trajectory_sampling import Sampler

Mask = NDArray[np.bool_]

MAX_PENETRATION_M = 0.001
"""Metres of penetration that are not yet a collision."""
DEEPENING_M = 0.0003
"""Metres that bodies in each other at the start may get deeper: an arm's way is not straight."""
CLEARANCE_RANGE_M = 0.02
"""Metres up to which clearance is measured."""
SAMPLES_PER_BLOCK = 512
"""Samples that are looked at together."""


@dataclass(frozen=True)
class Contact:
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
        resting: Bodies that the held one may be near: those that it stood on or will stand on.
    """

    touching: frozenset[str] = frozenset()
    grasped: frozenset[str] = frozenset()
    resting: frozenset[str] = frozenset()


@dataclass(frozen=True, eq=False)
class _Block:
    """Samples: rows (n, 4 + joints), times (n,), frames of links (n, links, 4, 4), their boxes."""

    rows: Array
    times: Array
    frames: Array
    low: Array
    high: Array


@dataclass
class CollisionFindings:
    """Findings of a sweep: each pair's deepest penetration, the nearest miss, the number of states.

    It ends, somewhere in the motion, when they are more than `most`.
    """

    worst: dict[tuple[str, str], Contact] = field(default_factory=dict)
    nearest: Contact | None = None
    states: int = 0
    most: float = math.inf

    def record(
        self, contact: Contact, unexpected: bool, tolerance: float = MAX_PENETRATION_M
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
        return CLEARANCE_RANGE_M if self.nearest is None else max(0.0, self.nearest.distance)


class Sweeper:
    """Looks for collisions of a world's robot. A state is [x, y, yaw, q1..qn, opening], m and rad.

    Attributes:
        together: How deep bodies, sorted by name, lie in each other at the start, metres; they may
            be moved apart.
    """

    def __init__(self, world: World, robot: Robot) -> None:
        self._world = world
        self._sampler = Sampler(world, robot)
        self._names = list(world.links)
        self._solids = list(world.links.values())
        self.hand = robot.grippers
        self.together: dict[tuple[str, str], float] = {}
        count = len(self._names)
        pairs = [(i, j) for i in range(count) for j in range(i + 1, count)]
        self._self_pairs = [
            (i, j) for i, j in pairs if _sorted(self._names[i], self._names[j]) not in robot.allowed
        ]

    def tool(self, row: Array) -> Array:
        """Compute T_world_tool in a state, by pybullet's forward kinematics, shape (4, 4)."""
        return self._sampler.tool(row)

    def sweep(
        self,
        rows: Array,
        times: Array,
        held: Held | None,
        findings: CollisionFindings,
        usual: ExpectedContacts = ExpectedContacts(),
        against: frozenset[str] | None = None,
    ) -> None:
        """Look for collisions on the polyline through some states.

        Args:
            rows: Shape (n, 4 + joints).
            times: Seconds, shape (n,).
            held: What is in the hand; it follows it.
            findings: Receives what is met.
            usual: Nearness that is no matter of clearance, and contact that is no collision.
            against: Look only at these bodies, and not at the robot itself.
        """
        for some, then in self._sampler.pieces(rows, times):
            if findings.full:
                return
            self._sweep(some, then, held, findings, usual, against)

    def _sweep(
        self, rows: Array, times: Array, held: Held | None, findings: CollisionFindings,
        usual: ExpectedContacts, against: frozenset[str] | None,
    ) -> None:  # fmt: skip
        rows, times, frames = self._sampler.sampled(rows, times, held)
        findings.states += len(rows)
        moving = np.ones(len(rows), dtype=bool)
        moving[1:] = (rows[1:, 3:] != rows[:-1, 3:]).any(
            axis=1
        )  # while only the base moves, the robot keeps its shape
        for start in range(0, len(rows), SAMPLES_PER_BLOCK):
            some = slice(start, start + SAMPLES_PER_BLOCK)
            block = _Block(
                rows[some], times[some], frames[some], *self._boxes(self._solids, frames[some])
            )
            self._against_bodies(block, held, findings, usual, against)
            if against is None:
                self._against_itself(block, held, findings, moving[some])

    def _against_bodies(
        self,
        block: _Block,
        held: Held | None,
        findings: CollisionFindings,
        usual: ExpectedContacts,
        against: frozenset[str] | None,
    ) -> None:
        world = self._world
        carried = {one.body for one in held.all} if held else set[str]()
        asked = world.solids if against is None else against
        bodies = [body for body in world.solids if body in asked and body not in carried]
        others = [solid for body in bodies for solid in world.solids[body]]

        low, high = block.low, block.high
        movers = list(self._solids)
        if held is not None:
            held_low, held_high = self._held_boxes(block.frames, held)
            low, high = (
                np.concatenate([low, held_low], axis=1),
                np.concatenate([high, held_high], axis=1),
            )
            movers += self._held_solids(held)

        at = [world.pose(solid.owner) for solid in others]
        centres = np.array(
            [T[:3, :3] @ solid.centre + T[:3, 3] for T, solid in zip(at, others, strict=True)]
        )
        halves = np.array(
            [np.abs(T[:3, :3]) @ solid.half for T, solid in zip(at, others, strict=True)]
        )
        others.append(world.floor)
        centres = np.concatenate([centres.reshape(-1, 3), world.floor.centre[None]])
        halves = np.concatenate([halves.reshape(-1, 3), world.floor.half[None]])

        # The gap of boxes on the worst axis bounds the distance of contents: (n, movers, others).
        gaps = np.full((len(block.rows), len(movers), len(others)), -np.inf)
        for axis in range(3):
            near = low[:, :, None, axis] - (centres + halves)[None, None, :, axis]
            far = (centres - halves)[None, None, :, axis] - high[:, :, None, axis]
            np.maximum(gaps, np.maximum(near, far), out=gaps)
        gaps[:, 0, -1] = np.inf  # the base drives on the floor
        candidates = np.argwhere(gaps < CLEARANCE_RANGE_M)
        bounds = gaps[tuple(candidates.T)]

        current = -1
        for (state, mover, other), bound in zip(candidates.tolist(), bounds.tolist(), strict=True):
            first, second = movers[mover], others[other]
            by_hand = first.owner in self.hand
            if bound >= findings.margin or (by_hand and second.owner in usual.touching):
                continue

            if state != current:
                self._pose(block.rows[state], block.frames[state], held)
                current = state
            distance = world.distance(first, second, findings.margin)

            if distance < CLEARANCE_RANGE_M:
                allowed = usual.grasped if by_hand else frozenset[str]()
                expected = second.owner in (usual.resting if first.owner in carried else allowed)
                contact = Contact(first.owner, second.owner, distance, float(block.times[state]))
                together = self.together.get(_sorted(first.owner, second.owner), 0.0)
                tolerance = max(MAX_PENETRATION_M, together + DEEPENING_M)
                findings.record(contact, not expected, tolerance)

    def _against_itself(
        self, block: _Block, held: Held | None, findings: CollisionFindings, moving: Mask
    ) -> None:
        low, high = block.low, block.high
        pairs = [
            (self._solids[i], self._solids[j], low[:, i], high[:, i], low[:, j], high[:, j])
            for i, j in self._self_pairs
        ]

        if held is not None:
            held_low, held_high = self._held_boxes(block.frames, held)
            arm = [i for i, name in enumerate(self._names) if name not in self.hand]
            pairs += [
                (solid, self._solids[i], held_low[:, k], held_high[:, k], low[:, i], high[:, i])
                for k, solid in enumerate(self._held_solids(held))
                for i in (arm if solid.owner == held.body else range(len(self._names)))
            ]

        near = np.array(
            [np.all((la <= hb) & (lb <= ha), axis=1) & moving for _, _, la, ha, lb, hb in pairs]
        )

        current = -1
        for state, pair in np.argwhere(near.T).tolist():
            if state != current:
                self._pose(block.rows[state], block.frames[state], held)
                current = state
            first, second = pairs[pair][:2]
            distance = self._world.distance(first, second, 0.0)
            if distance < 0:
                findings.record(
                    Contact(first.owner, second.owner, distance, float(block.times[state])), False
                )

    def _boxes(self, solids: list[Solid], frames: Array) -> tuple[Array, Array]:
        """Compute axis-aligned boxes of solids at these frames: corners, each (n, solids, 3)."""
        centres = np.array([solid.centre for solid in solids])
        halves = np.array([solid.half for solid in solids])
        middles = np.einsum("nlij,lj->nli", frames[..., :3, :3], centres) + frames[..., :3, 3]
        extents = np.einsum("nlij,lj->nli", np.abs(frames[..., :3, :3]), halves)
        return middles - extents, middles + extents

    def _held_solids(self, held: Held) -> list[Solid]:
        return [solid for one in held.all for solid in self._world.solids[one.body]]

    def _held_boxes(self, frames: Array, held: Held) -> tuple[Array, Array]:
        at = [
            self._sampler.held_frames(frames, one)
            for one in held.all
            for _ in self._world.solids[one.body]
        ]
        return self._boxes(self._held_solids(held), np.stack(at, axis=1))

    def _pose(self, row: Array, frames: Array, held: Held | None) -> None:
        self._world.set_robot(row[:3], row[3:-1], row[-1])
        for one in held.all if held else ():
            self._world.place(one.body, self._sampler.held_frames(frames[None], one)[0])


def _sorted(first: str, second: str) -> tuple[str, str]:
    return (min(first, second), max(first, second))
