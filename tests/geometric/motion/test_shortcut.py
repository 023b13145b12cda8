from __future__ import annotations

from itertools import pairwise

import numpy as np

from tamp.geometric.motion.path import length
from tamp.geometric.motion.shortcut import shortcut
from tamp.geometric.scene.pose import Array


def _outside_disc(a: Array, b: Array) -> bool:
    return all(np.hypot(*point[:2]) > 1.0 for point in np.linspace(a, b, 200))


def _arc(count: int) -> Array:
    angles = np.linspace(np.pi, 0.0, count)
    return 2.0 * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def test_the_result_is_shorter_free_and_has_the_same_ends() -> None:
    path = _arc(20)
    shorter, checks = shortcut(
        path, _outside_disc, np.random.default_rng(0), tries=100, patience=30
    )
    assert np.array_equal(shorter[0], path[0]) and np.array_equal(shorter[-1], path[-1])
    assert all(_outside_disc(a, b) for a, b in pairwise(shorter))
    tangents = (
        2.0 * np.sqrt(3.0) + np.pi / 3.0
    )  # the shortest way round: two tangents and an arc of 60 degrees
    assert tangents <= length(shorter) < 1.05 * tangents
    assert checks > 0


def test_everything_free_leaves_one_edge() -> None:
    shorter, checks = shortcut(
        _arc(9), lambda _a, _b: True, np.random.default_rng(0), tries=10, patience=5
    )
    assert len(shorter) == 2 and checks == 1


def test_nothing_free_leaves_the_path_and_stops_early() -> None:
    path = _arc(5)
    same, checks = shortcut(
        path, lambda _a, _b: False, np.random.default_rng(0), tries=1000, patience=7
    )
    assert np.array_equal(same, path)
    assert checks <= 7 + 2 * len(path)


def test_the_seed_decides() -> None:
    first, second = (
        shortcut(_arc(20), _outside_disc, np.random.default_rng(5), tries=40, patience=10)[0]
        for _ in range(2)
    )
    assert np.array_equal(first, second)


def test_a_whole_turn_is_taken_out() -> None:
    path = np.array(
        [
            [0.0, 0.0, 0.0],
            [0.0, 1.0, 3.0],
            [0.0, 2.0, 6.0],
            [0.0, 3.0, 9.0],
            [0.0, 4.0, 2 * np.pi + 3.2],
        ]
    )
    shorter, _ = shortcut(
        path, lambda _a, _b: True, np.random.default_rng(0), tries=5, patience=5, periodic=(2,)
    )
    assert np.allclose(shorter, [[0, 0, 0], [0, 4, 3.2 - 2 * np.pi]]) or np.allclose(
        shorter[-1], [0, 4, 3.2]
    )
    assert np.all(np.abs(np.diff(shorter[:, 2])) <= np.pi)


def test_repeated_rows_do_no_harm() -> None:
    path = np.repeat(_arc(6), 2, axis=0)
    shorter, _ = shortcut(path, _outside_disc, np.random.default_rng(0), tries=50, patience=20)
    assert np.all(np.isfinite(shorter)) and length(shorter) < length(path)
