"""What failures cost, and what is ruled out for good."""

from __future__ import annotations

import pytest

from tamp.stream import Rejection
from tamp.symbolic.algorithms.experience.stream_statistics import (
    PRICE_PER_FAILURE,
    Experience,
    FailureRecord,
)

CLEAR = ("clear", "tea", "p1")
AT = ("at", "mug", "p2")


@pytest.mark.parametrize(
    ("successes", "failures", "expected"),
    [(0, 0, 0.0), (0, 1, 1.0), (0, 3, 3.0), (1, 3, 1.0), (3, 1, 0.0)],
)
def test_failures_to_expect(successes: int, failures: int, expected: float) -> None:
    record = FailureRecord(successes, failures)
    assert record.expected_failures == expected
    assert record.price == pytest.approx(PRICE_PER_FAILURE * expected)


def test_only_what_fails_more_often_than_not_has_a_price() -> None:
    experience = Experience()
    experience.record(CLEAR, Rejection.hits("mug"))
    experience.record(("pose", "tea", "p1"), None)
    assert experience.prices() == {CLEAR: pytest.approx(PRICE_PER_FAILURE)}
    experience.record(CLEAR, None)
    assert experience.prices() == {}
    assert experience.facts[CLEAR].reasons == {"hits mug": 1}
    assert experience.facts[CLEAR].in_the_way == {"mug": 1}


def test_what_the_state_is_to_blame_for_is_no_price_of_the_fact() -> None:
    experience = Experience()
    experience.record_nogood(CLEAR, frozenset((AT,)), Rejection("blocked by mug", ("mug",)))
    experience.record_nogood(CLEAR, frozenset((AT,)), Rejection("blocked by mug", ("mug",)))
    assert experience.prices() == {}
    assert experience.nogoods[CLEAR, frozenset((AT,))].failures == 2
    assert experience.nogoods[CLEAR, frozenset((AT,))].in_the_way == {"mug": 2}


def test_each_call_has_states_of_its_own() -> None:
    experience = Experience()
    first, second = ("plan", ("tea", "p1")), ("plan", ("tea", "p2"))
    experience.record_failing_state(first, ("at",), frozenset((AT,)))
    experience.record_failing_state(first, ("at",), frozenset())
    experience.record_failing_state(second, ("at",), frozenset())
    assert set(experience.failing_states[first][1]) == {frozenset((AT,)), frozenset()}
    assert set(experience.failing_states[second][1]) == {frozenset()}
