"""What was tried is told by action and stream: what never worked first, then by failures."""

from __future__ import annotations

from collections import Counter

from tamp.symbolic.algorithms.experience.failure_counts import Tally, in_the_way, tallies
from tests.symbolic.algorithms.binding.shelf import planned

NAMES = {"tea": "tea", "mug": "mug"}


def test_tries_are_counted_for_the_action_that_needs_them() -> None:
    run, skeleton = planned("(put tea)", lambda cup, pose: pose == 3)
    assert run.binder.bind(skeleton, 4, 100) is not None
    rows = {row.stream: row for row in tallies([skeleton], run.experience, NAMES)}
    tested = rows["test-clear"]
    assert (tested.action, tested.tries, tested.successes, tested.failures) == ("put tea", 3, 1, 2)
    assert not tested.never and sum(tested.reasons.values()) == 2


def test_a_plan_that_comes_again_is_counted_once() -> None:
    run, skeleton = planned("(put tea)", lambda cup, pose: False)
    assert run.binder.bind(skeleton, 4, 100) is None
    once = tallies([skeleton], run.experience, NAMES)
    assert tallies([skeleton, skeleton], run.experience, NAMES) == once


def test_what_never_worked_comes_first() -> None:
    run, skeleton = planned("(and (put tea) (put mug))", lambda cup, pose: cup == "tea")
    assert run.binder.bind(skeleton, 4, 100) is None
    rows = tallies([skeleton], run.experience, NAMES)
    assert rows[0].never and (rows[0].action, rows[0].stream) == ("put mug", "test-clear")
    assert all(not row.never for row in rows[1:])
    assert rows[0].text().startswith("put mug: test-clear never worked in 4 tries: 4 ")


def test_what_states_are_to_blame_for_counts_as_well() -> None:
    run, skeleton = planned("(put tea)")
    fact = skeleton.nodes[1].fact
    run.experience.note_nogood(fact, frozenset((("at", "mug", "p"),)), "blocked by mug")
    (row,) = tallies([skeleton], run.experience, NAMES)
    assert (row.tries, row.reasons) == (1, Counter({"blocked by mug": 1}))


def test_things_in_the_way_are_those_of_the_problem() -> None:
    rows = [
        Tally("put tea", "plan", 5, 0, Counter({"hits Mug, wall": 3, "blocked by mug": 1, "too far from tea": 1})),
        Tally("take mug", "plan", 1, 0, Counter({"hits tea": 1})),
    ]
    assert in_the_way(rows, {**NAMES, "wall": 3.0}) == (("mug", 4), ("tea", 1))
