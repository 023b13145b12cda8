"""Shortening in the kernel's loops, as plain Python among toy obstacles in the plane."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest

from tests.geometric.motion.test_tree_loops import Edge, kernels, wall

ROUND = np.array([[-1.0, 0.0], [-1.0, 1.0], [-0.5, 2.0], [0.5, 2.0], [1.0, 1.0], [1.0, 0.0]])


def length(path: Any) -> float:
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def test_vertices_are_skipped_where_the_way_is_free() -> None:
    k, path = kernels(lambda a, b: True), ROUND.copy()
    kept, asked = k.skip_vertices(path, len(path), 0.0, None, None, None)
    assert (kept, asked) == (2, 1)
    assert path[:2].tolist() == [[-1.0, 0.0], [1.0, 0.0]]


def test_no_vertex_is_skipped_where_nothing_else_is_free() -> None:
    k, path = kernels(lambda a, b: False), ROUND.copy()
    kept, _ = k.skip_vertices(path, len(path), 0.0, None, None, None)
    assert kept == len(ROUND) and (path == ROUND).all()


def test_a_jump_that_is_blocked_is_halved() -> None:
    """Of nine points in a row, what is two apart can be joined: 8, 4 and 2 are tried."""
    k = kernels(lambda a, b: abs(a[0] - b[0]) <= 2.0)
    path = np.column_stack([np.arange(9.0), np.zeros(9)])
    kept, asked = k.skip_vertices(path, 9, 0.0, None, None, None)
    assert path[:kept, 0].tolist() == [0.0, 2.0, 3.0, 5.0, 6.0, 8.0]
    assert asked == 3 + 2 + 2 + 1 + 1


def shortened(free: Edge, seed: int, tries: int = 60, patience: int = 100) -> tuple[Any, int, Any]:
    k, path = kernels(free), np.zeros((len(ROUND) + tries, 2))
    path[: len(ROUND)] = ROUND
    with np.errstate(over="ignore"):
        count, asked = k.cut_at_random(
            path, len(ROUND), np.empty(len(path)), np.empty((2, 2)), tries, patience, 0.0,
            np.array([seed], dtype=np.uint64), None, None, None,
        )  # fmt: skip
    return path[:count], asked, k


@pytest.mark.parametrize("seed", range(5))
def test_random_cuts_shorten_the_way_around_a_wall_and_keep_its_ends(seed: int) -> None:
    path, asked, k = shortened(wall, seed)
    assert path[0].tolist() == [-1.0, 0.0] and path[-1].tolist() == [1.0, 0.0]
    assert all(wall(a, b) for a, b in itertools.pairwise(path))
    shortest = 2 * math.hypot(1.0, 1.5)
    assert shortest <= length(path) < 0.95 * length(ROUND)
    assert asked == len(k.asked) > 0


def test_shortening_gives_up_after_so_many_refusals_in_a_row() -> None:
    path, asked, _ = shortened(lambda a, b: False, 0, patience=4)
    assert asked == 4 and (path == ROUND).all()


def test_a_cut_that_saves_hardly_anything_is_not_asked_for() -> None:
    k, tries = kernels(lambda a, b: True), 30
    path = np.zeros((3 + tries, 2))
    path[:3] = [[0.0, 0.0], [1.0, 0.01], [2.0, 0.0]]
    with np.errstate(over="ignore"):
        found = k.cut_at_random(
            path, 3, np.empty(len(path)), np.empty((2, 2)), tries, 5, 0.0,
            np.array([1], dtype=np.uint64), None, None, None,
        )  # fmt: skip
    assert found == (3, 0)
