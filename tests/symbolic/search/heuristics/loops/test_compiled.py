"""The heuristics' inner loops: compiled they give what plain Python gives, and one search may begin with the other."""

from __future__ import annotations

import math
from random import Random

import pytest

from benchmarks.search import cupboard
from tamp.symbolic.search.heuristics import relaxation
from tamp.symbolic.search.heuristics.loops import selection as tiers
from tamp.symbolic.search.heuristics.loops.compiled import COMPILED
from tamp.symbolic.search.heuristics.loops.interface import Kernels
from tamp.symbolic.search.heuristics.registry import HEURISTICS
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.operators import InstantiatedTask
from tamp.symbolic.search.search import search
from tamp.symbolic.search.successors import Successors
from tests.symbolic.search.test_prices import random_prices
from tests.symbolic.search.test_random_tasks import random_task


def walk(instantiated: InstantiatedTask, rng: Random) -> list[float | tuple[int, ...]]:
    """What all heuristics say along a random walk, under random prices."""
    successors = Successors(
        instantiated,
        random_prices(rng, frozenset().union(*(o.static for o in instantiated.operators))),
    )
    said: list[float | tuple[int, ...]] = []
    heuristics = [HEURISTICS[name](successors) for name in ("ff", "hadd", "hmax", "lmcut")]
    state = successors.initial
    for _ in range(8):
        closed = successors.closure(state)
        for heuristic in heuristics:
            estimate = heuristic(closed)
            said += [estimate.value, estimate.plan]
        choices = [
            i for i in successors.applicable(closed) if successors.step_cost(i, closed) < math.inf
        ]
        if not choices:
            break
        state = successors.apply(rng.choice(choices), state, closed)
    return said


@pytest.mark.parametrize("seed", range(40))
def test_all_ways_say_the_same(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    instantiated = instantiate(random_task(Random(seed)))
    stories: list[list[float | tuple[int, ...]]] = []
    for turns in ([tiers.PLAIN], [COMPILED], [tiers.PLAIN, COMPILED]):
        asked = [0]

        def choose(entries: int, turns: list[Kernels] = turns, asked: list[int] = asked) -> Kernels:
            asked[0] += 1
            return turns[asked[0] // 3 % len(turns)]

        monkeypatch.setattr(relaxation, "choose", choose)
        stories.append(walk(instantiated, Random(seed)))
    assert stories[0] == stories[1] == stories[2]


def test_a_search_ends_alike_whichever_loops_it_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    found: list[tuple[object, ...]] = []
    for loops in (tiers.PLAIN, COMPILED):
        monkeypatch.setattr(relaxation, "choose", lambda entries, loops=loops: loops)
        result = search(instantiate(*cupboard(3)))
        assert result.plan is not None
        found.append(
            (
                [(o.name, o.arguments) for o in result.plan.operators],
                result.plan.cost,
                result.evaluated,
            )
        )
    assert found[0] == found[1]
