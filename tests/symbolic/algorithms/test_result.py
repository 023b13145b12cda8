"""What a run gives back: the objects that a user knows, the time that was spent, and why there is no plan."""

from __future__ import annotations

import pytest

from tamp.symbolic.algorithms.bound_stream import Objects
from tamp.symbolic.algorithms.cause import Cause, CauseKind
from tamp.symbolic.algorithms.result import Outcome, Result, SearchStatistics
from tests.symbolic.algorithms.toys import stream_task


def test_only_objects_of_the_task_that_are_their_own_names_are_known_to_a_user() -> None:
    """p0 is a pose, whose value says nothing; #g1 is a stream's."""
    problem = stream_task(
        "(define (domain d) (:constants depot) (:predicates (at ?x ?p)) (:action a :effect ()))",
        "(define (stream none))", {}, {"mug": ("object",), "p0": ("object",)}, "", "(and)",
        {"p0": (0.0, 1.0)},
    )  # fmt: skip
    assert problem.named(["p0", "mug", "#g1", "depot", "mug"]) == ("mug", "depot")


@pytest.mark.parametrize("fails", [False, True])
def test_time_counts_where_it_is_spent_also_when_it_ends_in_an_error(fails: bool) -> None:
    effort = SearchStatistics()
    for spending in (effort.searching, effort.explaining, effort.searching):
        try:
            with spending():
                sum(range(10_000))
                if fails:
                    raise KeyboardInterrupt
        except KeyboardInterrupt:
            assert fails
    assert effort.search_seconds > 0.0 and effort.explaining_seconds > 0.0
    once = effort.search_seconds
    with effort.searching():
        sum(range(10_000))
    assert effort.search_seconds > once


def test_causes_are_explained_in_their_order_and_nothing_was_tried_unless_it_is_said() -> None:
    causes = tuple(Cause(text, CauseKind.REFUTED) for text in ("too heavy", "too wide"))
    result = Result(Outcome.INFEASIBLE, Objects({}, {}), causes=causes)
    assert result.explanation == ("too heavy", "too wide")
    assert result.attempts() == () and result.actions == ()
    assert result.effort is not Result(Outcome.INFEASIBLE, Objects({}, {})).effort
