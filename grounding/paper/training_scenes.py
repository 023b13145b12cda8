"""The scenes that the paper's networks are trained on, gathered by row; as departures each is
turned about the vertical, mirrored and scaled anew for each block of iterations.

Nothing that the labels are about changes with it: a relation holds in a scene that is turned,
mirrored or of another size if it holds in the scene itself. The box along the world's axes is
worked out again, so that features are exactly those of the turned scene.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import torch
from torch import Tensor

from grounding.paper.feature_table import FeatureTable
from grounding.paper.networks import Batch, rotations
from grounding.paper.random_streams import stacked_draws
from grounding.paper.trainer_options import TrainerOptions

MOST_SCALED = 1.5
"""Scenes are scaled by a factor of at most so much, and of at least the inverse."""


class TrainingScenes:
    """The scenes of a table, for an ensemble of models.

    Args:
        table: Their features; with `options.residual` those before argument 1 is shown unturned.
        surroundings: Whether the networks see them.
        options: Of the training.
    """

    def __init__(self, table: FeatureTable, surroundings: bool, options: TrainerOptions) -> None:
        self._surroundings, self._options = surroundings, options
        self._bodies = torch.from_numpy(table.arguments).view(-1, 2, table.features)
        self._around = torch.from_numpy(table.others)
        self._share = torch.from_numpy(table.share)
        shown = self._bodies.flatten(1)
        self._plain = _unturned(shown) if options.residual else shown
        self._arguments, self._others = self._plain, self._around
        self._first = torch.zeros(1, 1, dtype=torch.int64)

    def vary(self, randoms: Sequence[torch.Generator]) -> None:
        """Turn, mirror and scale each scene anew, by one source of randomness a model, where the
        options say so.
        """
        if not (self._options.turned or self._options.scaled):
            return
        models, count = len(randoms), len(self._bodies)
        drawn = stacked_draws(randoms, torch.rand, (count, 3)).flatten(0, 1)[:, :, None]
        yaw = drawn[:, 0] * (2 * math.pi * self._options.turned)
        side = torch.where(drawn[:, 1] < 0.5 * self._options.turned, -1.0, 1.0)
        scale = MOST_SCALED ** ((2 * drawn[:, 2] - 1) * self._options.scaled)

        shown = varied(self._bodies.repeat(models, 1, 1), yaw, side, scale).flatten(1)
        self._arguments = _unturned(shown) if self._options.residual else shown
        if self._surroundings:
            self._others = varied(self._around.repeat(models, 1, 1), yaw, side, scale)
        self._first = torch.arange(models).unsqueeze(1) * count

    def arguments(self, rows: Tensor) -> Tensor:
        """Gather the arguments' features of each model's rows, shape (M, B), as (M, B, 2 f)."""
        return self._arguments[rows + self._first]

    def batch(self, rows: Tensor) -> Batch:
        """Gather the scenes of each model's rows, shape (M, B)."""
        if not self._surroundings:
            return Batch(self.arguments(rows), _NONE, _NONE)
        return Batch(self.arguments(rows), self._others[rows + self._first], self._share[rows])

    def as_they_are(self, rows: Tensor) -> Batch:
        """Gather the scenes of these rows, shape (M, B), neither turned nor scaled."""
        if not self._surroundings:
            return Batch(self._plain[rows], _NONE, _NONE)
        return Batch(self._plain[rows], self._around[rows], self._share[rows])


def varied(bodies: Tensor, yaw: Tensor, side: Tensor, scale: Tensor) -> Tensor:
    """Compute the features BB of bodies, shape (n, k, 19), in scenes that are mirrored along x,
    turned about the vertical through argument 0 and scaled, in this order.

    Args:
        bodies: Features; all zero for none.
        yaw: Angles, shape (n, 1), radians.
        side: -1 where the scene is mirrored, else 1, shape (n, 1).
        scale: Factors, shape (n, 1).
    """
    own = bodies[..., 13:] * scale.unsqueeze(-1)
    half = (own[..., 3:] - own[..., :3]) / 2
    c, s = yaw.cos(), yaw.sin()
    sides = rotations(bodies[..., 9:13]).unflatten(-1, (3, 3)) * half.unsqueeze(-2)
    x, y, z = sides.unbind(-2)  # each (n, k, 3); mirroring is as turning by less
    along, across = c.unsqueeze(-1), (s * side).unsqueeze(-1)
    reach = torch.stack(
        [
            (along * x - across * y).abs().sum(-1),
            (across * x + along * y).abs().sum(-1),
            z.abs().sum(-1),
        ],
        dim=-1,
    )

    at_x, at_y, at_z = (bodies[..., :3] * scale.unsqueeze(-1)).unbind(-1)
    at_x = at_x * side
    centre = torch.stack([c * at_x - s * at_y, s * at_x + c * at_y, at_z], dim=-1)

    q_x, q_y, q_z, q_w = bodies[..., 9:13].unbind(-1)
    q_y, q_z = q_y * side, q_z * side
    ch, sh = (yaw / 2).cos(), (yaw / 2).sin()
    turn = torch.stack(
        [ch * q_x - sh * q_y, ch * q_y + sh * q_x, ch * q_z + sh * q_w, ch * q_w - sh * q_z], dim=-1
    )
    turn = torch.where(turn[..., 3:] < 0, -turn, turn)

    mirrored = (side < 0).unsqueeze(-1)
    low_x = torch.where(mirrored, -own[..., 3:4], own[..., :1])
    high_x = torch.where(mirrored, -own[..., :1], own[..., 3:4])
    own = torch.cat([low_x, own[..., 1:3], high_x, own[..., 4:]], dim=-1)
    return torch.cat([centre, centre - reach, centre + reach, turn, own], dim=-1)


def _unturned(arguments: Tensor) -> Tensor:
    """Show argument 1 as its box along the world's axes, turned by nothing, shape (n, 2 f)."""
    size = arguments.shape[1] // 2
    centre, low, high = arguments[:, size : size + 9].split(3, dim=1)
    turn = torch.tensor([[0.0, 0.0, 0.0, 1.0]]).expand(len(arguments), 4)
    return torch.cat(
        [arguments[:, :size], centre, low, high, turn, low - centre, high - centre], dim=1
    )


_NONE = torch.zeros(0)
