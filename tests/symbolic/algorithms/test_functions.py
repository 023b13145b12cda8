"""Stream functions that misbehave: the run goes on with the others, and always ends in time."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

import pytest

from tamp.stream import Call, Rejection
from tamp.symbolic.algorithms.result import Outcome
from tests.clock import unhindered
from tests.symbolic.algorithms.line import Line
from tests.symbolic.algorithms.toys import ALGORITHMS, replay, solve, stream_task


@pytest.fixture
def line() -> Line:
    return Line({"a": 0.5}, {"right": (10.0, 20.0)})


@pytest.mark.parametrize("first", [0, 2])
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_function_that_raises_is_reported_and_others_go_on(
    algorithm: str, first: int, line: Line
) -> None:
    def inverse_kin(block: str, pose: float, grasp: float, call: Call) -> Iterator[float]:
        if pose < 5.0:
            yield pose + grasp
        elif pose < 15.0:
            raise ZeroDivisionError("singular Jacobian")
        yield pose + grasp

    def sample_pose(block: str, region: str, call: Call) -> Iterator[float]:
        yield from (11.0, 12.0, 16.0, 17.0)

    problem = line.problem("(on a right)", inverse_kin=inverse_kin, sample_pose=sample_pose)
    result = solve(algorithm, problem)
    replay(problem, result)
    assert line.replay(result, {"a": "right"})["a"] > 15.0
    assert any("inverse-kin" in text and "singular Jacobian" in text for text in result.warnings)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_test_that_raises_does_not_hold(algorithm: str) -> None:
    line = Line({"a": 0.5, "b": 30.0}, {"right": (10.0, 20.0)})

    def test_clear(block: str, pose: float, other: str, other_pose: float, call: Call) -> bool:
        if pose < 15.0:
            raise KeyError("mesh")
        return True

    problem = line.problem("(on a right)", test_clear=test_clear)
    result = solve(algorithm, problem)
    replay(problem, result)
    assert line.replay(result, {"a": "right"})["a"] > 15.0


PAIR = """
(define (domain pair)
  (:requirements :typing)
  (:types left right)
  (:predicates (pair ?x - left ?y - right) (done))
  (:action join :parameters (?x - left ?y - right) :precondition (pair ?x ?y) :effect (done)))
"""


@pytest.mark.parametrize("wrong", [(1, 2, 3), (1,), 7, None, "ab", "abc"], ids=repr)
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_wrong_number_of_outputs_is_reported(algorithm: str, wrong: object) -> None:
    """One bad function does not end the run with a traceback, and its value is not used."""
    streams = """
    (define (stream pair)
      (:stream bad :outputs (?x ?y) :certified (pair ?x ?y))
      (:stream good :outputs (?x ?y) :certified (pair ?x ?y)))
    """

    def bad(call: Call) -> Iterator[object]:
        yield wrong

    def good(call: Call) -> Iterator[tuple[int, int]]:
        yield (1, 2)

    problem = stream_task(PAIR, streams, {"bad": bad, "good": good}, {}, "", "(done)")
    result = solve(algorithm, problem)
    if wrong == "ab":  # a string of the right length: two values for all we know
        assert result.outcome is Outcome.SOLVED
        return
    replay(problem, result)
    assert [result.objects.values[name] for name in result.actions[0].arguments] == [1, 2]
    assert any("bad" in text for text in result.warnings)


@pytest.mark.parametrize("value", [None, 3.0, "text"], ids=repr)
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_function_that_is_no_generator_is_reported(
    algorithm: str, value: object, line: Line
) -> None:
    problem = line.problem("(on a right)", sample_grasp=lambda block, call: value)
    result = solve(algorithm, problem, seconds=1.0)
    assert result.outcome is not Outcome.SOLVED or value == "text"


def spins(block: str, call: Call) -> Iterator[float]:
    while True:
        pass
    yield 0.0


def sleeps(block: str, call: Call) -> Iterator[float]:
    while True:
        time.sleep(1.0)
    yield 0.0


def stubborn(block: str, call: Call) -> Iterator[float]:
    while True:
        try:
            time.sleep(1.0)
        except Exception:
            continue
    yield 0.0


@pytest.mark.parametrize("function", [spins, sleeps, stubborn])
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_function_without_end_is_interrupted(
    algorithm: str, function: Callable[..., object], line: Line
) -> None:
    started = unhindered()
    result = solve(algorithm, line.problem("(on a right)", sample_grasp=function), seconds=0.5)
    assert unhindered() - started <= 1.0
    assert result.outcome is Outcome.TIMEOUT
    assert result.explanation


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_generator_of_rejections_ends_in_time(algorithm: str, line: Line) -> None:
    def sample_grasp(block: str, call: Call) -> Iterator[Rejection]:
        while True:
            yield Rejection("no antipodal points")

    started = unhindered()
    result = solve(algorithm, line.problem("(on a right)", sample_grasp=sample_grasp), seconds=1.0)
    assert unhindered() - started <= 1.5
    assert result.outcome in (Outcome.EXHAUSTED, Outcome.TIMEOUT)
    if algorithm == "adaptive":
        assert "no antipodal points" in " ".join(result.explanation)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_interrupt_is_an_outcome(algorithm: str, line: Line) -> None:
    def sample_grasp(block: str, call: Call) -> Iterator[float]:
        raise KeyboardInterrupt
        yield 0.0

    result = solve(algorithm, line.problem("(on a right)", sample_grasp=sample_grasp))
    assert result.outcome is Outcome.INTERRUPTED
