"""How much work a skeleton gets before the next search."""

from __future__ import annotations

from collections.abc import Iterator

from tamp.stream import Call, Rejection
from tamp.symbolic.algorithms.adaptive import ROUND_DRAWS
from tests.symbolic.algorithms.toys import replay, solve, stream_task

DOMAIN = """
(define (domain chores)
  (:requirements :typing)
  (:types chore tool)
  (:predicates (tool ?c - chore ?t - tool) (fits ?c - chore ?t - tool) (done ?c - chore))
  (:action do :parameters (?c - chore ?t - tool) :precondition (fits ?c ?t) :effect (done ?c)))
"""

STREAMS = """
(define (stream chores)
  (:stream draw-tool :inputs (?c) :domain (chore ?c) :outputs (?t) :certified (tool ?c ?t))
  (:stream test-fits :inputs (?c ?t) :domain (tool ?c ?t) :certified (fits ?c ?t)))
"""


def test_a_long_skeleton_is_gone_through_once_before_the_next_search() -> None:
    count = ROUND_DRAWS // 2 + 10  # each chore has two nodes
    tested = 0

    def draw_tool(chore: str, call: Call) -> Iterator[float]:
        while True:
            yield call.rng.random()

    def test_fits(chore: str, tool: float, call: Call) -> bool | Rejection:
        nonlocal tested
        tested += 1
        return True if tested != count else Rejection("too small")

    chores = {f"c{i}": ("chore",) for i in range(count)}
    goal = "(and " + " ".join(f"(done {name})" for name in chores) + ")"
    functions = {"draw-tool": draw_tool, "test-fits": test_fits}
    problem = stream_task(DOMAIN, STREAMS, functions, chores, "", goal)
    result = solve("adaptive", problem, seconds=60.0)
    replay(problem, result)
    assert tested == count + 1 and result.effort.searches == 1
