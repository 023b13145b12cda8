"""Training of the relational ranker: cross entropy on labelled scenes, the best of a validation
split.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from grounding.relational.measures import Measures
from grounding.relational.ranker import PAIR, POSE, features
from grounding.torch_layers import arrays_of, dense_layers, run_layers


@dataclass(frozen=True)
class RankerOptions:
    """The ranker's training options.

    Attributes:
        iterations: Batches.
        batch: Scenes in one.
        rate: The largest learning rate; it rises and falls once.
        decay: Of the weights.
        hidden: Width of the layers, and `pooled` of what is pooled.
        validation: The share of the scenes that chooses the checkpoint.
        seed: Of initial weights and batches.
    """

    iterations: int = 6000
    batch: int = 256
    rate: float = 3e-3
    decay: float = 1e-3
    hidden: int = 64
    pooled: int = 16
    validation: float = 0.1
    seed: int = 0


class RankerNet(nn.Module):
    """The network of `grounding.relational.ranker.Ranker`."""

    def __init__(self, hidden: int, pooled: int) -> None:
        super().__init__()
        self.pair = dense_layers([PAIR, 32, pooled])
        self.main = dense_layers([POSE + pooled, hidden, hidden, 1])

    def forward(self, pose: Tensor, pair: Tensor, missing: Tensor) -> Tensor:
        """Compute logits (n,) of poses (n, POSE), pairs (n, m, PAIR), and which of them are not
        there (n, m).
        """
        pooled = run_layers(self.pair, pair).masked_fill(missing[..., None], -torch.inf).amax(dim=1)
        return run_layers(self.main, torch.cat([pose, pooled], dim=1))[:, 0]

    def arrays(self) -> dict[str, NDArray[np.float32]]:
        """Return the weights as `layers_of` reads them."""
        return arrays_of(pair=self.pair, main=self.main)


def train_ranker(
    measured: Sequence[Measures],
    holds: NDArray[np.bool_],
    args: RankerOptions = RankerOptions(),
    progress: Callable[[int, int, float], None] = lambda step, steps, accuracy: None,
) -> tuple[dict[str, NDArray[np.float32]], float]:
    """Train the ranker; return its weights, and their accuracy on the validation split.

    Args:
        measured: Scenes, one pose each.
        holds: Their labels.
        args: How.
        progress: Called with step, steps and the validation accuracy now and then.
    """
    pose, pair, missing = _table([features(one) for one in measured])
    labels = torch.tensor(holds, dtype=torch.float32)
    order = np.random.default_rng(args.seed).permutation(len(labels))
    held = max(1, int(args.validation * len(labels))) if len(labels) >= 50 else 0
    chosen, apart = torch.tensor(order[held:]), torch.tensor(order[:held] if held else order)
    generator = torch.Generator().manual_seed(args.seed)
    with torch.random.fork_rng():
        torch.manual_seed(args.seed)
        net = RankerNet(args.hidden, args.pooled)

    optimizer = torch.optim.AdamW(net.parameters(), lr=args.rate, weight_decay=args.decay)
    steps = min(args.iterations, max(600, 2 * len(labels)))
    schedule = torch.optim.lr_scheduler.OneCycleLR(
        optimizer, args.rate, total_steps=steps, pct_start=0.1
    )
    best, kept = -1.0, net.arrays()

    for step in range(1, steps + 1):
        rows = chosen[
            torch.randint(len(chosen), (min(args.batch, len(chosen)),), generator=generator)
        ]
        loss = nn.functional.binary_cross_entropy_with_logits(
            net(pose[rows], pair[rows], missing[rows]), labels[rows]
        )
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        schedule.step()
        if step % max(1, steps // 20) == 0:
            with torch.no_grad():
                logits = net(pose[apart], pair[apart], missing[apart])
            accuracy = float(((logits > 0) == (labels[apart] > 0.5)).float().mean())
            if accuracy >= best:
                best, kept = accuracy, net.arrays()
            progress(step, steps, accuracy)

    return kept, best


def _table(rows: Sequence[tuple[NDArray[Any], NDArray[Any]]]) -> tuple[Tensor, Tensor, Tensor]:
    most = max(pair.shape[1] for _, pair in rows)
    pairs = np.zeros((len(rows), most, PAIR), dtype=np.float32)
    missing = np.ones((len(rows), most), dtype=bool)
    for row, (_, pair) in enumerate(rows):
        pairs[row, : pair.shape[1]], missing[row, : pair.shape[1]] = pair[0], False
    return (
        torch.tensor(np.concatenate([pose for pose, _ in rows])),
        torch.tensor(pairs),
        torch.tensor(missing),
    )
