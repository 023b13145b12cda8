"""Searches avoid what failed as its price says, fall back on any plan, and bound costs from below."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from tamp.stream import Rejection
from tamp.symbolic.algorithms import priced_search as module
from tamp.symbolic.algorithms.experience.stream_statistics import PRICE_PER_FAILURE, Experience
from tamp.symbolic.algorithms.experience.success_posterior import Posterior
from tamp.symbolic.algorithms.optimistic.optimistic_facts import OptimisticFacts
from tamp.symbolic.algorithms.optimistic.optimistic_task import OptimisticTask
from tamp.symbolic.algorithms.priced_search import (
    PricedPlan,
    exclude_each_other,
    lower_bound,
    mean_action_cost,
    priced_search,
)
from tamp.symbolic.algorithms.result import SearchStatistics
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.operators import Goal, InstantiatedTask, Operator
from tamp.system.deadline import Deadline
from tests.symbolic.algorithms.binding.shelf import planned

NONE: frozenset[Fact] = frozenset()
BRIDGE: Fact = ("firm", "bridge")
FERRY: Fact = ("runs", "ferry")
OVER: Fact = ("over",)


def crossing(*, ferry: float = 1.5, bridge: float = 1.0) -> OptimisticTask:
    """Two ways over a river, each resting on a fact of its own."""
    operators = (
        Operator("cross", (), NONE, NONE, frozenset({OVER}), NONE, bridge, frozenset({BRIDGE})),
        Operator("sail", (), NONE, NONE, frozenset({OVER}), NONE, ferry, frozenset({FERRY})),
    )
    task = InstantiatedTask(NONE, Goal(frozenset({OVER})), operators, (), frozenset({OVER}), {})
    return OptimisticTask(OptimisticFacts(), task)


def names(found: PricedPlan | None) -> list[str] | None:
    return None if found is None else [operator.name for operator in found.plan.operators]


def searched(
    task: OptimisticTask,
    experience: Experience | None = None,
    *,
    posteriors: Mapping[str, Posterior] | None = None,
    below: float = float("inf"),
    brief: bool = False,
    effort: SearchStatistics | None = None,
) -> PricedPlan | None:
    return priced_search(
        task,
        experience or Experience(),
        posteriors or {},
        Deadline(),
        lambda: False,
        effort or SearchStatistics(),
        below=below,
        brief=brief,
    )


def failed(fact: Fact, times: int) -> Experience:
    experience = Experience()
    for _ in range(times):
        experience.record(fact, Rejection("no"))
    return experience


def test_without_experience_the_cheapest_way_is_taken() -> None:
    assert names(searched(crossing())) == ["cross"]
    assert names(searched(crossing(ferry=0.5))) == ["sail"]


@pytest.mark.parametrize("failures", range(5))
def test_failures_outweigh_cost_by_their_price(failures: int) -> None:
    """A crossing costs 1 and its price, sailing 1.4; the mean cost, 1.2, is the unit of prices."""
    found = searched(crossing(ferry=1.4), failed(BRIDGE, failures))
    assert found is not None
    price = 1.2 * PRICE_PER_FAILURE * failures
    assert names(found) == (["cross"] if 1.0 + price < 1.4 else ["sail"])
    assert found.prices.get(BRIDGE, 0.0) == pytest.approx(price)


def test_prices_are_in_units_of_the_mean_cost_only_where_that_exceeds_one() -> None:
    cheap = searched(crossing(ferry=0.5, bridge=0.5), failed(BRIDGE, 1))
    dear = searched(crossing(ferry=30.0, bridge=10.0), failed(BRIDGE, 1))
    assert cheap is not None and dear is not None
    assert cheap.prices[BRIDGE] == pytest.approx(PRICE_PER_FAILURE)
    assert dear.prices[BRIDGE] == pytest.approx(20.0 * PRICE_PER_FAILURE)


def test_a_success_takes_the_price_off() -> None:
    experience = failed(BRIDGE, 1)
    experience.record(BRIDGE, None)
    experience.record(BRIDGE, None)
    assert names(searched(crossing(), experience)) == ["cross"]


def test_a_bound_of_the_cost_may_leave_no_plan() -> None:
    assert names(searched(crossing(), below=1.25)) == ["cross"]
    assert searched(crossing(), below=1.0) is None
    assert searched(crossing(), below=0.5) is None


def test_the_goal_out_of_reach_is_no_plan() -> None:
    task = crossing().instantiated
    nowhere = InstantiatedTask(NONE, task.goal, (), (), NONE, {})
    assert searched(OptimisticTask(OptimisticFacts(), nowhere)) is None


def counters(count: int) -> OptimisticTask:
    """A lock of switches, each usable once the ones before it are on: the blind way is long."""
    switches: list[Fact] = [("on", f"s{number}") for number in range(count)]
    operators: list[Operator] = []
    for number, switch in enumerate(switches):
        before = frozenset(switches[max(0, number - 1) : number])
        off = frozenset(switches[: max(0, number - 1)])
        operators.append(
            Operator("up", switch[1:], before, frozenset({switch}) | off, frozenset({switch}), NONE)
        )
        operators.append(
            Operator("down", switch[1:], before | {switch}, off, NONE, frozenset({switch}))
        )
    goal = Goal(frozenset({switches[-1]}), frozenset(switches[:-1]))
    task = InstantiatedTask(NONE, goal, tuple(operators), (), frozenset(switches), {})
    return OptimisticTask(OptimisticFacts(), task)


def test_a_long_search_for_a_cheap_plan_is_followed_by_one_for_any(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Chinese rings: the plan of eight rings goes through 256 states."""
    monkeypatch.setattr(module, "SEARCH_LIMIT", 100)
    effort = SearchStatistics()
    found = searched(counters(8), effort=effort)
    assert found is not None and len(found.plan.operators) >= 255
    assert effort.expanded > 300
    brief = SearchStatistics()
    assert searched(counters(8), brief=True, effort=brief) is None
    assert brief.expanded <= 101
    assert searched(counters(8), below=1e9) is None, "with a bound there is one try"


def test_short_locks_are_opened_at_once() -> None:
    effort = SearchStatistics()
    found = searched(counters(4), brief=True, effort=effort)
    assert found is not None and len(found.plan.operators) >= 15
    assert 0 < effort.expanded <= 16


def test_the_lower_bound_is_one_and_means_nothing_where_instances_are_missing() -> None:
    task = crossing()
    assert lower_bound(task, 30, Deadline()) == pytest.approx(1.0)
    assert lower_bound(crossing(ferry=0.25), 30, Deadline()) == pytest.approx(0.25)
    incomplete = OptimisticTask(OptimisticFacts(complete=False), task.instantiated)
    assert lower_bound(incomplete, 30, Deadline()) == 0.0


def test_the_mean_cost_of_no_operators_is_one() -> None:
    assert mean_action_cost(crossing().instantiated) == pytest.approx(1.25)
    assert mean_action_cost(InstantiatedTask(NONE, Goal(NONE), (), (), NONE, {})) == 1.0


def test_goals_that_exclude_each_other() -> None:
    left, right = ("at", "left"), ("at", "right")
    go = [
        Operator(
            "go",
            here[1:] + there[1:],
            frozenset({here}),
            NONE,
            frozenset({there}),
            frozenset({here}),
        )
        for here, there in ((left, right), (right, left))
    ]
    reachable = frozenset({left, right})

    def with_goal(*facts: Fact) -> InstantiatedTask:
        return InstantiatedTask(
            frozenset({left}), Goal(frozenset(facts)), tuple(go), (), reachable, {}
        )

    assert exclude_each_other(with_goal(left, right), Deadline())
    assert not exclude_each_other(with_goal(right), Deadline())


def test_untried_tests_of_placeholders_have_a_price_in_a_run() -> None:
    run, skeleton = planned("(put tea)")
    fact = skeleton.nodes[1].fact
    found = searched(run.optimistic)
    assert found is not None and found.prices[fact] > 0.0
    run.knowledge.experience.record(fact, None)
    again = searched(run.optimistic, run.knowledge.experience)
    assert again is not None and fact not in again.prices
    earlier = searched(run.optimistic, posteriors={"sample-pose": Posterior(0, 3)})
    assert earlier is not None and earlier.prices[skeleton.nodes[0].fact] == pytest.approx(
        4 * PRICE_PER_FAILURE
    )
