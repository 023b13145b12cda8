"""How an edge is decided, in plain Python on a robot of two balls: the ends first, then halves, then undecided."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

from tamp.geometric.collision import edge_decision, gjk, kernels, placing
from tamp.geometric.collision.edge_decision import pair_of
from tamp.geometric.collision.kernels import FLOOR, FREE, HIT, ROOM, SELF, UNDECIDED
from tamp.geometric.collision.tables import Tables
from tamp.geometric.scene.pose import Array
from tests.geometric.collision.lever import conf, outcome, tables
from tests.geometric.plain_kernels import plain

CUBE = (1.0, 0.0, 0.5)
K = plain(gjk, placing, kernels, edge_decision)
AWAY = np.pi
"""The lever's side: away from what the base's ball drives to."""


def decided(
    made: Tables, start: Array, end: Array, padding: float = 0.002, known: bool = False, **toys: Any
) -> int:
    K = plain(gjk, placing, kernels, edge_decision, **toys)
    work = K.scratch(
        made.parts, made.joints, made.pairs, made.obstacles, len(start), K.moves_along(start, end)
    )
    return K.decide(start, end, padding, known, made.room, tuple(made)[1:], work)


@pytest.mark.parametrize("code", [FREE, HIT, UNDECIDED])
@pytest.mark.parametrize("part", [0, 7, 4095])
@pytest.mark.parametrize("other", [0, 1, 3000, FLOOR, ROOM, SELF, SELF - 60])
def test_a_verdict_holds_its_pair(code: int, part: int, other: int) -> None:
    verdict = K.encode_result(np.int64(code), np.int64(part), np.int64(other))
    assert outcome(verdict) == code and pair_of(verdict) == (part, other)


def test_an_edge_moves_when_any_number_differs() -> None:
    start = np.zeros(5)
    assert not K.moves_along(start, start.copy())
    for k in range(5):
        end = start.copy()
        end[k] = 1e-12
        assert K.moves_along(start, end)


def test_leaving_the_room_is_told_before_all_else() -> None:
    """The room ends at 2 m; one of the ends is enough, and its edge still counts as in it."""
    inside, edge, beyond = conf(0.0, 0.0), conf(2.0, -2.0), conf(0.0, 2.001)
    verdicts = [decided(tables(), *ends) for ends in itertools.permutations((inside, beyond), 2)]
    assert [outcome(one) for one in verdicts] == [HIT, HIT]
    assert {pair_of(one) for one in verdicts} == {(0, ROOM)}
    assert outcome(decided(tables(), inside, edge)) == FREE


def test_a_start_that_is_known_to_be_free_is_not_looked_at() -> None:
    """It is 1.5 mm from the cube where 2 mm are asked for; from there the edge leads straight away."""
    near, far = conf(1.0 - 0.2 - 0.0015, 0.0, AWAY), conf(0.2, 0.0, AWAY)
    assert outcome(decided(tables([CUBE]), near, far)) == HIT
    assert outcome(decided(tables([CUBE]), near, far, known=True)) == FREE
    assert outcome(decided(tables([CUBE]), far, near, known=True)) == HIT  # the end is looked at


def test_a_thin_gap_needs_halves_and_too_little_room_for_them_is_undecided() -> None:
    """The base passes the cube at 1 cm: no bound on its whole way of 1.6 m shows that."""
    start, end = conf(-0.1, -0.21, AWAY), conf(1.5, -0.21, AWAY)
    made = tables([(0.7, 0.0, 0.5)], floor=True)
    assert outcome(decided(made, start, end)) == FREE
    for toys in ({"INTERVALS": 4}, {"TASKS": 0}):
        verdict = decided(made, start, end, **toys)
        assert (outcome(verdict), pair_of(verdict)) == (UNDECIDED, (0, 0))


def test_the_middle_is_met_though_both_ends_are_free() -> None:
    start, end = conf(0.5, 0.0, AWAY), conf(1.5, 0.0, AWAY)
    made = tables([CUBE])
    assert outcome(decided(made, start, start)) == outcome(decided(made, end, end)) == FREE
    assert pair_of(decided(made, start, end)) == (0, 0)
    assert outcome(decided(made, start, end)) == HIT


def test_each_part_is_held_against_each_obstacle() -> None:
    """The lever's ball is 1 m beside the base's: one cube is at either."""
    made = tables([(1.5, 1.5, 0.5), (0.0, 1.0, 0.5), CUBE])
    assert pair_of(decided(made, conf(0.0, 0.0, np.pi / 2), conf(0.0, 0.0, np.pi / 2))) == (1, 1)
    assert pair_of(decided(made, conf(0.0, 0.0), conf(0.0, 0.0))) == (1, 2)
    assert pair_of(decided(made, conf(1.0, 0.0), conf(1.0, 0.0))) == (0, 2)


def test_candidates_are_the_pairs_whose_boxes_meet() -> None:
    """At 0.3 m of reach the ball's box ends at 0.4 m from its centre; the cube's begins 0.1 m before its own."""
    for x, found in ((0.49, [(0, 0)]), (0.51, [])):
        made = tables([(x, 0.0, 0.5)])
        parts, joints, obstacles = made.parts[:1], made.joints, made.obstacles
        frames, placed = np.empty((2, 12)), np.empty((1, 12))
        reach, change = np.empty((1, 9)), np.zeros(8)
        K.place_frames(conf(0.0, 0.0), joints, frames)
        K.place_part(0, frames, change, joints, parts, made.part_poses, placed, reach)
        rows, box = np.full((4, 2), -9, dtype=np.int64), np.empty((2, 6))
        count = K._candidates(0.0, 0.3, parts, made.pairs, obstacles, placed, reach, box, rows)
        assert [tuple(row) for row in rows[:count].tolist()] == found
        assert box[0] == pytest.approx([-0.4, -0.4, 0.1, 0.4, 0.4, 0.9])
