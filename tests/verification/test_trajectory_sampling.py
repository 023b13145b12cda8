"""Motions are sampled so finely that nothing hides, in pieces that join."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from tamp.geometric.scene.pose import Pose
from tamp.simulation.world import World
from tamp.verification.execution_state import Held
from tamp.verification.makers_limits import limits_of
from tamp.verification.trajectory_sampling import (
    JOINT_STEP_RAD,
    MAX_PIECE_ROWS,
    POINT_STEP_M,
    Sampler,
    _divided,
    _unwound,
)
from tests.verification.posts import ROBOT, row


def test_samples_are_close_together(world: World, rng: np.random.Generator) -> None:
    sampler = Sampler(world, ROBOT)
    held = (Held("stick", Pose((0.0, 0.0, 0.1)).matrix),)
    tried = 0
    for _ in range(5):
        arms = rng.uniform(ROBOT.lower, ROBOT.upper, (2, 7))
        ends = np.array(
            [
                row(
                    float(rng.uniform(-1, 1)),
                    float(rng.uniform(-1, 1)),
                    float(rng.uniform(-3, 3)),
                    arm,
                )
                for arm in arms
            ]
        )
        motion = sampler.sampled(ends, np.array([0.0, 1.0]), held)
        rows, times = motion.rows, motion.times
        assert np.allclose(rows[[0, -1]], ends) and (np.diff(times) > 0).all()
        assert np.abs(np.diff(rows[:, 2:10], axis=0)).max() <= JOINT_STEP_RAD * (1 + 1e-6)
        tips = motion.frames[-1] @ np.array([0.0, 0.0, 0.15, 1.0])
        assert np.linalg.norm(np.diff(tips, axis=0), axis=1).max() <= POINT_STEP_M * (1 + 1e-6)
        tried += len(rows)
    assert tried > 1000


def test_frames_of_a_driving_base_are_the_engines(world: World) -> None:
    sampler = Sampler(world, ROBOT)
    ends = np.array([row(), row(1.0, 0.5, 2.0)])
    motion = sampler.sampled(ends, np.array([0.0, 1.0]), ())
    rows = motion.rows
    world.set_robot(rows[70, :3], rows[70, 3:10], rows[70, 10])
    for name, frame in zip(world.links, motion.frames[:, 70], strict=True):
        assert np.allclose(world.link_poses()[name], frame, atol=1e-6)


def test_pieces_of_a_motion_join_to_the_motion(world: World, rng: np.random.Generator) -> None:
    sampler = Sampler(world, ROBOT)
    yaws = np.cumsum(rng.uniform(-40.0, 40.0, 200))
    rows = np.array([row(float(rng.uniform(-2, 2)), 0.0, yaw) for yaw in yaws])
    times = np.arange(200.0)
    pieces = list(sampler.pieces(rows, times))
    assert len(pieces) > 3
    for (before, at), (after, then) in itertools.pairwise(pieces):
        assert np.allclose(before[-1], after[0])
        assert at[-1] == pytest.approx(then[0])
    assert np.allclose(pieces[-1][0][-1, :2], rows[-1, :2])
    turned = pieces[-1][0][-1, 2] - rows[-1, 2]
    assert math.sin(turned / 2) == pytest.approx(0.0, abs=1e-9)


def test_an_edge_is_divided_in_equal_pieces() -> None:
    rows, times = _divided(
        np.array([[0.0, 0.0], [3.0, 6.0], [3.0, 7.0]]), np.array([0.0, 3.0, 4.0]), np.array([3, 0])
    )
    assert rows.tolist() == [[0.0, 0.0], [1.0, 2.0], [2.0, 4.0], [3.0, 6.0], [3.0, 7.0]]
    assert times.tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]


@pytest.mark.parametrize(
    ("metres", "turned", "kept"),
    [
        (0.0, 3.0, 3.0),
        (0.0, 20 * math.tau + 0.5, math.tau + 0.5),  # on the spot one turn says all
        (0.0, -20 * math.tau - 0.5, -math.tau - 0.5),
        (2.5 * POINT_STEP_M, 20 * math.tau + 0.5, 3 * math.tau + 0.5),
        (1.0, 20 * math.tau + 0.5, 20 * math.tau + 0.5),
    ],
)
def test_no_more_turns_are_kept_than_make_a_difference(
    metres: float, turned: float, kept: float
) -> None:
    start = 0.25 + 7 * math.tau
    rows = np.array([row(0.0, 0.0, start), row(metres, 0.0, start + turned)])
    found = _unwound(rows)
    assert found[:, 2] == pytest.approx([0.25, 0.25 + kept])
    assert found[:, :2].tolist() == rows[:, :2].tolist() and rows[0, 2] == start


def test_a_piece_has_so_many_rows_at_most(world: World) -> None:
    rows = np.array([row(0.001 * number) for number in range(150)])
    pieces = [len(some) for some, _ in Sampler(world, ROBOT).pieces(rows, np.arange(150.0))]
    assert pieces == [MAX_PIECE_ROWS + 1, MAX_PIECE_ROWS + 1, 150 - 2 * MAX_PIECE_ROWS]
    (alone,) = Sampler(world, ROBOT).pieces(rows[:1], np.zeros(1))
    assert len(alone[0]) == 1


def test_what_is_far_beyond_the_limits_is_looked_at_a_little_beyond_them(world: World) -> None:
    wild = row(99.0, -99.0, 50.0, np.full(7, 99.0))
    wild[10] = 5.0
    clipped = Sampler(world, ROBOT).clipped(wild[None])[0]
    assert clipped[:3].tolist() == [4.0, -4.0, 50.0]
    upper = limits_of(ROBOT).upper
    assert clipped[3:10] == pytest.approx(np.array(upper) + 1.0) and clipped[10] == 0.08
    assert Sampler(world, ROBOT).clipped(row()[None])[0].tolist() == row().tolist()


def test_a_motion_is_remembered_with_what_is_held(
    world: World, monkeypatch: pytest.MonkeyPatch
) -> None:
    sampler, made = Sampler(world, ROBOT), []
    sampled = sampler.sampled
    monkeypatch.setattr(sampler, "sampled", lambda *asked: made.append(asked) or sampled(*asked))
    held = (Held("stick", Pose((0.0, 0.0, 0.1)).matrix),)
    ways = [np.array([row(), row(x)]) for x in (0.1, 0.2, 0.3)]
    times = np.array([0.0, 1.0])

    def ask(number: int, *what: Held) -> int:
        before = len(made)
        (motion,) = sampler.motions(ways[number], times, what)
        assert len(motion.frames) == len(sampler.movers(what))
        return len(made) - before

    assert [ask(0), ask(0), ask(0, *held), ask(0)] == [1, 0, 1, 0]
    assert [ask(1), ask(0, *held), ask(0)] == [1, 0, 1]  # only the last two are kept


def test_the_hand_is_within_its_radius(world: World) -> None:
    sampler = Sampler(world, ROBOT)
    wide, closed = (sampler.hand_radius(opening) for opening in (0.08, 0.0))
    assert 0.05 < closed <= wide < 0.3
    assert sampler.hand_radius(0.08) == wide
