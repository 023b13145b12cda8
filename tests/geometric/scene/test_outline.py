"""The outline of points against what convexity says of it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tamp.geometric.scene.outline import outline

_POINTS = st.lists(st.tuples(st.integers(-6, 6), st.integers(-6, 6)), min_size=3, max_size=25)


def area(corners: np.ndarray) -> float:
    """Signed, by the shoelace formula: positive counterclockwise."""
    x, y = corners.T
    return float(0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1)))


def test_a_square_with_points_inside_and_on_its_edges_has_four_corners() -> None:
    points = np.array(
        [[0, 0], [2, 0], [2, 2], [0, 2], [1, 1], [1, 0], [2, 1], [0.3, 1.7]], dtype=float
    )
    corners = outline(points)
    assert {tuple(corner) for corner in corners.tolist()} == {(0, 0), (2, 0), (2, 2), (0, 2)}
    assert area(corners) == pytest.approx(4.0)


@given(_POINTS)
def test_every_point_is_left_of_every_edge(points: list[tuple[int, int]]) -> None:
    given_points = np.array(points, dtype=float)
    corners = outline(given_points)
    if len(corners) < 3:  # on one line, or one point
        return

    assert {tuple(corner) for corner in corners.tolist()} <= {
        tuple(point) for point in given_points.tolist()
    }
    assert area(corners) > 0.0
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        edge, to = b - a, given_points - a
        assert (edge[0] * to[:, 1] - edge[1] * to[:, 0] >= -1e-9).all()


@given(_POINTS)
def test_no_corner_lies_between_two_others(points: list[tuple[int, int]]) -> None:
    corners = outline(np.array(points, dtype=float))
    if len(corners) < 3:
        return
    whole = area(corners)
    for left_out in range(len(corners)):
        rest = np.delete(corners, left_out, axis=0)
        assert area(rest) < whole - 1e-9


def test_equal_points_count_once() -> None:
    assert outline(np.array([[1.0, 2.0]] * 5)).tolist() == [[1.0, 2.0]]
    assert len(outline(np.array([[0.0, 0.0], [1.0, 0.0], [1.0 + 1e-12, 0.0]]))) == 2


def test_points_on_a_line_leave_its_two_ends() -> None:
    line = np.array([[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [5.0, 5.0]])
    assert {tuple(corner) for corner in outline(line).tolist()} == {(0.0, 0.0), (5.0, 5.0)}
