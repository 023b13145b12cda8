"""The largest rectangles in polygons and unions, against closed forms and an exhaustive search over cells."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tamp.geometric.loading.rectangles import inscribed, largest_of_union
from tamp.geometric.scene.outline import outline

NONE = np.zeros((0, 4))


def area(rectangle: np.ndarray | tuple[float, ...]) -> float:
    x0, x1, y0, y1 = rectangle
    return float((x1 - x0) * (y1 - y0))


@pytest.mark.parametrize("turned", [1, -1])
def test_a_rectangle_is_its_own(turned: int) -> None:
    corners = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0]])[::turned]
    assert inscribed(corners) == pytest.approx([0.0, 3.0, 0.0, 2.0])


def test_in_a_right_triangle_it_takes_half_of_the_area() -> None:
    # Under the line x / 2 + y = 1 the product x y is largest at x = 1, y = 1/2.
    found = inscribed(np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]]))
    assert area(found) == pytest.approx(0.5, rel=0.01)


def test_in_a_circle_it_is_the_square_up_to_the_grid() -> None:
    angle = np.linspace(0.0, 2 * np.pi, 200, endpoint=False)
    found = inscribed(np.stack([np.cos(angle), np.sin(angle)], axis=1))
    assert area(found) == pytest.approx(2.0, rel=0.01) and area(found) <= 2.0 + 1e-9


@given(st.integers(0, 10_000))
@settings(max_examples=40)
def test_it_lies_within_the_polygon_and_no_shifted_one_is_larger(seed: int) -> None:
    rng = np.random.default_rng(seed)
    polygon = outline(rng.uniform(-1.0, 1.0, (12, 2)))
    x0, x1, y0, y1 = inscribed(polygon)
    assert x0 <= x1 and y0 <= y1

    def inside(points: np.ndarray) -> bool:
        edges = np.roll(polygon, -1, axis=0) - polygon
        to = points[:, None] - polygon[None]
        return bool((edges[:, 0] * to[..., 1] - edges[:, 1] * to[..., 0] >= -1e-9).all())

    assert inside(np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]]))
    low, high = polygon.min(axis=0), polygon.max(axis=0)
    for _ in range(200):  # none of many random ones is larger by more than the grid's coarseness
        a, b = np.sort(rng.uniform(low, high, (2, 2)), axis=0)
        if inside(np.array([a, [b[0], a[1]], b, [a[0], b[1]]])):
            assert np.prod(b - a) <= area((x0, x1, y0, y1)) * 1.1 + 1e-9


def test_two_boards_side_by_side_are_one() -> None:
    boards = np.array([[0.0, 1.0, 0.0, 1.0], [1.0, 2.0, 0.0, 1.0]])
    assert largest_of_union(boards, NONE) == (0.0, 2.0, 0.0, 1.0)


def test_a_gap_of_less_than_a_hundredth_of_a_millimetre_is_none() -> None:
    boards = np.array([[0.0, 1.0, 0.0, 1.0], [1.000005, 2.0, 0.0, 1.0]])
    assert area(largest_of_union(boards, NONE)) == pytest.approx(2.0)
    boards[1, 0] = 1.01
    assert area(largest_of_union(boards, NONE)) == pytest.approx(1.0)


def test_what_stands_in_the_middle_leaves_the_larger_side() -> None:
    found = largest_of_union(np.array([[0.0, 10.0, 0.0, 4.0]]), np.array([[3.0, 4.0, 1.0, 2.0]]))
    assert found == (4.0, 10.0, 0.0, 4.0)


def test_without_area_there_is_none() -> None:
    assert largest_of_union(np.array([[0.0, 0.0, 0.0, 1.0]]), NONE) == (0.0, 0.0, 0.0, 0.0)
    assert largest_of_union(
        np.array([[0.0, 1.0, 0.0, 1.0]]), np.array([[-1.0, 2.0, -1.0, 2.0]])
    ) == (0, 0, 0, 0)


_RECTANGLE = st.tuples(
    st.integers(0, 6), st.integers(1, 4), st.integers(0, 6), st.integers(1, 4)
).map(lambda r: (r[0], r[0] + r[1], r[2], r[2] + r[3]))


@given(st.lists(_RECTANGLE, min_size=1, max_size=4), st.lists(_RECTANGLE, max_size=2))
@settings(max_examples=60)
def test_it_is_the_largest_that_a_search_over_unit_cells_finds(
    boards: list[tuple[int, ...]], blocked: list[tuple[int, ...]]
) -> None:
    free = np.zeros((11, 11), dtype=bool)
    for x0, x1, y0, y1 in boards:
        free[x0:x1, y0:y1] = True
    for x0, x1, y0, y1 in blocked:
        free[x0:x1, y0:y1] = False
    best = max(
        ((x1 - x0) * (y1 - y0)
         for x0 in range(11) for x1 in range(x0 + 1, 12) for y0 in range(11) for y1 in range(y0 + 1, 12)
         if free[x0:x1, y0:y1].all()),
        default=0,
    )  # fmt: skip

    found = largest_of_union(np.array(boards, float), np.array(blocked, float).reshape(-1, 4))
    assert area(found) == pytest.approx(best)
    x0, x1, y0, y1 = (round(number) for number in found)
    assert free[x0:x1, y0:y1].all()
