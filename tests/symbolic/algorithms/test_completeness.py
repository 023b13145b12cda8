"""What the k-th value of a stream makes solvable is solved; a failed call is never the end of a stream that goes on."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import pytest

from tamp.stream import Call, Rejection
from tests.symbolic.algorithms.line import Line
from tests.symbolic.algorithms.toys import ALGORITHMS, replay, solve, stream_task

K = range(1, 13)

PAIRS = """
(define (domain pairs)
  (:requirements :typing)
  (:types left right)
  (:predicates (left ?x - left) (right ?y - right) (fits ?x - left ?y - right) (done))
  (:action join
    :parameters (?x - left ?y - right)
    :precondition (fits ?x ?y)
    :effect (done)))
"""

PAIR_STREAMS = """
(define (stream pairs)
  (:stream draw-left :outputs (?x) :certified (left ?x))
  (:stream draw-right :outputs (?y) :certified (right ?y))
  (:stream test-fits :inputs (?x ?y) :domain (and (left ?x) (right ?y)) :certified (fits ?x ?y)))
"""


def moves_a(algorithm: str, problem_of: Line, **functions: object) -> None:
    problem = problem_of.problem("(on a right)", **functions)
    result = solve(algorithm, problem)
    replay(problem, result)
    problem_of.replay(result, {"a": "right"})


@pytest.fixture
def line() -> Line:
    return Line({"a": 0.5}, {"right": (10.0, 12.0)}, reach=(-1.0, 20.0))


@pytest.mark.parametrize("k", K)
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_only_the_kth_pose_is_in_reach(algorithm: str, k: int, line: Line) -> None:
    def sample_pose(block: str, region: str, call: Call) -> Iterator[float]:
        for i in itertools.count(1):
            yield 11.0 if i == k else 100.0 + i

    moves_a(algorithm, line, sample_pose=sample_pose)


@pytest.mark.parametrize("k", K)
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_first_tries_of_a_placement_are_rejected(algorithm: str, k: int, line: Line) -> None:
    def sample_pose(block: str, region: str, call: Call) -> Iterator[float | Rejection]:
        for i in itertools.count(1):
            yield 11.0 if i == k else Rejection("no room")

    moves_a(algorithm, line, sample_pose=sample_pose)


@pytest.mark.parametrize("k", K)
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_chained_stream_fails_for_the_first_poses(algorithm: str, k: int, line: Line) -> None:
    """Inverse kinematics ends without a value for all poses but the k-th."""

    def sample_pose(block: str, region: str, call: Call) -> Iterator[float]:
        for i in itertools.count(1):
            yield 10.5 + i / 100.0

    def inverse_kin(block: str, pose: float, grasp: float, call: Call) -> Iterator[float]:
        if pose == 0.5 or pose == 10.5 + k / 100.0:
            yield pose + grasp

    moves_a(algorithm, line, sample_pose=sample_pose, inverse_kin=inverse_kin)


@pytest.mark.parametrize("k", K)
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_inverse_kinematics_needs_k_tries_a_pose(algorithm: str, k: int, line: Line) -> None:
    def inverse_kin(
        block: str, pose: float, grasp: float, call: Call
    ) -> Iterator[float | Rejection]:
        for i in itertools.count(1):
            yield pose + grasp if i >= k else Rejection("no solution")

    moves_a(algorithm, line, inverse_kin=inverse_kin)


@pytest.mark.parametrize("k", K)
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_only_the_kth_grasp_works_everywhere(algorithm: str, k: int, line: Line) -> None:
    def sample_grasp(block: str, call: Call) -> Iterator[float]:
        for i in itertools.count(1):
            yield 0.25 if i == k else i / 1000.0

    def inverse_kin(block: str, pose: float, grasp: float, call: Call) -> Iterator[float]:
        if pose < 5.0 or grasp == 0.25:
            yield pose + grasp

    moves_a(algorithm, line, sample_grasp=sample_grasp, inverse_kin=inverse_kin)


@pytest.mark.parametrize("length", [None, 25])
@pytest.mark.parametrize(("left", "right"), [(1, 20), (20, 1), (3, 17), (17, 3), (20, 20)])
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_one_pair_of_many_fits(algorithm: str, left: int, right: int, length: int | None) -> None:
    """An early value together with a late one: no value is ever forgotten. Streams without end, and with one."""

    def draw(call: Call) -> Iterator[int]:
        yield from itertools.count(1) if length is None else range(1, length + 1)

    def fits(x: int, y: int, call: Call) -> bool:
        return (x, y) == (left, right)

    problem = stream_task(
        PAIRS,
        PAIR_STREAMS,
        {"draw-left": draw, "draw-right": draw, "test-fits": fits},
        {},
        "",
        "(done)",
    )
    result = solve(algorithm, problem)
    replay(problem, result)
    assert [result.objects.values[name] for name in result.actions[0].arguments] == [left, right]
