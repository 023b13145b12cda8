"""Random streams of the training: one a model, stage and block of iterations."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import torch
from torch import Tensor


def random_stream(size: int, seed: int, stage: int, block: int) -> torch.Generator:
    """Seed the random numbers of a block of iterations, for a model of this size and seed."""
    mixed = np.random.SeedSequence([seed, size, stage, block]).generate_state(1)
    return torch.Generator().manual_seed(int(mixed[0]))


def stacked_draws(
    randoms: Sequence[torch.Generator], draw: Callable[..., Tensor], shape: tuple[int, ...]
) -> Tensor:
    """Stack one draw a model, shape (M, *shape)."""
    return torch.stack([draw(shape, generator=random) for random in randoms])
