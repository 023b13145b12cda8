"""Spheres that contain a hull: each point of it, with few of them, hardly larger than it."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from tamp.commands.robot_folder import spheres
from tamp.commands.robot_folder.spheres import cover
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Hull


def box(*size: float) -> Hull:
    corners = np.array(list(itertools.product(*((-side / 2, side / 2) for side in size))))
    return Hull(corners, ConvexHull(corners).simplices)


def gaps(found: Array, points: Array) -> Array:
    """How far each point is outside of the nearest sphere, metres; negative inside."""
    away = np.linalg.norm(points[:, None] - found[None, :, :3], axis=2) - found[:, 3]
    return away.min(axis=1)


@pytest.mark.parametrize("size", [(0.1, 0.1, 0.1), (0.4, 0.06, 0.06), (0.2, 0.15, 0.01)])
def test_a_cover_contains_the_hull_and_stands_out_of_it_little(
    size: tuple[float, float, float], rng: np.random.Generator
) -> None:
    made = cover(box(*size))
    assert made is not None
    found, out = made
    assert 1 <= len(found) <= spheres.LEAVES
    points = rng.uniform(-0.5, 0.5, (2000, 3)) * size
    assert gaps(found, np.concatenate([points, box(*size).vertices])).max() <= 0.0
    # Of a point on a sphere, how far it is outside of the box.
    around = rng.normal(size=(500, 3))
    around /= np.linalg.norm(around, axis=1, keepdims=True)
    shell = (found[:, None, :3] + found[:, None, 3:] * around).reshape(-1, 3)
    beyond = np.linalg.norm(np.maximum(np.abs(shell) - np.array(size) / 2, 0.0), axis=1)
    assert beyond.max() <= out + 1e-9
    assert out < max(size) / 2


def test_one_sphere_around_a_cube_is_the_one_through_its_corners() -> None:
    made = cover(box(0.1, 0.1, 0.1), most=1)
    assert made is not None
    found, out = made
    assert len(found) == 1
    # Half the diagonal is 86.6 mm; beyond it come the proof's grid, 3 mm * sqrt(3) / 2 on either
    # side of the hull, and the last halving of the slack.
    assert 0.0866 <= found[0, 3] < 0.0866 + 2 * 0.0026 + 0.001
    assert out == pytest.approx(found[0, 3] - 0.05, abs=0.006)
    assert np.abs(found[0, :3]).max() < 0.006


def test_where_so_few_do_not_suffice_there_is_no_cover() -> None:
    assert cover(box(1.0, 1.0, 0.01), most=1) is None


def test_a_coarser_proof_makes_larger_spheres(monkeypatch: pytest.MonkeyPatch) -> None:
    fine = cover(box(0.2, 0.2, 0.2))
    monkeypatch.setattr(spheres, "MOST_NODES", 1000)
    coarse = cover(box(0.2, 0.2, 0.2))
    assert fine is not None and coarse is not None and coarse[1] > fine[1]
