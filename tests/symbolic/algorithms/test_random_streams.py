"""Random small stream problems: the algorithms, the adapter and a brute force agree; every plan holds by the book."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from functools import partial

import pytest

from tests.random_streams.making import random_problem
from tests.random_streams.running import Way, compare, run_algorithm, run_anytime, run_pddlstream

SECONDS = 300.0
"""Time of one run: the machine may be busy, and none takes more than two seconds by itself."""

ALGORITHMS: dict[str, Way] = {
    name: partial(run_algorithm, name=name, seconds=SECONDS) for name in ("adaptive", "incremental")
}
ANYTIME: dict[str, Way] = {"anytime": partial(run_anytime, seconds=SECONDS, rounds=6)}
PDDLSTREAM: dict[str, Way] = {
    f"pddlstream {name}": partial(run_pddlstream, algorithm=name, seconds=SECONDS)
    for name in ("adaptive", "incremental")
}


def checked(seeds: Iterable[int], ways: dict[str, Way], pooled: bool | None) -> Counter[object]:
    """How often there is a plan, over the problems of some seeds; none is wrong, missed, or taken for infeasible."""
    seen: Counter[object] = Counter()
    for seed in seeds:
        problem = random_problem(seed)
        if pooled is None or problem.pooled is pooled:
            row = compare(problem, ways)
            assert not row["wrong"], (seed, row["wrong"])
            assert not row["missed"], (seed, row["missed"])
            assert not row["refuted"], (seed, row["refuted"])
            seen[row["solvable"]] += 1
    return seen


@pytest.mark.parametrize("block", range(4))
def test_algorithms_agree_with_brute_force(block: int) -> None:
    seen = checked(range(200 * block, 200 * block + 200), ALGORITHMS, pooled=False)
    assert min(seen[True], seen[False]) >= 15, seen


def test_every_plan_on_the_way_to_a_better_one_holds() -> None:
    seen = checked(range(1000, 1150), ANYTIME, pooled=False)
    assert min(seen[True], seen[False]) >= 15, seen


@pytest.mark.parametrize(
    "seed", [3047, 3089, 3966, 5424, 5458, 5734, 6042, 7376, 8034, 8960, 8970, 9933]
)
def test_problems_that_were_wrong_once(seed: int) -> None:
    """Two calls for one fact, two values of one call, types as facts, equal values, rules in circles."""
    pooled = random_problem(seed).pooled
    checked([seed], PDDLSTREAM if pooled else {**ALGORITHMS, **ANYTIME}, pooled=pooled)


def test_problems_for_pddlstream_whose_values_may_be_equal() -> None:
    seen = checked(range(2000, 2200), PDDLSTREAM, pooled=None)
    assert min(seen[True], seen[False]) >= 15, seen
