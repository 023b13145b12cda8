"""Goals come in the order in which none is reached twice; what is ordered wrongly is caught by brute force."""

from __future__ import annotations

import math
from random import Random

import pytest

from benchmarks.classical_domains import GENERATORS
from tamp.symbolic.pddl.parser import parse_domain
from tamp.symbolic.pddl.tasks import parse_task
from tamp.symbolic.search import goal_agenda as module
from tamp.symbolic.search.expansion import SearchSpace
from tamp.symbolic.search.goal_agenda import goal_agenda, guard_agenda, levels
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.mutex import Mutexes
from tamp.symbolic.search.operators import Guard, Operator
from tamp.symbolic.search.packed.restarts import Way, by_agenda
from tamp.symbolic.search.packed.search import Stalled
from tamp.symbolic.search.successors import State, Successors
from tamp.system.deadline import Deadline
from tests.symbolic.search.interpreter import Interpreter
from tests.symbolic.search.packed.room import axiom, facts, operator, task
from tests.symbolic.search.test_random_tasks import random_task

TOWER = """(define (problem tower) (:domain blocks) (:objects a b c d - block)
 (:init (empty) (on-table a) (clear a) (on-table b) (clear b) (on-table c) (clear c) (on-table d) (clear d))
 (:goal (and (on a b) (on b c) (on c d))))"""


def blocks(problem: str) -> Successors:
    """Number the blocks task."""
    domain = parse_domain(GENERATORS["blocks"](2, Random(0))[0])
    return Successors(instantiate(parse_task(problem, domain)), {})


def named(s: Successors, agenda: list[State]) -> list[set[str]]:
    """The facts of an agenda's sets."""
    return [
        {" ".join(fact) for i, fact in enumerate(s.facts) if goals >> i & 1} for goals in agenda
    ]


def test_a_tower_is_built_from_below() -> None:
    s = blocks(TOWER)
    assert named(s, goal_agenda(s)) == [
        {"on c d"},
        {"on c d", "on b c"},
        {"on c d", "on b c", "on a b"},
    ]


def test_towers_side_by_side_are_built_level_by_level() -> None:
    s = blocks(TOWER.replace("(on b c) ", ""))
    assert named(s, goal_agenda(s)) == [{"on a b", "on c d"}]


def test_goals_without_an_order_come_at_once() -> None:
    domain, problem = GENERATORS["gripper"](4, Random(0))
    s = Successors(instantiate(parse_task(problem, parse_domain(domain))), {})
    assert goal_agenda(s) == [s.goal]


PAINT = operator("paint", "", "painted", deleted="clean")
CLEAN = operator("clean", "", "clean")


def test_what_every_achiever_undoes_comes_later() -> None:
    """Nothing excludes the two: whoever paints the wall spoils the floor, which can be cleaned."""
    s = Successors(task([PAINT, CLEAN], goal="painted clean"), {})
    assert named(s, goal_agenda(s)) == [{"painted"}, {"painted", "clean"}]


def test_an_achiever_that_spoils_nothing_lifts_the_order() -> None:
    s = Successors(task([PAINT, operator("spray", "", "painted"), CLEAN], goal="painted clean"), {})
    assert goal_agenda(s) == [s.goal]


def test_an_achiever_by_a_conditional_effect_lifts_the_order() -> None:
    rain = operator("rain", when=[("", "", "painted", "")])
    s = Successors(task([PAINT, rain, CLEAN], goal="painted clean"), {})
    assert goal_agenda(s) == [s.goal]


SQUEEZED = {("squeezed",): 5.0}
DEEP = operator("deep", "", "back", guards=(Guard(facts("front"), ("squeezed",)),))
NEAR = operator("near", "", "front")


@pytest.mark.parametrize("price", [5.0, math.inf])
def test_what_a_goal_makes_dearer_comes_before_it(price: float) -> None:
    s = Successors(task([NEAR, DEEP], goal="front back"), {("squeezed",): price})
    assert named(s, guard_agenda(s)) == [{"back"}, {"back", "front"}]
    assert goal_agenda(s) == guard_agenda(s)


@pytest.mark.parametrize(
    ("more", "goal", "rules"),
    [
        ([operator("lift", "", "back")], "front back", []),  # another way that costs nothing
        (
            [operator("beside", "", "front2")],
            "ahead back",
            [("ahead", "front"), ("ahead", "front2")],
        ),
        ([operator("rain", when=[("", "", "back", "")])], "front back", []),
        ([], "front other back2", [("back2", "back front")]),  # of two facts: not ordered
    ],
)
def test_guards_order_nothing_where_one_way_is_free(
    more: list[Operator], goal: str, rules: list[tuple[str, str]]
) -> None:
    made = task([NEAR, DEEP, *more], goal, axioms=[axiom(*rule) for rule in rules])
    s = Successors(made, SQUEEZED)
    assert guard_agenda(s) == [s.goal]


def test_guards_order_goals_that_are_derived_from_what_operators_add() -> None:
    rules = [axiom("on1", "front"), axiom("on2", "back")]
    s = Successors(task([NEAR, DEEP], "on1 on2", axioms=rules), SQUEEZED)
    assert named(s, guard_agenda(s)) == [{"on2"}, {"on1", "on2"}]


def test_guards_that_cost_nothing_order_nothing() -> None:
    s = Successors(task([NEAR, DEEP], goal="front back"), {})
    assert guard_agenda(s) == [s.goal]


@pytest.mark.parametrize("reason", ["size", "time"])
def test_a_task_too_large_has_no_order(reason: str, monkeypatch: pytest.MonkeyPatch) -> None:
    s = blocks(TOWER)
    if reason == "size":
        monkeypatch.setattr(module, "MOST_AGENDA_ENTRIES", len(s.facts) * len(s.operators) - 1)
    assert goal_agenda(s, Deadline(0.0 if reason == "time" else math.inf)) == [s.goal]


def test_goals_in_a_cycle_come_together_at_the_end() -> None:
    earlier = {0: set[int](), 1: {0, 2}, 2: {1}, 3: {0}, 4: {2}}
    assert levels(earlier) == [0b00001, 0b01001, 0b11111]


def test_one_by_one_keeps_the_levels() -> None:
    orders = {tuple(module.one_by_one([0b0011, 0b1111], Random(seed))) for seed in range(40)}
    assert orders == {
        (first, 0b0011, 0b0011 | third, 0b1111) for first in (1, 2) for third in (4, 8)
    }


def reachable(s: Successors, most: int) -> set[State] | None:
    """All states with their derived facts; None where they are more."""
    found, waiting = {s.initial}, [s.initial]
    while waiting:
        state = waiting.pop()
        closed = s.closure(state)
        for i in s.applicable(closed):
            after = s.apply(i, state, closed)
            if after not in found:
                if len(found) >= most:
                    return None
                found.add(after)
                waiting.append(after)
    return {s.closure(state) for state in found}


def test_facts_that_hold_together_do_not_exclude_each_other() -> None:
    excluded = 0
    for seed in range(150):
        instantiated = instantiate(random_task(Random(seed)))
        s = Successors(instantiated, {})
        states = reachable(s, 300)
        if states is None:
            continue
        masks = Mutexes(instantiated, [], Deadline()).exclusive(s.facts, -1)
        for i, apart in enumerate(masks):
            excluded += apart.bit_count()
            for state in states:
                assert not (state >> i & 1 and state & apart), (seed, s.facts[i])
    assert excluded > 100


@pytest.mark.parametrize("singly", [False, True])
def test_a_plan_by_the_agenda_holds_by_the_book(singly: bool) -> None:
    domain, problem = GENERATORS["depot"](8, Random(1))
    task = parse_task(problem, parse_domain(domain))
    s = Successors(instantiate(task), {})
    agenda = tuple(goal_agenda(s))
    assert len(agenda) > 2
    run = SearchSpace(s, [], None, None)
    plan = by_agenda(run, Way(("ff", "landmarks"), agenda=agenda, singly=singly), 1, 3000)
    steps = [(operator.name, operator.arguments) for operator in plan.operators]
    assert Interpreter(task).run(steps) == plan.cost
    assert run.first == 0.0  # what is estimated is a part of the way


def test_a_part_that_leads_into_a_dead_end_proves_nothing() -> None:
    """The key is used up for the first goal, and the second needs it."""
    use, other = operator("use", "key", "one", deleted="key"), operator("open", "key one", "two")
    s = Successors(task([use, other], initial="key", goal="one two"), {})
    way = Way(("ff",), agenda=(1 << s.number["one",], s.goal))
    with pytest.raises(Stalled):
        by_agenda(SearchSpace(s, [], None, None), way, 1, 3000)
