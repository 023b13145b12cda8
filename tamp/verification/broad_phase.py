"""Broad phase over a motion: pairs that boxes keep apart, or that cannot have met since, are left.

Nothing is decided here that the engine might decide otherwise: a pair is left out of a state only
where its distance is certain to be no less than asked for.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tamp.geometric.scene.pose import Array
from tamp.simulation.solid import Solid
from tamp.simulation.world import World
from tamp.verification.trajectory_sampling import SampledMotion

ROUNDED = 0.0025
"""Metres by which an engine's distances may be wrong: pybullet's are at edges, by up to 1.5 mm."""
AHEAD = 0.05
"""Metres beyond those of interest up to which a distance is measured, to say how long it lasts."""

Pairs = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Still:
    """Pieces at rest and the axis-aligned boxes around them: corners, each (pieces, 3), metres."""

    solids: list[Solid]
    low: Array
    high: Array


def at_rest(world: World, bodies: Sequence[str]) -> Still:
    """Box the pieces of bodies where they are, and the floor, which is the last."""
    solids = [solid for body in bodies for solid in world.solids[body]]
    middles, halves = [world.floor.centre], [world.floor.half]
    if solids:
        frames = np.stack([world.pose(solid.owner) for solid in solids])
        centres = np.stack([solid.centre for solid in solids])[:, :, None]
        extents = np.stack([solid.half for solid in solids])[:, :, None]
        turns = frames[:, :3, :3]
        middles = [*((turns @ centres)[..., 0] + frames[:, :3, 3]), *middles]
        halves = [*(np.abs(turns) @ extents)[..., 0], *halves]
    centre, half = np.array(middles), np.array(halves)
    return Still([*solids, world.floor], centre - half, centre + half)


def radius(solids: Sequence[Solid]) -> float:
    """Bound the distance of a body's origin from any point of its pieces, metres."""
    corners = [float(np.linalg.norm(np.abs(one.centre) + one.half)) for one in solids]
    return max(corners, default=0.0)


def near_still(
    motion: SampledMotion, still: Still, within: Array
) -> Iterator[tuple[int, int, int, float]]:
    """Yield states, movers and pieces at rest whose boxes come nearer than asked for.

    Args:
        motion: Its boxes, of m movers in n states.
        still: The boxes of p pieces.
        within: Metres of interest for each mover and piece, shape (m, p).

    Yields:
        State, mover and piece, in this order, and the metres between the boxes on the worst axis,
        below which no distance of the two can be.
    """
    low, high = motion.swept
    pairs = np.argwhere(_gaps(low[:, None], high[:, None], still) < within)
    if not len(pairs):
        return
    movers, pieces = pairs.T
    chosen = Still([], still.low[pieces][:, None], still.high[pieces][:, None])
    gaps = _gaps(motion.low[movers], motion.high[movers], chosen).T
    states, columns = np.nonzero(gaps < within[movers, pieces])
    bounds = gaps[states, columns].tolist()
    found = pairs[columns].tolist()
    for state, (mover, piece), bound in zip(states.tolist(), found, bounds, strict=True):
        yield state, mover, piece, bound


def near_itself(motion: SampledMotion, pairs: Pairs) -> Iterator[tuple[int, int]]:
    """Yield states and pairs (k, 2) of movers whose boxes meet, where the robot's shape changes."""
    low, high = motion.swept
    first, second = pairs.T
    numbers = np.flatnonzero(_meet(low[first], high[first], low[second], high[second]))
    first, second = first[numbers], second[numbers]
    low, high = motion.low, motion.high
    meet = _meet(low[first], high[first], low[second], high[second])
    states, columns = np.nonzero((meet & motion.shaped).T)
    yield from zip(states.tolist(), numbers[columns].tolist(), strict=True)


def _gaps(low: Array, high: Array, still: Still) -> Array:
    """Compute gaps of boxes on the worst axis: it bounds the distance of contents."""
    x, y, z = (
        np.maximum(low[..., axis] - still.high[..., axis], still.low[..., axis] - high[..., axis])
        for axis in range(3)
    )
    return np.maximum(np.maximum(x, y), z)


def _meet(low: Array, high: Array, other_low: Array, other_high: Array) -> NDArray[np.bool_]:
    """Tell which boxes meet."""
    x, y, z = (
        (low[..., axis] <= other_high[..., axis]) & (other_low[..., axis] <= high[..., axis])
        for axis in range(3)
    )
    return x & y & z


class Advancement:
    """Conservative advancement: a distance that was measured lasts until a pair has moved as far.

    (Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems, 1996, 2.3.)
    """

    def __init__(self, world: World) -> None:
        self._world = world
        self._lasts: dict[tuple[int, int], float] = {}
        self._close: set[tuple[int, int]] = set()

    def apart(self, pair: tuple[int, int], way: float, within: float) -> bool:
        """Tell whether a pair that has moved `way` metres so far is certain to be apart."""
        return self._lasts.get(pair, -np.inf) - way >= within

    def distance(
        self, pair: tuple[int, int], solids: tuple[Solid, Solid], way: float, reach: float
    ) -> float:
        """Ask the engine for a pair's distance, metres, infinite where it is past `reach`."""
        if pair not in self._close:
            found = self._world.distance(*solids, reach + AHEAD)
            self._lasts[pair] = min(found, reach + AHEAD) - ROUNDED + way
            if found >= reach + ROUNDED:
                return np.inf
            self._close.add(pair)
        found = self._world.distance(*solids, reach)
        if found >= reach:
            self._close.discard(pair)
        return found
