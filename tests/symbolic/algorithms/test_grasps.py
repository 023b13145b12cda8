"""Which variables of a plan are one: the grasp of a pick and of its place, and not those of two picks."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tamp.stream import Call, Rejection
from tests.symbolic.algorithms.line import DOMAIN, Line
from tests.symbolic.algorithms.toys import ALGORITHMS, replay, solve

KITCHEN = DOMAIN.replace(
    "(hand-free)", "(hand-free) (hot ?r - region) (cooked ?b - block) (away ?q - conf)", 1
).replace(
    "  (:action move",
    """  (:action cook
    :parameters (?b - block ?p - pose ?r - region ?q - conf)
    :precondition (and (at ?b ?p) (supported ?b ?p ?r) (hot ?r) (at-conf ?q) (away ?q))
    :effect (cooked ?b))
  (:action move""",
)


@pytest.fixture
def line() -> Line:
    return Line({"a": 0.5}, {"stove": (10.0, 12.0), "table": (20.0, 22.0)})


def picky(block: str, pose: float, grasp: float, call: Call) -> Iterator[float | Rejection]:
    """The start wants a low grasp, the table a high one, the stove any."""
    if (pose < 5.0 and grasp > -0.1) or (pose > 15.0 and grasp < 0.1):
        yield Rejection("out of reach")
    else:
        yield pose + grasp


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_two_picks_of_one_object_take_different_grasps(
    algorithm: str, seed: int, line: Line
) -> None:
    problem = line.problem(
        "(and (cooked a) (on a table))",
        domain=KITCHEN,
        facts="(hot stove) (away home)",
        inverse_kin=picky,
    )
    result = solve(algorithm, problem, seed=seed)
    replay(problem, result)
    line.replay(result, {"a": "table"})
    grasps = [
        result.objects.values[x.arguments[2]] for x in result.actions if x.name in ("pick", "place")
    ]
    assert len(grasps) == 4
    assert grasps[0] == grasps[1] < -0.1 < 0.1 < grasps[2] == grasps[3]


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_an_object_is_put_down_to_be_grasped_anew(algorithm: str, line: Line) -> None:
    """Nothing in the symbols asks for the stop on the stove; only the grasps do."""
    problem = line.problem("(on a table)", inverse_kin=picky)
    result = solve(algorithm, problem)
    replay(problem, result)
    line.replay(result, {"a": "table"})
    assert [action.name for action in result.actions if action.name != "move"] == [
        "pick",
        "place",
    ] * 2
