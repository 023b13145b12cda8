"""Exploration prices: optimistic prior costs of what is not tried yet."""

from __future__ import annotations

from collections.abc import Mapping

from tamp.symbolic.algorithms.experience.stream_statistics import PRICE_PER_FAILURE, Experience
from tamp.symbolic.algorithms.experience.success_posterior import Posterior
from tamp.symbolic.algorithms.optimistic.optimistic_facts import OptimisticFacts
from tamp.symbolic.pddl.structs import Fact

UNTRIED_TEST_PRICE = 0.2
"""The price of resting on a test of values that are not drawn yet, in units of an action's cost."""

MAX_EXPECTED_FAILURES = 5.0
"""Expected failures that earlier runs can charge for at most: another problem may be kinder."""


def exploration_prices(
    optimistic: OptimisticFacts, experience: Experience, earlier: Mapping[str, Posterior]
) -> dict[Fact, float]:
    """Price what is not tried yet, as exploration asks.

    For each test of placeholders, since a generator that certifies the same goes first; and for the
    calls of streams that earlier runs know, by the failures to expect.
    """
    tried, producers = experience.facts, optimistic.producers
    prices = {
        fact: UNTRIED_TEST_PRICE
        for fact, instance in producers.items()
        if instance.stream.is_test
        and instance.depth > 1
        and fact[0] not in optimistic.lazily_tested
        and fact not in tried
    }
    expected = {
        name: PRICE_PER_FAILURE * min(p.expected_failures, MAX_EXPECTED_FAILURES)
        for name, p in earlier.items()
    }
    if expected:
        for fact, instance in producers.items():
            if instance.stream.name in expected and fact not in tried:
                prices[fact] = prices.get(fact, 0.0) + expected[instance.stream.name]
    return prices
