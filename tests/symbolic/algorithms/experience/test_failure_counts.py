"""What was tried is told by action and stream: what never worked first, then by failures."""

from __future__ import annotations

from collections import Counter

from tamp.stream import Rejection
from tamp.symbolic.algorithms.experience.failure_counts import (
    FailureCount,
    blocking_objects,
    failure_counts,
)
from tests.symbolic.algorithms.binding.shelf import planned

NAMES = {"tea": "tea", "mug": "mug"}


def test_tries_are_counted_for_the_action_that_needs_them() -> None:
    run, skeleton = planned("(put tea)", lambda cup, pose: pose == 3)
    assert run.binder.bind(skeleton, 4, 100) is not None
    rows = {row.stream: row for row in failure_counts([skeleton], run.knowledge.experience, NAMES)}
    tested = rows["test-clear"]
    assert (tested.action, tested.tries, tested.successes, tested.failures) == ("put tea", 3, 1, 2)
    assert not tested.always_failed and sum(tested.reasons.values()) == 2


def test_a_plan_that_comes_again_is_counted_once() -> None:
    run, skeleton = planned("(put tea)", lambda cup, pose: False)
    assert run.binder.bind(skeleton, 4, 100) is None
    once = failure_counts([skeleton], run.knowledge.experience, NAMES)
    assert failure_counts([skeleton, skeleton], run.knowledge.experience, NAMES) == once


def test_what_never_worked_comes_first() -> None:
    run, skeleton = planned("(and (put tea) (put mug))", lambda cup, pose: cup == "tea")
    assert run.binder.bind(skeleton, 4, 100) is None
    rows = failure_counts([skeleton], run.knowledge.experience, NAMES)
    assert rows[0].always_failed and (rows[0].action, rows[0].stream) == ("put mug", "test-clear")
    assert all(not row.always_failed for row in rows[1:])
    assert rows[0].text().startswith("put mug: test-clear never worked in 4 tries: 4 ")


def test_what_states_are_to_blame_for_counts_as_well() -> None:
    run, skeleton = planned("(put tea)")
    fact = skeleton.nodes[1].fact
    run.knowledge.experience.record_nogood(
        fact, frozenset((("at", "mug", "p"),)), Rejection("no way", ("mug",))
    )
    (row,) = failure_counts([skeleton], run.knowledge.experience, NAMES)
    assert (row.tries, row.reasons) == (1, Counter({"no way": 1}))
    assert blocking_objects([row], NAMES) == (("mug", 1),)


def test_things_in_the_way_are_those_of_the_problem_that_were_met() -> None:
    """Words say nothing: only what a rejection names as hit or blocking counts."""
    rows = [
        FailureCount(
            "put tea",
            "plan",
            5,
            0,
            Counter({"too far from tea": 5}),
            Counter({"Mug": 4, "wall": 3}),
        ),
        FailureCount("take mug", "plan", 1, 0, Counter({"hits tea": 1}), Counter({"tea": 1})),
        FailureCount("take tea", "plan", 9, 0, Counter({"hits mug": 9})),
    ]
    assert blocking_objects(rows, {**NAMES, "wall": 3.0}) == (("mug", 4), ("tea", 1))
