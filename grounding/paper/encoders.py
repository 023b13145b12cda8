"""Auto-encoders of point clouds (section III-B): three encoders, a fully connected decoder,
Chamfer's distance.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from grounding.dataset import Dataset
from grounding.paper.clouds import POINTS
from grounding.paper.features import CODE
from grounding.paper.posed_clouds import PosedClouds
from grounding.torch_layers import dense_layers, run_layers
from tamp.errors import InputError

SCALINGS = ("one", "each")
"""(a): one factor for all clouds, so that the largest fills [-0.5, 0.5]; (b): each cloud is brought
to that cube.
"""

SHAPES = ("data", "varied")
"""Whose clouds: those of a data set's bodies, or of furniture, household shapes and pybullet's
meshes of random sizes.
"""


@dataclass(frozen=True)
class EncoderOptions:
    """The encoder's training options.

    Attributes:
        iterations: Batches.
        batch: Clouds in one.
        rate: Adam's learning rate.
        validate_every: Iterations between looks at the validation clouds.
        validation: How many those are, of the data set's last tenth of the scenes.
        points: Of each cloud.
        seed: Of initial weights and batches, and of varied shapes.
        device: Where torch computes.
        shapes: One of SHAPES.
    """

    iterations: int = 4000
    batch: int = 16
    rate: float = 1e-3
    validate_every: int = 250
    validation: int = 128
    points: int = POINTS
    seed: int = 0
    device: str = "cpu"
    shapes: str = "data"


class Conv(nn.Module):
    """1D convolutions with kernel 1, 3-64-128-128-256-128, and the largest of each number over the
    points.
    """

    def __init__(self, points: int) -> None:
        super().__init__()
        self.layers = dense_layers([3, 64, 128, 128, 256, CODE])

    def forward(self, points: Tensor) -> Tensor:
        """Encode clouds (n, points, 3) as codes (n, CODE)."""
        return run_layers(self.layers, points).amax(dim=1)


class PointNet(nn.Module):
    """PointNet++ (Qi et al. 2017): two set abstractions of 32 nearest points each, and one of all.

    The centres are the first points of a cloud, since its points are drawn evenly.
    """

    CENTRES = (256, 64)
    NEAREST = 32

    def __init__(self, points: int) -> None:
        super().__init__()
        self.first = dense_layers([3, 64, 64, 128])
        self.second = dense_layers([131, 128, 128, 256])
        self.last = dense_layers([259, 256, CODE])

    def forward(self, points: Tensor) -> Tensor:
        """Encode clouds (n, points, 3) as codes (n, CODE)."""
        places, features = points, points[..., :0]
        for count, layers in zip(self.CENTRES, (self.first, self.second), strict=True):
            centres = places[:, : min(count, places.shape[1])]
            near = (
                torch.cdist(centres, places)
                .topk(min(self.NEAREST, places.shape[1]), largest=False)
                .indices
            )
            batch = torch.arange(len(points), device=points.device)[:, None, None]
            around = torch.cat(
                [places[batch, near] - centres[:, :, None], features[batch, near]], dim=-1
            )
            places, features = centres, run_layers(layers, around).amax(dim=2)
        return run_layers(self.last, torch.cat([places, features], dim=-1)).amax(dim=1)


class Dense(nn.Module):
    """Fully connected, of the points in their order: 3 times points to 512-256-128."""

    def __init__(self, points: int) -> None:
        super().__init__()
        self.layers = dense_layers([3 * points, 512, 256, CODE])

    def forward(self, points: Tensor) -> Tensor:
        """Encode clouds (n, points, 3) as codes (n, CODE)."""
        return run_layers(self.layers, points.flatten(1))


ENCODERS: dict[str, type[Conv] | type[PointNet] | type[Dense]] = {
    "conv": Conv,
    "pointnet++": PointNet,
    "dense": Dense,
}
"""By name; the models on clouds use `conv`, the paper's choice."""


def train_encoder(
    data: Dataset | None,
    kind: str = "conv",
    scaling: str = "one",
    args: EncoderOptions = EncoderOptions(),
    progress: Callable[[str], None] = lambda line: None,
) -> tuple[dict[str, NDArray[np.float32]], float]:
    """Train an encoder; return its arrays, with `scale` and `points` as the runtime reads them, and
    its validation Chamfer distance.

    Args:
        data: Scenes, whose bodies as they are turned are the clouds; None for varied shapes.
        kind: One of ENCODERS.
        scaling: One of SCALINGS.
        args: How.
        progress: Told how far it is.

    Raises:
        InputError: An unknown kind, scaling or set of shapes, or no scenes for those of a data set.
    """
    if kind not in ENCODERS:
        raise InputError(f"unknown encoder '{kind}'", found=kind, choices=ENCODERS)
    if scaling not in SCALINGS:
        raise InputError(f"unknown scaling '{scaling}'", found=scaling, choices=SCALINGS)
    clouds = _clouds(data, args)
    factor = 0.5 / clouds.radius if scaling == "one" else 0.0
    with torch.random.fork_rng():
        torch.manual_seed(args.seed)
        encoder, decoder = (
            ENCODERS[kind](args.points),
            dense_layers([CODE, 256, 512, 3 * args.points]),
        )
    encoder, decoder = encoder.to(args.device), decoder.to(args.device)
    optimizer = torch.optim.Adam([*encoder.parameters(), *decoder.parameters()], lr=args.rate)
    random = torch.Generator().manual_seed(args.seed)
    cut = max(1, int(0.9 * len(clouds)))
    apart = cut + torch.randperm(max(1, len(clouds) - cut), generator=random)[: args.validation]
    apart = apart.clamp(max=len(clouds) - 1)

    def distance(rows: Tensor) -> Tensor:
        points = scaled(clouds.take(rows), factor)
        return chamfer(points, run_layers(decoder, encoder(points)).view(points.shape))

    best, kept = np.inf, {}
    for step in range(1, args.iterations + 1):
        loss = distance(torch.randint(cut, (args.batch,), generator=random)).mean()
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        if step % args.validate_every == 0 or step == args.iterations:
            with torch.no_grad():
                score = float(
                    np.mean([float(distance(rows).mean()) for rows in apart.split(args.batch)])
                )
            if score < best:
                best, kept = score, _arrays(encoder)
            progress(
                f"{kind}, scaling {scaling}: {step} of {args.iterations}, "
                f"Chamfer distance {score:.3e}"
            )
    kept["scale"], kept["points"] = np.array(factor, np.float32), np.array(args.points, np.float32)
    return kept, best


def _clouds(data: Dataset | None, args: EncoderOptions) -> PosedClouds:
    if args.shapes not in SHAPES:
        raise InputError(f"unknown shapes '{args.shapes}'", found=args.shapes, choices=SHAPES)
    if args.shapes == "varied":
        return PosedClouds.varied(args.seed, args.device, args.points)
    if data is None:
        raise InputError("no scenes whose bodies an encoder could be trained on")
    return PosedClouds.of(data, args.device, args.points)


def scaled(points: Tensor, factor: float) -> Tensor:
    """Scale clouds (n, points, 3) as `runtime.scaled` does."""
    if factor:
        return points * factor
    extents = points.amax(dim=1) - points.amin(dim=1)
    return points / extents.amax(dim=1)[:, None, None].clamp(min=1e-9)


def chamfer(first: Tensor, second: Tensor) -> Tensor:
    """Compute the Chamfer distance of clouds (n, points, 3), the mean squared distance to the
    nearest point, both ways; shape (n,).
    """
    squares = (
        (first**2).sum(-1)[:, :, None]
        + (second**2).sum(-1)[:, None]
        - 2 * first @ second.transpose(1, 2)
    )
    squares = squares.clamp(min=0.0)
    return squares.amin(dim=2).mean(dim=1) + squares.amin(dim=1).mean(dim=1)


def _arrays(encoder: nn.Module) -> dict[str, NDArray[np.float32]]:
    found = {}
    for key, value in encoder.named_parameters():
        array = value.detach().cpu().numpy()
        found[key.removeprefix("layers.")] = array.T.copy() if array.ndim == 2 else array.copy()
    return found
