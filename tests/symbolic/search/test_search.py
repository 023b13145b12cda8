"""Searches by name: below a limit of the cost or without progress, what A* proves, and goals that nothing reaches."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.parser import parse_domain, parse_task
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.operators import (
    ConditionalEffect,
    Facts,
    Goal,
    InstantiatedTask,
    Operator,
)
from tamp.symbolic.search.search import Reason, search, split_heuristics, unreachable
from tests.planner.pddl_only.texts import SHOP, SHOPPING

TASK = instantiate(parse_task(SHOPPING, parse_domain(SHOP)))
CHEAPEST = 9.0


@pytest.mark.parametrize(
    ("name", "heuristic"), [("wastar", "ff"), ("wastar", "ff+landmarks"), ("astar", "lmcut")]
)
def test_only_plans_below_the_limit_are_found(name: str, heuristic: str) -> None:
    found = search(TASK, search=name, heuristic=heuristic, below=12.0)
    assert found.plan is not None and found.plan.cost < 12.0
    none = search(TASK, search=name, heuristic=heuristic, below=CHEAPEST)
    assert none.plan is None and none.reason is Reason.UNSOLVABLE


def test_greedy_searches_know_one_way_to_a_state_and_take_no_limit() -> None:
    with pytest.raises(InputError, match="a limit of the cost"):
        search(TASK, search="greedy", below=12.0)


def test_a_search_without_progress_is_given_up() -> None:
    """The limit is one of states since the last new low of an estimate, not of all states."""
    found = search(TASK, search="wastar", heuristic="ff")
    assert found.expanded > 2 and found.estimate > 0.0
    given_up = search(TASK, search="wastar", heuristic="blind", endurance=2)
    assert given_up.plan is None and given_up.reason is Reason.LIMIT
    assert given_up.expanded < search(TASK, search="wastar", heuristic="blind").expanded
    assert search(TASK, search="greedy", heuristic="blind", endurance=2).plan is not None


def test_astar_says_what_no_plan_costs_less_than() -> None:
    assert search(TASK, search="astar", heuristic="lmcut").bound == CHEAPEST
    assert 0.0 < search(TASK, search="astar", heuristic="lmcut", limit=1).bound <= CHEAPEST
    assert search(TASK, search="astar", heuristic="lmcut", below=CHEAPEST).bound == CHEAPEST
    assert search(TASK, search="astar", heuristic="ff").bound == 0.0  # it may say too much
    assert math.isfinite(search(TASK, search="astar", heuristic="blind").bound)


def test_an_unknown_heuristic_among_several_is_refused() -> None:
    with pytest.raises(InputError, match=r"unknown heuristic 'landmark'.*Did you mean 'landmarks'"):
        search(TASK, search="greedy", heuristic="ff+landmark")
    assert split_heuristics("ff+landmarks+ff") == ("ff", "landmarks")


def test_an_unknown_search_is_refused() -> None:
    with pytest.raises(InputError, match=r"unknown search 'wastr'.*Did you mean 'wastar'"):
        search(TASK, search="wastr")


def facts(names: str) -> Facts:
    return frozenset((name,) for name in names)


def test_what_nothing_reaches_is_no_goal_and_no_state_is_looked_at() -> None:
    goal = replace(TASK, goal=Goal(TASK.goal.positive | facts("h")))
    found = search(goal)
    assert found.reason is Reason.UNSOLVABLE and found.bound == math.inf
    assert (found.expanded, found.evaluated) == (0, 0)


def test_unreachable_are_goals_that_nothing_gives_or_takes_away() -> None:
    """Said first what is not reached, then what stays; e is not there from the beginning."""
    gone = ConditionalEffect(facts("a"), facts(""), facts(""), facts("c"))
    way = Operator("o", (), facts("a"), facts(""), facts("g"), facts("b"), conditional=(gone,))

    def told(positive: str, negative: str) -> tuple[Fact, ...]:
        goal = Goal(facts(positive), facts(negative))
        return unreachable(InstantiatedTask(facts("abcd"), goal, (way,), (), facts("abcdg"), {}))

    assert told("ag", "bc") == ()
    assert told("zhga", "bcde") == (("h",), ("z",), ("not", "d"))
