from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tamp.geometric.motion.path import at, edge_lengths, length, nearest, unwrap, without_repeats

angles = st.floats(-20.0, 20.0)


@given(angles, angles)
def test_nearest_is_the_same_angle_within_half_a_turn(reference: float, angle: float) -> None:
    moved = nearest(np.array([5.0, reference]), np.array([-5.0, angle]), (1,))
    assert moved[0] == -5.0
    assert abs(moved[1] - reference) <= np.pi + 1e-9
    assert np.isclose(np.cos(moved[1]), np.cos(angle)) and np.isclose(
        np.sin(moved[1]), np.sin(angle)
    )


def test_nearest_leaves_a_near_angle_exactly() -> None:
    assert nearest(np.array([0.1]), np.array([0.3]), (0,))[0] == 0.3


@given(st.lists(angles, min_size=2, max_size=8))
def test_no_unwrapped_edge_turns_the_longer_way(yaws: list[float]) -> None:
    path = np.array([[0.0, 1.0, yaw] for yaw in yaws])
    unwrapped = unwrap(path, (2,))
    assert np.all(np.abs(np.diff(unwrapped[:, 2])) <= np.pi + 1e-9)
    assert np.allclose(np.exp(1j * unwrapped[:, 2]), np.exp(1j * path[:, 2]))
    assert np.array_equal(unwrapped[0], path[0])


def test_lengths_weigh_coordinates() -> None:
    path = np.array([[0.0, 0.0], [3.0, 4.0], [3.0, 5.0]])
    assert np.allclose(edge_lengths(path), [5.0, 1.0])
    assert np.isclose(length(path, np.array([1.0, 0.5])), np.hypot(3.0, 2.0) + 0.5)


def test_at_runs_along_the_path() -> None:
    path = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]])
    assert np.allclose(
        at(path, np.array([0.0, 0.5, 1.5, 3.0])), [[0, 0], [0.5, 0], [1, 0.5], [1, 2]]
    )


def test_without_repeats() -> None:
    path = np.array([[0.0], [0.0], [1.0], [1.0], [0.0]])
    assert np.array_equal(without_repeats(path), [[0.0], [1.0], [0.0]])
    assert np.array_equal(without_repeats(path[:2]), [[0.0]])
