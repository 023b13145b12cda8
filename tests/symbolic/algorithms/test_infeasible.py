"""When there is no plan: it is proven where it can be, long before the deadline, and the object is named."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tamp.stream import Call, Rejection
from tamp.symbolic.algorithms.result import Outcome, Result, StreamTask
from tests.clock import unhindered
from tests.symbolic.algorithms.line import Line
from tests.symbolic.algorithms.toys import ALGORITHMS, replay, solve, stream_task

NO_PLAN = (Outcome.INFEASIBLE, Outcome.EXHAUSTED)


def fails(algorithm: str, problem: StreamTask, *outcomes: Outcome) -> Result:
    """Solve what has no plan, in less than a quarter of the time given."""
    started = unhindered()
    result = solve(algorithm, problem, seconds=8.0)
    assert result.outcome in outcomes, (result.outcome, result.explanation)
    assert unhindered() - started < 2.0
    assert result.actions == ()
    return result


TWO_KINDS = """
(define (domain statues)
  (:requirements :typing)
  (:types statue block - thing thing place - object)
  (:predicates (at ?x - thing ?p - place))
  (:action carry
    :parameters (?x - block ?from ?to - place)
    :precondition (at ?x ?from)
    :effect (and (at ?x ?to) (not (at ?x ?from)))))
"""


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_nothing_can_move_the_object(algorithm: str) -> None:
    problem = stream_task(
        TWO_KINDS,
        "(define (stream none))",
        {},
        {"david": ("statue",), "cube": ("block",), "here": ("place",), "there": ("place",)},
        "(at david here) (at cube here)",
        "(and (at cube there) (at david there))",
    )
    result = fails(algorithm, problem, Outcome.INFEASIBLE)
    text = " ".join(result.explanation)
    assert "david" in text
    assert "cube" not in text


@pytest.fixture
def line() -> Line:
    return Line({"ball": 0.5, "cube": 2.5}, {"right": (10.0, 20.0)})


@pytest.mark.parametrize("rejects", [False, True])
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_no_grasp_exists(algorithm: str, rejects: bool, line: Line) -> None:
    def sample_grasp(block: str, call: Call) -> Iterator[float | Rejection]:
        if block == "cube":
            yield 0.1
        elif rejects:
            yield Rejection("too wide for the hand")

    def sample_pose(block: str, region: str, call: Call) -> Iterator[float]:
        yield 11.0

    problem = line.problem(
        "(and (on cube right) (on ball right))", sample_grasp=sample_grasp, sample_pose=sample_pose
    )
    result = fails(algorithm, problem, Outcome.INFEASIBLE)
    text = " ".join(result.explanation)
    assert "ball" in text
    assert not rejects or "too wide for the hand" in text


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_start_is_out_of_reach(algorithm: str) -> None:
    """One grasp, no conf for it at the start pose: all there is was tried."""
    line = Line({"ball": 500.0, "cube": 2.5}, {"right": (10.0, 20.0)}, reach=(-1.0, 100.0))

    def sample_grasp(block: str, call: Call) -> Iterator[float]:
        yield 0.0

    def inverse_kin(
        block: str, pose: float, grasp: float, call: Call
    ) -> Iterator[float | Rejection]:
        yield pose if pose < 100.0 else Rejection("out of reach")

    def sample_pose(block: str, region: str, call: Call) -> Iterator[float]:
        yield 11.0 if block == "ball" else 13.0

    problem = line.problem(
        "(and (on cube right) (on ball right))",
        sample_grasp=sample_grasp,
        inverse_kin=inverse_kin,
        sample_pose=sample_pose,
    )
    result = fails(algorithm, problem, *NO_PLAN)
    text = " ".join(result.explanation)
    assert "ball" in text and "out of reach" in text


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_endless_grasps_and_start_out_of_reach(algorithm: str) -> None:
    """Not to be proven, as ever new grasps might do: given up, with the reason, or out of time."""
    line = Line({"ball": 500.0}, {"right": (10.0, 20.0)}, reach=(-1.0, 100.0))
    result = solve(algorithm, line.problem("(on ball right)"), seconds=2.0)
    assert result.outcome in (Outcome.EXHAUSTED, Outcome.TIMEOUT)
    if algorithm == "adaptive":
        text = " ".join(result.explanation)
        assert "ball" in text and "out of reach" in text


GATE = """
(define (domain gate)
  (:requirements :typing)
  (:types thing)
  (:predicates (small ?x - thing) (inside ?x - thing))
  (:action push :parameters (?x - thing) :precondition (small ?x) :effect (inside ?x)))
"""
GATE_STREAMS = """
(define (stream gate)
  (:stream test-small :inputs (?x) :domain (thing ?x) :certified (small ?x)))
"""


@pytest.mark.parametrize("wide", [False, Rejection("wider than the gate")])
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_false_test_of_a_real_object(algorithm: str, wide: bool | Rejection) -> None:
    problem = stream_task(
        GATE,
        GATE_STREAMS,
        {"test-small": lambda thing, call: wide if thing == "whale" else True},
        {"whale": ("thing",), "fish": ("thing",)},
        "",
        "(and (inside whale) (inside fish))",
    )
    result = fails(algorithm, problem, Outcome.INFEASIBLE)
    text = " ".join(result.explanation)
    assert "whale" in text and "fish" not in text
    assert wide is False or "wider than the gate" in text


@pytest.mark.parametrize("count", [1, 3, 12])
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_finite_stream_is_used_up(algorithm: str, count: int, line: Line) -> None:
    """All poses there are hit a block that cannot be moved."""
    line = Line({"ball": 0.5, "cube": 11.0}, {"right": (10.0, 12.0)})

    def sample_pose(block: str, region: str, call: Call) -> Iterator[float]:
        if block == "ball":
            yield from (10.5 + i / count for i in range(count))

    def sample_grasp(block: str, call: Call) -> Iterator[float]:
        if block == "ball":
            yield 0.0

    problem = line.problem("(on ball right)", sample_pose=sample_pose, sample_grasp=sample_grasp)
    result = fails(algorithm, problem, *NO_PLAN)
    assert "ball" in " ".join(result.explanation)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_finite_streams_whose_values_do_not_go_together(algorithm: str, line: Line) -> None:
    def sample_pose(block: str, region: str, call: Call) -> Iterator[float]:
        yield from (11.0, 13.0, 15.0)

    def sample_grasp(block: str, call: Call) -> Iterator[float]:
        yield from (-0.2, 0.0, 0.2)

    def inverse_kin(
        block: str, pose: float, grasp: float, call: Call
    ) -> Iterator[float | Rejection]:
        if pose < 5.0:
            yield pose + grasp
        else:
            yield Rejection("elbow up")

    problem = line.problem(
        "(on ball right)",
        sample_pose=sample_pose,
        sample_grasp=sample_grasp,
        inverse_kin=inverse_kin,
    )
    result = fails(algorithm, problem, *NO_PLAN)
    assert "ball" in " ".join(result.explanation)


CHAIN = """
(define (domain chain)
  (:requirements :typing)
  (:types link)
  (:predicates (first ?x - link) (second ?x ?y - link) (third ?y ?z - link) (done))
  (:action finish :parameters (?y ?z - link) :precondition (third ?y ?z) :effect (done)))
"""
CHAIN_STREAMS = """
(define (stream chain)
  (:stream to-second :inputs (?x) :domain (first ?x) :outputs (?y) :certified (second ?x ?y))
  (:stream to-third :inputs (?x ?y) :domain (second ?x ?y) :outputs (?z) :certified (third ?y ?z)))
"""


@pytest.mark.parametrize("good", ["a", "b", "c", "d"])
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_what_failed_is_not_mixed_up_with_what_may_work(algorithm: str, good: str) -> None:
    """Plans that only differ in their placeholders: those of a call found dead are not taken for those of another."""

    def to_second(x: str, call: Call) -> Iterator[str]:
        if x == good:
            yield f"from {x}"

    def to_third(x: str, y: str, call: Call) -> Iterator[str]:
        yield "third"

    problem = stream_task(
        CHAIN,
        CHAIN_STREAMS,
        {"to-second": to_second, "to-third": to_third},
        {name: ("link",) for name in "abcd"},
        "(first a) (first b) (first c) (first d)",
        "(done)",
    )
    result = solve(algorithm, problem, seconds=2.0)
    replay(problem, result)
    assert result.objects.values[result.actions[0].arguments[0]] == f"from {good}"
