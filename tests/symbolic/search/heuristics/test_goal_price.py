"""The price of the goal's derivation, against the cheapest of all derivations written out."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from random import Random

import pytest

from tamp.symbolic.search.heuristics.goal_price import GoalPrice
from tamp.symbolic.search.operators import Axiom, InstantiatedTask
from tamp.symbolic.search.successors import Successors
from tests.symbolic.search.packed.room import axiom, facts, operator, task


def rule(head: str, needed: str, static: str = "", absent: str = "", stratum: int = 0) -> Axiom:
    return replace(axiom(head, needed, absent, stratum), static=facts(static))


def made(axioms: list[Axiom], goal: str, initial: str = "") -> InstantiatedTask:
    return task([operator("all", "", "a b c d")], goal, initial, axioms)


def price(task: InstantiatedTask, prices: dict[str, float], state: str) -> float:
    s = Successors(task, {(name,): value for name, value in prices.items()})
    return GoalPrice(s)(s.mask(facts(state)))


def test_the_cheapest_of_several_derivations_counts() -> None:
    rules = [rule("g", "a", "x"), rule("g", "b", "y")]
    prices = {"x": 5.0, "y": 2.0}
    assert price(made(rules, "g"), prices, "a") == 5.0
    assert price(made(rules, "g"), prices, "b") == 2.0
    assert price(made(rules, "g"), prices, "a b") == 2.0


def test_prices_add_up_along_a_derivation_and_over_the_goals_facts() -> None:
    """g from m and n, m and n from a; written such that one pass over the rules is not enough."""
    rules = [rule("g", "m n", "x"), rule("m", "a", "y"), rule("n", "a", "z x")]
    prices = {"x": 1.0, "y": 10.0, "z": 100.0}
    assert price(made(rules, "g"), prices, "a") == 112.0
    assert price(made(rules, "g m"), prices, "a") == 122.0
    assert price(made(rules, "g a"), prices, "a") == 112.0


def test_a_dear_step_that_saves_a_dearer_one() -> None:
    """g directly for 9, or by m for 3 + 4: found though g is reached directly first."""
    rules = [rule("g", "a", "x"), rule("g", "m", "y"), rule("m", "a", "z")]
    assert price(made(rules, "g"), {"x": 9.0, "y": 3.0, "z": 4.0}, "a") == 7.0


def test_a_rule_with_a_negation_is_free_and_what_it_needs_is_not() -> None:
    rules = [rule("g", "m", "x", absent="b", stratum=1), rule("m", "a", "y")]
    assert price(made(rules, "g"), {"x": 5.0, "y": 2.0}, "a") == 2.0


@pytest.mark.parametrize("needed", ["a", "a m"])
def test_a_derivation_that_is_forbidden_is_infinite(needed: str) -> None:
    """Where another is allowed, that one counts."""
    rules = [rule("g", needed, "x"), rule("m", "a"), rule("g", "b", "y")]
    prices = {"x": math.inf, "y": 2.0}
    assert price(made(rules, "g"), prices, "a") == math.inf
    assert price(made(rules, "g"), prices, "a b") == 2.0


def test_nothing_is_asked_where_no_rule_costs_anything() -> None:
    s = Successors(made([rule("g", "a", "x")], "g"), {("other",): 3.0})
    assert GoalPrice(s).is_free
    assert GoalPrice(s)(s.mask(facts("a"))) == 0.0
    assert not GoalPrice(Successors(made([rule("g", "a", "x")], "g"), {("x",): 3.0})).is_free


def cheapest(rules: list[Axiom], prices: dict[str, float], state: str) -> dict[str, float]:
    """What each fact costs most cheaply: more rounds over the rules than there are facts."""
    best = dict.fromkeys(state.split(), 0.0)
    for _ in range(10):
        for one in rules:
            needed = [fact[0] for fact in one.positive]
            if all(name in best for name in needed):
                cost = sum(best[name] for name in needed) + sum(prices[f[0]] for f in one.static)
                best[one.head[0]] = min(cost, best.get(one.head[0], math.inf))
    return best


def test_random_rules_in_circles() -> None:
    """Rules that lead from m, n, o to each other: a circle makes nothing cheaper."""
    reached = 0
    for seed in range(150):
        rng = Random(seed)
        names = "abcmno"
        pairs = list(itertools.combinations(names, 2))
        rules = [
            rule(rng.choice("mnog"), " ".join(rng.choice(pairs)), rng.choice("xyz"))
            for _ in range(7)
        ]
        prices = {"x": 1.0, "y": 2.5, "z": 7.0}
        best = cheapest(rules, prices, "a b")
        if "g" in best:
            reached += 1
            assert price(made(rules, "g"), prices, "a b") == pytest.approx(best["g"])
    assert reached > 10
