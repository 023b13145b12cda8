"""Prices for what is not tried yet."""

from __future__ import annotations

from collections.abc import Mapping

from tamp.symbolic.algorithms.experience.stream_statistics import SCALE, Experience
from tamp.symbolic.algorithms.experience.success_posterior import Posterior
from tamp.symbolic.algorithms.optimistic.optimistic_instantiation import Optimism
from tamp.symbolic.pddl.structs import Fact

UNTRIED = 0.2
"""The price of resting on a test of values that are not drawn yet, in units of an action's cost."""

WORST = 5.0
"""Expected failures that earlier runs can charge for at most: another problem may be kinder."""


def doubts(
    optimism: Optimism, experience: Experience, earlier: Mapping[str, Posterior]
) -> dict[Fact, float]:
    """Price what is not tried yet, as exploration asks.

    For each test of placeholders, since a generator that certifies the same goes first; and for the
    calls of streams that earlier runs know, by the failures to expect.
    """
    known, makers = experience.facts, optimism.makers
    prices = {
        fact: UNTRIED
        for fact, guess in makers.items()
        if guess.stream.is_test
        and guess.level > 1
        and fact[0] not in optimism.assumed
        and fact not in known
    }
    expected = {name: SCALE * min(p.expected_failures, WORST) for name, p in earlier.items()}
    if expected:
        for fact, guess in makers.items():
            if guess.stream.name in expected and fact not in known:
                prices[fact] = prices.get(fact, 0.0) + expected[guess.stream.name]
    return prices
