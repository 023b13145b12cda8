"""Training of the rectified flow on the positive scenes' coordinates, and which face is down."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from grounding.relational.coordinates import RelationalCoordinates
from grounding.relational.flow import (
    AROUND,
    CONDITION,
    COORDINATES,
    PAIR,
    POOLED,
    condition,
    pair_features,
    surroundings,
)
from grounding.relational.measures import Measures
from grounding.torch_layers import arrays_of, dense_layers, run_layers

NARROW = 0.02
"""The least size of a coordinate: some are constant."""


@dataclass(frozen=True)
class FlowOptions:
    """The flow's training options.

    Attributes:
        iterations: Batches.
        batch: Scenes in one.
        rate: The largest learning rate; it rises and falls once.
        decay: Of the weights.
        hidden: Width of the velocity's layers.
        average: Share of the running average of the weights that a step keeps; the average is what
            is used.
        seed: Of initial weights, batches and noise.
    """

    iterations: int = 8000
    batch: int = 256
    rate: float = 2e-3
    decay: float = 1e-4
    hidden: int = 128
    average: float = 0.999
    seed: int = 0


class FlowNet(nn.Module):
    """The networks of `grounding.relational.flow.Flow`."""

    def __init__(self, hidden: int) -> None:
        super().__init__()
        self.face = dense_layers([CONDITION, 32, 1])
        self.pair = dense_layers([PAIR, 32, POOLED])
        self.velocity = dense_layers(
            [COORDINATES + 1 + CONDITION + POOLED, hidden, hidden, COORDINATES]
        )

    def forward(self, x: Tensor, time: Tensor, scenes: SceneBatch) -> Tensor:
        """Compute velocities (n, 7) of samples (n, 7) at times (n, 1)."""
        places = x[:, :2] * scenes.half
        pairs = torch.cat(pair_features(places, scenes.conditions, scenes.around), dim=2)
        pooled = (
            run_layers(self.pair, pairs)
            .masked_fill(scenes.missing[..., None], -torch.inf)
            .amax(dim=1)
        )
        pooled = torch.where(scenes.missing.all(dim=1, keepdim=True), 0.0, pooled)
        return run_layers(self.velocity, torch.cat([x, time, scenes.conditions, pooled], dim=1))

    def arrays(self) -> dict[str, NDArray[np.float32]]:
        """Return the weights as `Flow` reads them."""
        return arrays_of(face=self.face, pair=self.pair, velocity=self.velocity)


@dataclass(frozen=True, eq=False)
class SceneBatch:
    """A batch of n positive scenes: what is known, what is around (n, m, AROUND), what of it is
    missing, half sizes scaled.
    """

    conditions: Tensor
    around: Tensor
    missing: Tensor
    half: Tensor

    def take(self, rows: Tensor) -> SceneBatch:
        """Select some of the scenes."""
        return SceneBatch(
            self.conditions[rows], self.around[rows], self.missing[rows], self.half[rows]
        )


def train_flow(
    chart: RelationalCoordinates,
    positive: Sequence[Measures],
    args: FlowOptions = FlowOptions(),
    progress: Callable[[int, int, float], None] = lambda step, steps, loss: None,
) -> dict[str, NDArray[np.float32]]:
    """Train a flow by flow matching; return the arrays of a `Flow`.

    Args:
        chart: The coordinates.
        positive: Scenes in which the relation holds, one pose each.
        args: How.
        progress: Called with step, steps and the mean loss now and then.
    """
    coordinates = np.stack([chart.encode(one).coordinates for one in positive])
    scale = np.maximum(np.sqrt((coordinates**2).mean(axis=0)), NARROW).astype(np.float32)
    data = torch.tensor(coordinates / scale, dtype=torch.float32)
    conditions = [condition(one.view) for one in positive]
    face = torch.tensor([int(one.face[0]) for one in positive])
    scenes = _scenes(positive, conditions, face, scale)
    options, absent = _padded(conditions, CONDITION)
    random = torch.Generator().manual_seed(args.seed)
    with torch.random.fork_rng():
        torch.manual_seed(args.seed)
        net = FlowNet(args.hidden)

    average = {name: value.detach().clone() for name, value in net.named_parameters()}
    steps = min(args.iterations, max(1000, 4 * len(positive)))
    optimizer = torch.optim.AdamW(net.parameters(), lr=args.rate, weight_decay=args.decay)
    schedule = torch.optim.lr_scheduler.OneCycleLR(
        optimizer, args.rate, total_steps=steps, pct_start=0.1
    )
    total = 0.0

    for step in range(1, steps + 1):
        rows = torch.randint(len(data), (min(args.batch, len(data)),), generator=random)
        noise = torch.randn((len(rows), COORDINATES), generator=random)
        time = torch.rand((len(rows), 1), generator=random)
        mixed = (1 - time) * noise + time * data[rows]
        error = net(mixed, time, scenes.take(rows)) - (data[rows] - noise)
        logits = run_layers(net.face, options[rows])[..., 0].masked_fill(absent[rows], -torch.inf)
        loss = (error**2).mean() + nn.functional.cross_entropy(logits, face[rows])
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        schedule.step()
        keep = min(args.average, step / (step + 10))
        with torch.no_grad():
            for name, value in net.named_parameters():
                average[name].lerp_(value, 1 - keep)

        total += float(loss.detach())
        if step % max(1, steps // 20) == 0:
            progress(step, steps, total / max(1, steps // 20))
            total = 0.0

    net.load_state_dict(average)
    return {**net.arrays(), "scale": scale}


def _scenes(
    positive: Sequence[Measures],
    conditions: Sequence[NDArray[np.float32]],
    face: Tensor,
    scale: NDArray[np.float32],
) -> SceneBatch:
    chosen = np.stack([rows[row] for rows, row in zip(conditions, face.tolist(), strict=True)])
    around, missing = _padded([surroundings(one.view) for one in positive], AROUND)
    half = np.stack([one.view.region.size[:2] / 2 for one in positive]) * scale[:2]
    return SceneBatch(
        torch.tensor(chosen), around, missing, torch.tensor(half, dtype=torch.float32)
    )


def _padded(rows: Sequence[NDArray[Any]], width: int) -> tuple[Tensor, Tensor]:
    """Pad to shape (n, m, width), zero where there are fewer than m, and where that is, (n, m)."""
    most = max(1, max(len(row) for row in rows))
    padded, missing = (
        np.zeros((len(rows), most, width), np.float32),
        np.ones((len(rows), most), bool),
    )
    for index, row in enumerate(rows):
        padded[index, : len(row)], missing[index, : len(row)] = row, False
    return torch.tensor(padded), torch.tensor(missing)
