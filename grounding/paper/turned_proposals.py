"""Proposals of a generator that is shown its scene turned about the vertical, each time otherwise,
and whose poses are turned back: as many spots as there are turns.

A departure from the paper's models. Noise alone moves the proposals of a network that sees the
surroundings by centimetres (docs/paper-models.md), so that who chooses among them has no choice.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.random import Generator as Random

from grounding.paper.features import FeatureObservation, box_features, unturned
from grounding.paper.kernels import normalize
from grounding.paper.numpy_networks import NOISE, Floats, Network
from grounding.paper.rotations import quaternions, rotations
from tamp.geometric.scene.pose import Array


def turned_proposals(
    network: Network, seen: FeatureObservation, residual: bool, noise: Floats, rng: Random
) -> Array:
    """Propose a pose T_world_body for each noise, shape (n, 4) to (n, 4, 4), each time with the
    scene turned by another angle.

    Args:
        network: The generator, of boxes.
        seen: The scene as it is.
        residual: Whether it turns argument 1 from where it was.
        noise: What it is given.
        rng: Where the angles come from.
    """
    count = len(noise)
    turns = _about_vertical(rng.uniform(-math.pi, math.pi, count))
    bodies = np.concatenate([seen.arguments, seen.others])
    shown = turned_features(bodies, turns)
    if residual:
        shown[:, 1] = unturned(shown[:, 1, :3], turns @ seen.start, seen.extents)

    inputs = np.empty((count, network.main[0][0].shape[0]), np.float32)
    arguments = shown[:, :2].reshape(count, -1).astype(np.float32)
    width = arguments.shape[1]
    inputs[:, :width] = arguments
    if network.scene:
        inputs[:, width:-NOISE] = network.context(arguments, shown[:, 2:].astype(np.float32))
    inputs[:, -NOISE:] = noise
    generated = network(inputs).astype(np.float64)

    units = np.empty((count, 4))
    normalize(generated[:, 3:], units)
    back = turns.transpose(0, 2, 1)
    poses = np.zeros((count, 4, 4))
    poses[:, 3, 3] = 1.0
    start = turns @ seen.start if residual else np.eye(3)
    poses[:, :3, :3] = back @ rotations(units) @ start
    positions = (back @ generated[:, :3, None])[:, :, 0]
    poses[:, :3, 3] = seen.origin + positions - poses[:, :3, :3] @ seen.centre
    return poses


def turned_features(bodies: Array, turns: Array) -> Array:
    """Compute the features BB of bodies (k, 19) in scenes turned about argument 0's position by
    rotations (n, 3, 3), shape (n, k, 19).
    """
    count, size = len(turns), len(bodies)
    centres = np.einsum("nij,kj->nki", turns, bodies[:, :3]).reshape(-1, 3)
    turned = turns[:, None] @ rotations(bodies[:, 9:13])
    own = np.broadcast_to(bodies[:, 13:].reshape(1, size, 2, 3), (count, size, 2, 3))
    quaternion = quaternions(turned.reshape(-1, 3, 3))
    return box_features(centres, quaternion, own.reshape(-1, 2, 3)).reshape(count, size, -1)


def _about_vertical(yaws: Array) -> Array:
    """Return the rotations about the vertical by angles (n,), shape (n, 3, 3)."""
    c, s = np.cos(yaws), np.sin(yaws)
    turns = np.zeros((len(yaws), 3, 3))
    turns[:, 0, 0], turns[:, 0, 1], turns[:, 1, 0], turns[:, 1, 1] = c, -s, s, c
    turns[:, 2, 2] = 1.0
    return turns
