"""The loops of RRT-Connect, as plain Python among toy obstacles in the plane."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from tamp.geometric.motion import shortcut_loops, tree_loops
from tests.geometric.plain_kernels import plain

Edge = Callable[[Any, Any], bool]


def wall(start: Any, end: Any) -> bool:
    """Free but for the line x = 0 between y = -1 and y = 1.5."""
    if (start[0] < 0.0) == (end[0] < 0.0):
        return True
    share = start[0] / (start[0] - end[0])
    return not -1.0 < start[1] + share * (end[1] - start[1]) < 1.5


def kernels(free: Edge) -> Any:
    """All loops, asking `free` for their edges; `asked` notes them."""
    asked: list[tuple[Any, Any]] = []

    def decide(start: Any, end: Any, *_: Any) -> int:
        asked.append((np.array(start), np.array(end)))
        return made.FREE if free(start, end) else made.FREE + 1

    made = plain(tree_loops, shortcut_loops, decide=decide)
    made.asked = asked
    return made


class Trees:
    """Two trees in the square from -2 to 2, one from each root."""

    def __init__(self, free: Edge, start: Any, goals: Any, rows: int = 200) -> None:
        self.k = kernels(free)
        size = len(start)
        self.trees = np.zeros((2, rows, size))
        self.parents = np.full((2, rows), -5)
        self.domains = np.full((2, rows), math.inf)
        self.counts = np.array([1, len(goals)])
        self.trees[0, 0], self.parents[0, 0] = start, -1
        self.trees[1, : len(goals)], self.parents[1, : len(goals)] = goals, -1

    def grow(
        self, seed: int = 0, most: int = 400, reach: float = 0.5, domain: float = 1.0,
        periodic: int = -1, first: int = 0, weights: Any = (1.0, 1.0),
    ) -> tuple[int, int, int]:  # fmt: skip
        with np.errstate(over="ignore"):
            return self.k.grow(
                self.trees, self.parents, self.domains, self.counts, np.full(len(weights), -2.0),
                np.full(len(weights), 2.0), first, np.array(weights), periodic, reach, domain, 0.0,
                most, np.array([seed], dtype=np.uint64), None, None, None,
                self.trees[0, :1].copy(), self.trees[0, :1].copy(),
            )  # fmt: skip

    def path(self, met: tuple[int, int, int]) -> Any:
        rows = np.empty((self.counts.sum() + 10, self.trees.shape[2]))
        return rows[: self.k.trace(self.trees, self.parents, met[0], met[1], rows)]


@pytest.mark.parametrize("seed", range(5))
def test_trees_meet_around_a_wall(seed: int) -> None:
    trees = Trees(wall, [-1.0, 0.0], [[1.0, 0.0], [1.5, 0.5]])
    path = trees.path(trees.grow(seed))
    assert path[0] == pytest.approx([-1.0, 0.0])
    assert path[-1].tolist() in ([1.0, 0.0], [1.5, 0.5])
    assert all(wall(a, b) for a, b in itertools.pairwise(path))
    assert (np.linalg.norm(np.diff(path, axis=0), axis=1) <= 0.5 + 1e-9).all()


def test_the_same_seed_grows_the_same_trees() -> None:
    first, second, other = (Trees(wall, [-1.0, 0.0], [[1.0, 0.0]]) for _ in range(3))
    assert first.grow(3) == second.grow(3)
    assert (first.trees == second.trees).all()
    other.grow(4)
    assert not (first.trees == other.trees).all()


def test_every_edge_asked_for_is_counted_and_no_more_than_allowed() -> None:
    trees = Trees(lambda a, b: False, [-1.0, 0.0], [[1.0, 0.0]])
    assert trees.grow(most=7, domain=10.0) == (-1, -1, 7)
    assert len(trees.k.asked) == 7
    assert trees.counts.tolist() == [1, 1]


def test_a_blocked_configuration_is_extended_only_towards_what_is_near() -> None:
    trees = Trees(lambda a, b: False, [-1.0, 0.0], [[1.0, 0.0]])
    met = trees.grow(most=50, domain=0.01)
    # After one blocked edge each, hardly a sample is near enough.
    assert met[:2] == (-1, -1) and met[2] < 10
    assert trees.domains[:, 0].tolist() == [0.01, 0.01]


def test_trees_stop_where_they_are_full() -> None:
    trees = Trees(wall, [-1.0, 0.0], [[1.0, 0.0]], rows=3)
    trees.grow(reach=0.05)
    assert trees.counts.max() == 3


def test_a_coordinate_that_wraps_goes_the_shorter_way_round() -> None:
    """Only the last of three moves: an angle, from 3 to -3, over pi."""
    trees = Trees(lambda a, b: True, [7.0, 8.0, 3.0], [[7.0, 8.0, -3.0]])
    met = trees.grow(reach=10.0, periodic=2, first=2, weights=(1.0,))
    path = trees.path(met)
    assert path[:, :2] == pytest.approx(np.tile([7.0, 8.0], (len(path), 1)))
    assert trees.k._way([3.0], [-3.0], 0, 0) == pytest.approx(2 * math.pi - 6.0)
    assert trees.k._way([3.0], [-3.0], 0, -1) == -6.0


def test_the_generator_is_splitmix() -> None:
    """The first output of SplitMix64 from the seed 0 is 0xE220A8397B1DCDAF."""
    k, state = kernels(wall), np.array([0], dtype=np.uint64)
    with np.errstate(over="ignore"):
        first = k.uniform(state)
        rest = [k.uniform(state) for _ in range(1000)]
    assert first == (0xE220A8397B1DCDAF >> 11) / 2**53
    assert all(0.0 <= one < 1.0 for one in rest)
    assert abs(float(np.mean(rest)) - 0.5) < 0.03
