"""Corners are rounded by the parabola that both edges touch, passed where they are smooth, or rested at."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from tamp.geometric.motion.corner_blending import (
    BLEND_CHORD,
    BLEND_EDGE_SHARE,
    MAX_BLEND_DISTANCE,
    MAX_BLEND_HALVINGS,
    MOST_NODES,
    NODE_SPACING,
    Corner,
    blend,
    corners,
)

PUSH = np.array([2.0, 2.0])
ELBOW = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])


def anywhere(start: np.ndarray, end: np.ndarray) -> bool:
    return True


def nowhere(start: np.ndarray, end: np.ndarray) -> bool:
    return False


def test_without_a_checker_the_motion_rests_at_each_sharp_corner() -> None:
    first, elbow, last = corners(ELBOW, PUSH)
    assert (first.blend_length, elbow.blend_length, last.blend_length) == (0.0, 0.0, 0.0)
    assert (elbow.before.tolist(), elbow.after.tolist()) == ([1.0, 0.0], [0.0, 1.0])
    assert elbow.bend.tolist() == [0.0, 0.0]


@pytest.mark.parametrize(
    ("edge", "reach"), [(0.5, BLEND_EDGE_SHARE * 0.5), (5.0, MAX_BLEND_DISTANCE)]
)
def test_a_free_corner_is_rounded_by_a_share_of_the_shorter_edge_up_to_a_limit(
    edge: float, reach: float
) -> None:
    path = np.array([[0.0, 0.0], [edge, 0.0], [edge, 9.0]])
    _, elbow, _ = corners(path, PUSH, anywhere)
    assert elbow.reach == pytest.approx(reach) and elbow.blend_length == elbow.reach


def test_the_rounding_is_the_parabola_that_touches_both_edges() -> None:
    elbow = Corner(np.array([1.0, 0.0]), np.array([1.0, 0.0]), np.array([0.0, 1.0]), reach=0.12)
    curve = elbow.curve()
    assert curve[0] == pytest.approx([0.88, 0.0]) and curve[-1] == pytest.approx([1.0, 0.12])
    middle = elbow.vertex + 0.25 * 0.12 * (
        elbow.after - elbow.before
    )  # half way: a quarter of each leg
    assert curve[len(curve) // 2] == pytest.approx(middle)
    # In the station s it is x'' constant: velocity turns from one edge's direction to the other's over two reaches.
    assert elbow.before + 2 * 0.12 * elbow.bend == pytest.approx(elbow.after)


@pytest.mark.parametrize(
    ("reach", "chords"), [(0.001, 2), (2 * BLEND_CHORD, 4), (MAX_BLEND_DISTANCE, 8)]
)
def test_a_rounding_has_chords_of_one_length_between_two_and_eight(
    reach: float, chords: int
) -> None:
    elbow = Corner(np.zeros(2), np.array([1.0, 0.0]), np.array([0.0, 1.0]), reach=reach)
    assert len(elbow.shares()) == chords + 1
    assert elbow.curve().shape == (chords + 1, 2)


def test_smaller_roundings_are_tried_where_larger_ones_hit() -> None:
    post = np.array([0.93, 0.07])  # inside of the elbow, 0.1 from its vertex

    def clear(start: np.ndarray, end: np.ndarray) -> bool:
        points = start + np.linspace(0.0, 1.0, 50)[:, None] * (end - start)
        return bool((np.linalg.norm(points - post, axis=1) > 0.04).all())

    _, elbow, _ = corners(ELBOW, PUSH, clear)
    assert 0.0 < elbow.reach < MAX_BLEND_DISTANCE
    assert math.log2(MAX_BLEND_DISTANCE / elbow.reach) in range(1, MAX_BLEND_HALVINGS + 1)
    larger = Corner(elbow.vertex, elbow.before, elbow.after, reach=2 * elbow.reach).curve()
    assert not all(clear(a, b) for a, b in itertools.pairwise(larger))


def test_where_no_rounding_is_free_the_motion_rests() -> None:
    _, elbow, _ = corners(ELBOW, PUSH, nowhere)
    assert elbow.blend_length == 0.0


def test_close_samples_of_a_curve_are_passed_as_they_are() -> None:
    angle = np.linspace(0.0, math.pi / 2, 1500)
    curve = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    first, *inner, last = corners(curve, PUSH, nowhere)
    assert all(corner.window > 0.0 and corner.reach == 0.0 for corner in inner)
    assert first.blend_length == last.blend_length == 0.0


def test_a_straight_vertex_is_passed_whatever_the_limits() -> None:
    path = np.array([[0.0, 0.0], [1.0, 0.0], [4.0, 0.0]])
    _, middle, _ = corners(path, np.array([1e-3, 1e-3]))
    assert middle.window == pytest.approx(0.5)


def test_a_rail_runs_through_the_rounding_and_its_stations_grow() -> None:
    rail = blend(corners(ELBOW, PUSH, anywhere))
    assert rail.positions[0].tolist() == [0.0, 0.0] and rail.positions[-1].tolist() == [1.0, 1.0]
    assert (np.diff(rail.stations) > 0.0).all()
    assert rail.stations[-1] == pytest.approx(2.0)  # a rounding counts as its two legs
    assert len(rail.straight) == len(rail.stations) - 1 and not rail.straight.all()
    # Nowhere further from the corner than the legs, and the vertex itself is cut.
    assert (rail.positions[:, 0] <= 1.0 + 1e-12).all() and (rail.positions[:, 1] >= -1e-12).all()
    assert np.linalg.norm(rail.positions - [1.0, 0.0], axis=1).min() > 0.05


def test_tangents_are_what_the_positions_do_by_station() -> None:
    rail = blend(corners(ELBOW, PUSH, anywhere))
    slopes = np.diff(rail.positions, axis=0) / np.diff(rail.stations)[:, None]
    middles = 0.5 * (rail.tangents[1:] + rail.tangents[:-1])
    assert slopes == pytest.approx(middles, abs=1e-9)  # exact for lines and parabolas
    assert (rail.max_derivative >= np.abs(rail.tangents) - 1e-12).all()


def test_bends_act_within_the_rounding_alone() -> None:
    passed = corners(ELBOW, PUSH, anywhere)
    rail = blend(passed)
    inside = np.linalg.norm(rail.positions - [1.0, 0.0], axis=1) < passed[1].reach - 1e-9
    assert rail.curvature_before[inside] == pytest.approx(
        np.tile(passed[1].bend, (int(inside.sum()), 1))
    )
    outside = np.linalg.norm(rail.positions - [1.0, 0.0], axis=1) > passed[1].reach + 1e-9
    assert (rail.curvature_before[outside] == 0.0).all() and (
        rail.curvature_after[outside] == 0.0
    ).all()


@pytest.mark.parametrize(("length", "parts"), [(0.05, 1), (0.45, 5), (7.0, MOST_NODES)])
def test_a_straight_part_has_nodes_a_step_apart_up_to_a_number(length: float, parts: int) -> None:
    rail = blend(corners(np.array([[0.0, 0.0], [length, 0.0]]), PUSH))
    assert len(rail.stations) == parts + 1 and rail.straight.all()
    assert parts == MOST_NODES or np.diff(rail.stations).max() <= NODE_SPACING + 1e-12
