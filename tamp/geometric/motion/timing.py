"""From a certified polyline to a trajectory in time that never leaves it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.motion.corner_blending import (
    TIME_STEP_S,
    BlendedPath,
    Corner,
    blend,
    corners,
)
from tamp.geometric.motion.path import without_repeats
from tamp.geometric.motion.retiming import speeds
from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float


@dataclass(frozen=True, eq=False)
class Timed:
    """A trajectory: positions (m, d) at times (m,) in seconds from 0, increasing, and straight
    lines in between.
    """

    times: Array
    positions: Array

    @property
    def duration(self) -> float:
        """Return seconds."""
        return float(self.times[-1])


def time_path(
    path: Float[Array, "n d"],
    velocity: Float[Array, " d"],
    acceleration: Float[Array, " d"],
    edge_free: Callable[[Array, Array], bool] | None = None,
) -> Timed:
    """Time a path, from rest to rest, as fast as the limits allow.

    The trajectory runs along the polyline itself and rests at its corners, except where `edge_free`
    certifies a rounding, whose chords are then part of the result, and where vertices sample a
    smooth curve closely. Every vertex that is not rounded is a sample. Velocities between samples,
    and accelerations as differences of those velocities, stay within the limits.

    Args:
        path: Shape (n, d); angles unwrapped.
        velocity: Limits, shape (d,), in the path's units per second.
        acceleration: Limits, shape (d,), per second squared.
        edge_free: Whether the straight edge between two rows is free; None: the polyline is kept
            exactly.

    Returns:
        From the path's first row to its last, both exactly; samples at most about TICK seconds
        apart on straight parts.
    """
    path = without_repeats(np.asarray(path, dtype=float))
    velocity, acceleration = (
        np.asarray(velocity, dtype=float),
        np.asarray(acceleration, dtype=float),
    )
    if len(path) == 1:
        return Timed(np.zeros(1), path)
    passed = corners(path, acceleration, edge_free)
    stops = [k for k, corner in enumerate(passed) if not corner.blend_length]
    return _joined([_piece(passed[i : j + 1], velocity, acceleration) for i, j in pairwise(stops)])


def _piece(passed: list[Corner], velocity: Array, acceleration: Array) -> Timed:
    """Time a path through corners that are passed without resting, from rest to rest."""
    if len(passed) > 2:
        rail = blend(passed)
        rates = speeds(rail, velocity, acceleration)
        # A node that is passed at almost no rate takes longer than to rest at every corner.
        if rates is not None and float(np.sum(_spans(rail, rates))) < sum(
            sum(_straight_profile(a.vertex, b.vertex, velocity, acceleration)[1:])
            for a, b in pairwise(passed)
        ):
            return _slowed(_sampled(rail, rates), velocity, acceleration)
    vertices = [corner.vertex for corner in passed]
    return _joined([_straight(a, b, velocity, acceleration) for a, b in pairwise(vertices)])


def _straight_profile(
    start: Array, end: Array, velocity: Array, acceleration: Array
) -> tuple[float, float, float]:
    """Compute the profile of one edge from rest to rest, full acceleration, full speed, full
    braking: the acceleration in edges per second squared, the seconds of a ramp, and the rest.
    """
    step = np.abs(end - start)
    with np.errstate(divide="ignore"):
        # In edges per second (squared).
        top, push = float(np.min(velocity / step)), float(np.min(acceleration / step))
    top = min(top, push**0.5)  # a short edge brakes before it reaches full speed
    return push, top / push, 1.0 / top


def _straight(start: Array, end: Array, velocity: Array, acceleration: Array) -> Timed:
    """Time one edge from rest to rest."""
    push, ramp, inverse_top = _straight_profile(start, end, velocity, acceleration)
    top, duration = 1.0 / inverse_top, inverse_top + ramp
    times = np.linspace(0.0, duration, max(2, int(np.ceil(duration / TIME_STEP_S))) + 1)
    left = duration - times
    done = np.where(times < ramp, 0.5 * push * times**2, top * (times - 0.5 * ramp))
    done = np.where(left < ramp, 1.0 - 0.5 * push * left**2, done)
    positions = start + done[:, None] * (end - start)
    positions[0], positions[-1] = start, end
    return Timed(times, positions)


def _joined(pieces: list[Timed]) -> Timed:
    """Join trajectories one after the other, each beginning where the last ended."""
    starts = np.cumsum([0.0] + [piece.duration for piece in pieces])
    times = [start + piece.times[1:] for start, piece in zip(starts[:-1], pieces, strict=True)]
    positions = [piece.positions[1:] for piece in pieces]
    return Timed(
        np.concatenate([np.zeros(1), *times]), np.concatenate([pieces[0].positions[:1], *positions])
    )


def _spans(rail: BlendedPath, rates: Array) -> Array:
    """Compute the seconds between nodes; the acceleration is constant there."""
    return 2.0 * np.diff(rail.stations) / (rates[:-1] + rates[1:])


def _sampled(rail: BlendedPath, rates: Array) -> Timed:
    """Return the nodes at their times, and more samples on the straight parts; the acceleration is
    constant between nodes.
    """
    gaps, spans = np.diff(rail.stations), _spans(rail, rates)
    counts = np.where(rail.straight, np.maximum(1, np.ceil(spans / TIME_STEP_S)), 1).astype(int)
    i = np.repeat(np.arange(len(spans)), counts)  # the interval of each sample
    ends = np.cumsum(counts)
    shares = (np.arange(len(i)) - (ends - counts)[i] + 1) / counts[i]
    starts = np.concatenate([[0.0], np.cumsum(spans)[:-1]])
    elapsed = shares * spans[i]
    travelled = (rates[i] + 0.5 * (rates[i + 1] - rates[i]) * shares) * elapsed / gaps[i]
    positions = rail.positions[i] + travelled[:, None] * (rail.positions[i + 1] - rail.positions[i])
    positions[ends - 1] = rail.positions[1:]
    return Timed(
        np.concatenate([[0.0], starts[i] + elapsed]),
        np.concatenate([rail.positions[:1], positions]),
    )


def _slowed(timed: Timed, velocity: Array, acceleration: Array) -> Timed:
    """Stretch all times by the little that differences of the samples may exceed the limits."""
    spans = np.diff(timed.times)
    rates = np.diff(timed.positions, axis=0) / spans[:, None]
    rest = np.zeros((1, rates.shape[1]))
    middles = 0.5 * (np.concatenate([[0.0], spans]) + np.concatenate([spans, [0.0]]))
    changes = np.diff(np.concatenate([rest, rates, rest]), axis=0) / middles[:, None]
    excess = max(
        1.0,
        float(np.max(np.abs(rates) / velocity)),
        float(np.max(np.abs(changes) / acceleration)) ** 0.5,
    )
    return Timed(timed.times * excess, timed.positions)
