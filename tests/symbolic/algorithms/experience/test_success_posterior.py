"""A stream's posterior of earlier runs: Beta(1, 1) and what was counted since."""

from __future__ import annotations

import math

import pytest

from tamp.symbolic.algorithms.experience.success_posterior import Posterior


@pytest.mark.parametrize(
    ("successes", "failures", "mean"),
    [(0, 0, 0.5), (1, 0, 2 / 3), (0, 1, 1 / 3), (8, 0, 0.9), (3, 5, 0.4)],
)
def test_the_mean_is_laplaces_rule(successes: int, failures: int, mean: float) -> None:
    assert Posterior(successes, failures).mean == pytest.approx(mean)


@pytest.mark.parametrize(("successes", "failures"), [(1, 0), (1, 4), (3, 2), (10, 30)])
def test_expected_failures_are_the_mean_of_one_over_p_less_one(
    successes: int, failures: int
) -> None:
    """The integral of (1/p - 1) under Beta(s + 1, f + 1), by the midpoint rule."""
    count = 200_000
    points = [(number + 0.5) / count for number in range(count)]
    weights = [p**successes * (1 - p) ** failures for p in points]
    expected = sum(
        weight * (1 / p - 1) for weight, p in zip(weights, points, strict=True)
    ) / math.fsum(weights)
    assert Posterior(successes, failures).expected_failures == pytest.approx(expected, rel=1e-4)


def test_without_a_success_the_integral_has_no_value_and_failures_are_taken() -> None:
    assert Posterior(0, 9).expected_failures == 10.0
    assert Posterior().expected_failures == 1.0


def test_runs_add_up() -> None:
    total = Posterior(1, 2, 0.5) + Posterior(3, 4, 1.5)
    assert total == Posterior(4, 6, 2.0)
    assert Posterior() + total == total
