"""Lines against planes of convex parts: crossings by sampling along the line, the stretch of solid at an origin."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tamp.geometric.stability import ray_kernels
from tests.geometric.plain_kernels import plain

K = plain(ray_kernels)
X = np.array([1.0, 0.0, 0.0])


def slabs(*spans: tuple[float, float]) -> tuple[Any, Any, Any]:
    """Boxes from one x to another, 2 m wide and high: normals, offsets, where each begins."""
    normals = np.tile(np.vstack([np.eye(3), -np.eye(3)]), (len(spans), 1))
    offsets = np.array([value for low, high in spans for value in (high, 1.0, 1.0, -low, 1.0, 1.0)])
    return normals, offsets, np.arange(len(spans) + 1) * 6


def random_part(rng: np.random.Generator) -> tuple[Any, Any]:
    """A convex part about a point, by random planes at 0.3 to 1 m from there; closed by a box."""
    normals = rng.normal(size=(8, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.vstack([normals, np.eye(3), -np.eye(3)])
    middle = rng.uniform(-0.3, 0.3, 3)
    return normals, normals @ middle + np.append(rng.uniform(0.3, 1.0, 8), np.full(6, 1.0))


def test_crossings_are_where_samples_along_the_line_say() -> None:
    for seed in range(40):
        rng = np.random.default_rng(seed)
        normals, offsets = random_part(rng)
        origin, direction = rng.uniform(-1.5, 1.5, 3), rng.normal(size=3)
        direction /= np.linalg.norm(direction)
        enter, leave, start, end = K._cross(origin, direction, normals, offsets, 0, len(normals))
        along = np.linspace(-4.0, 4.0, 4001)
        points = origin + along[:, None] * direction
        inside = along[np.all(points @ normals.T <= offsets, axis=1)]
        if len(inside) == 0:
            assert leave - enter < 0.002
            continue
        assert (enter, leave) == pytest.approx((inside[0], inside[-1]), abs=0.003)
        for at, plane in ((enter, start), (leave, end)):
            point = origin + at * direction
            assert normals[plane] @ point == pytest.approx(offsets[plane])
        assert normals[start] @ direction < 0.0 < normals[end] @ direction


@pytest.mark.parametrize(
    ("y", "hit"), [(0.0, True), (0.999, True), (1.001, False), (-1.001, False)]
)
def test_a_line_along_a_face_is_within_or_beside(y: float, hit: bool) -> None:
    enter, leave, *_ = K._cross(np.array([-5.0, y, 0.0]), X, *slabs((-1.0, 2.0))[:2], 0, 6)
    if hit:
        assert (enter, leave) == (4.0, 7.0)
    else:
        assert enter > leave


def test_all_lines_with_all_parts_and_one_direction_for_all() -> None:
    normals, offsets, first = slabs((-1.0, 1.0), (2.0, 3.0))
    origins = np.array([[0.0, 0.0, 0.0], [-2.0, 0.0, 0.0]])
    for directions in (X[None], np.array([X, X])):
        starts, ends = np.empty((2, 2)), np.empty((2, 2))
        planes = np.empty((2, 2), np.int64), np.empty((2, 2), np.int64)
        ray_kernels.cross_all(origins, directions, normals, offsets, first, starts, ends, *planes)
        assert starts.tolist() == [[-1.0, 2.0], [1.0, 4.0]]
        assert ends.tolist() == [[1.0, 3.0], [3.0, 5.0]]
        assert planes[0].tolist() == [[3, 9]] * 2 and planes[1].tolist() == [[0, 6]] * 2
    other = np.array([X, -X])
    ray_kernels.cross_all(origins, other, normals, offsets, first, starts, ends, *planes)
    assert starts.tolist() == [[-1.0, 2.0], [-3.0, -5.0]]


SEAM = 0.01


@pytest.mark.parametrize("way", [K.stretch, ray_kernels.stretch], ids=["plain", "compiled"])
@pytest.mark.parametrize(
    ("spans", "origin", "expected"),
    [
        ([(-1.0, 2.0)], 0.0, (-1.0, 2.0)),
        ([(1.0, 2.0)], 0.0, None),
        ([(0.009, 2.0)], 0.0, (0.009, 2.0)),
        ([(0.011, 2.0)], 0.0, None),
        ([(-2.0, -0.009)], 0.0, (-2.0, -0.009)),
        ([(-1.0, 1.0), (1.009, 2.0)], 0.0, (-1.0, 2.0)),
        ([(-1.0, 1.0), (1.011, 2.0)], 0.0, (-1.0, 1.0)),
        ([(3.0, 4.0), (2.0, 3.0), (1.0, 2.0), (-1.0, 1.0)], 0.0, (-1.0, 4.0)),
        ([(-4.0, -3.0), (-3.0, -2.0), (-2.005, 0.5)], 0.0, (-4.0, 0.5)),
        ([(-1.0, 1.0), (-0.5, 0.5)], 0.0, (-1.0, 1.0)),
        ([(-1.0, 1.0), (1.5, 2.0)], 1.7, (-0.2, 0.3)),
    ],
)
def test_the_stretch_at_an_origin_goes_across_seams_and_not_across_gaps(
    way: Any, spans: list[tuple[float, float]], origin: float, expected: tuple[float, float] | None
) -> None:
    """Lengths count from the origin; parts come in any order."""
    normals, offsets, first = slabs(*spans)
    there, low, high, start, end = way(
        np.array([origin, 0.0, 0.0]), X, normals, offsets, first, SEAM
    )
    assert there is (expected is not None) or there == (expected is not None)
    if expected is None:
        assert (start, end) == (-1, -1)
        return
    assert (low, high) == pytest.approx(expected)
    assert offsets[start] == pytest.approx(-(origin + low)) and normals[start, 0] == -1.0
    assert offsets[end] == pytest.approx(origin + high) and normals[end, 0] == 1.0


def test_a_part_that_the_line_misses_joins_nothing() -> None:
    normals, offsets, first = slabs((-1.0, 1.0), (1.0, 2.0))
    offsets[7], offsets[10] = 5.0, -4.0  # the second is between y = 4 and y = 5
    there, low, high, *_ = K.stretch(np.zeros(3), X, normals, offsets, first, SEAM)
    assert there and (low, high) == (-1.0, 1.0)
    assert not K.stretch(np.array([0.0, 8.0, 0.0]), X, normals, offsets, first, SEAM)[0]
    assert math.isinf(K._cross(np.array([0.0, 8.0, 0.0]), X, normals, offsets, 0, 6)[0])
