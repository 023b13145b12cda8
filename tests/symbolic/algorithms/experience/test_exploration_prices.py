"""What is not tried yet costs a little, and what failed in earlier runs more."""

from __future__ import annotations

import pytest

from tamp.symbolic.algorithms.experience.exploration_prices import (
    MAX_EXPECTED_FAILURES,
    UNTRIED_TEST_PRICE,
    exploration_prices,
)
from tamp.symbolic.algorithms.experience.stream_statistics import PRICE_PER_FAILURE, Experience
from tamp.symbolic.algorithms.experience.success_posterior import Posterior
from tests.symbolic.algorithms.binding.shelf import planned

DRAWN = ("pose", "tea", "#p1")
TESTED = ("clear", "tea", "#p1")


def test_a_test_of_what_is_not_drawn_costs_a_little() -> None:
    run, _ = planned("(put tea)", cups="tea")
    assert exploration_prices(run.optimistic.facts, Experience(), {}) == {
        TESTED: UNTRIED_TEST_PRICE
    }


def test_what_was_tried_is_priced_by_what_came_of_it() -> None:
    run, _ = planned("(put tea)", cups="tea")
    experience = Experience()
    experience.record(TESTED, None)
    assert exploration_prices(run.optimistic.facts, experience, {}) == {}


@pytest.mark.parametrize(
    ("failures", "expected"), [(0, 1.0), (3, 4.0), (1000, MAX_EXPECTED_FAILURES)]
)
def test_earlier_runs_charge_for_failures_up_to_a_limit(failures: int, expected: float) -> None:
    run, _ = planned("(put tea)", cups="tea")
    prices = exploration_prices(
        run.optimistic.facts, Experience(), {"sample-pose": Posterior(1, failures)}
    )
    assert prices == {
        DRAWN: pytest.approx(PRICE_PER_FAILURE * expected),
        TESTED: UNTRIED_TEST_PRICE,
    }
    prices = exploration_prices(
        run.optimistic.facts, Experience(), {"test-clear": Posterior(1, failures)}
    )
    assert prices == {TESTED: pytest.approx(UNTRIED_TEST_PRICE + PRICE_PER_FAILURE * expected)}
