"""What codes of clouds tell of a support's height: a linear probe's error on pieces that it was not fitted to.

    python -m benchmarks.cloud_codes --clouds 150
    python -m benchmarks.cloud_codes --encoders weights/on_encoder.safetensors

Without --encoders it is the one that ships.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import tyro
from numpy.typing import NDArray

from benchmarks.common import table
from grounding.body_geometry import BodyGeometry
from grounding.paper.clouds import cloud
from grounding.paper.runtime import NumpyEncoder
from grounding.paper.scenes import SUPPORT_SCALE, paper_supports
from grounding.paper.varied_shapes import varied_supports
from grounding.registry import SHIPPED
from grounding.supports import FurnitureSupport
from grounding.train import encoder_of
from tamp.errors import InputError

RIDGE = 1e-4
"""The probe's penalty, of inputs of unit mean variance."""

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Options:
    """What to probe.

    Attributes:
        encoders: Encoders of their own, or weights with one inside.
        clouds: Of each set of pieces.
        seed: Of scales and turns.
    """

    encoders: tuple[Path, ...] = (SHIPPED / "on_mlp-pc.safetensors",)
    clouds: int = 200
    seed: int = 0


def main(options: Options) -> None:
    """Fit on three supports, then on varied ones; print the errors on the two of the test and on others."""
    test = paper_supports("on", "test")
    shown = {"three": paper_supports("on", "train"), "varied": varied_supports()}
    asked: dict[str, Mapping[str, FurnitureSupport]] = {name: {name: piece} for name, piece in test.items()}
    asked["others"] = varied_supports(seed=1)
    rng = np.random.default_rng(options.seed)
    posed = {name: _posed(pieces, options.clouds, rng, "train") for name, pieces in shown.items()}
    posed |= {name: _posed(pieces, options.clouds, rng, "test") for name, pieces in asked.items()}
    rows: list[dict[str, object]] = []
    for path in options.encoders:
        encode = NumpyEncoder(encoder_of(path).arrays)
        for about in ("centroid", "middle"):
            codes = {
                name: np.stack([encode(one - _centre(one, about)) for one in clouds]).astype(float)
                for name, clouds in posed.items()
            }
            for fitted in shown:
                row: dict[str, object] = {"encoder": path.stem, "codes about": about, "fitted to": fitted}
                probe = _Probe(codes[fitted], _half_heights(posed[fitted]))
                for name in asked:
                    error = 100 * np.abs(probe(codes[name]) - _half_heights(posed[name]))
                    row[name] = f"{np.median(error):.1f} / {np.quantile(error, 0.9):.1f}"
                rows.append(row)
    table(rows, "half height, cm: median / 90 %")


class _Probe:
    """Least squares with a penalty, from codes (n, 128) to one number."""

    def __init__(self, codes: Array, values: Array) -> None:
        self._mean, self._scale = codes.mean(axis=0), codes.std(axis=0).mean()
        x = (codes - self._mean) / self._scale
        self._offset = values.mean()
        left = x.T @ x + RIDGE * len(x) * np.eye(x.shape[1])
        self._weights = np.linalg.solve(left, x.T @ (values - self._offset))

    def __call__(self, codes: Array) -> Array:
        return (codes - self._mean) / self._scale @ self._weights + self._offset


def _posed(pieces: Mapping[str, FurnitureSupport], count: int, rng: np.random.Generator, split: str) -> list[Array]:
    """Scale pieces as a split does and turn them by any yaw; `count` clouds (points, 3), metres."""
    forms = [BodyGeometry(piece.parts) for piece in pieces.values()]
    found = []
    for number in range(count):
        yaw, scale = rng.uniform(-np.pi, np.pi), rng.uniform(*SUPPORT_SCALE[split])
        c, s = np.cos(yaw), np.sin(yaw)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        found.append(scale * cloud(forms[number % len(forms)]) @ turn.T)
    return found


def _centre(points: Array, about: str) -> Array:
    if about == "centroid":
        return points.mean(axis=0)
    return (points.min(axis=0) + points.max(axis=0)) / 2


def _half_heights(clouds: Sequence[Array]) -> Array:
    return np.array([np.ptp(points[:, 2]) / 2 for points in clouds])


if __name__ == "__main__":
    try:
        main(tyro.cli(Options, description=(__doc__ or "").splitlines()[0]))
    except InputError as error:
        sys.exit(f"error: {error}")
