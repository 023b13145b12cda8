"""A plan step by step: what it rests on, where it breaks, and whether another derivation would do."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tamp.symbolic.search.operators import ConditionalEffect, Guard, InstantiatedTask, Operator
from tamp.symbolic.search.plan_trace import replayed, trace, triggered
from tests.symbolic.search.packed.room import axiom, facts, operator, task

CLEAR = Guard(facts("c"), ("clear",))


def test_a_step_rests_on_its_static_facts_and_those_that_lift_its_triggered_guards() -> None:
    way = operator("o", "a", "g", static="s", guards=(CLEAR, Guard(facts("d"), ("other",))))
    (step,) = trace(task([way], "g", "a c"), [way]).steps
    assert step.static == facts("s clear") and step.unguarded == facts("s")
    assert step.guards == (CLEAR,) and step.read == facts("a")
    assert step.state == facts("a c") and step.added == facts("g") and step.deleted == facts("")


def test_a_step_rests_on_the_derivations_of_what_it_needs() -> None:
    rules = [
        replace(axiom("m", "a"), static=facts("s")), replace(axiom("n", "m b"), static=facts("t")),
        replace(axiom("u", "a"), static=facts("unused")),
    ]  # fmt: skip
    way = operator("o", "n", "g")
    traced = trace(task([way], "g m", "a b", rules), [way])
    (step,) = traced.steps
    assert step.derived == step.static == facts("s t")
    assert step.read == facts("a b") and step.heads == facts("n m")
    assert traced.end.static == traced.end.derived == facts("s") and traced.end.read == facts("g a")
    assert not traced.open


def test_effects_that_take_place_add_what_they_rest_on() -> None:
    def effect(
        needed: str, absent: str, added: str, deleted: str, static: str
    ) -> ConditionalEffect:
        return ConditionalEffect(*map(facts, (needed, absent, added, deleted, static)))

    happens = effect("n", "x", "g", "a z", "s")
    way = replace(
        operator("o", "a", "h", deleted="h"),
        conditional=(happens, effect("b", "", "y", "", "t"), effect("", "a", "y", "", "t")),
    )
    rules = [replace(axiom("n", "a"), static=facts("r"))]
    (step,) = trace(task([way], "g", "a", rules), [way]).steps
    assert step.added == facts("h g")
    assert step.deleted == facts("a")  # z was not there, and h is added too
    assert step.static == facts("s r") and step.heads == facts("n")


def test_of_several_derivations_the_first_counts_or_the_cheapest_by_price() -> None:
    rules = [replace(axiom("n", "a"), static=facts(one)) for one in ("dear", "cheap")]
    way = operator("o", "n", "g")
    made = task([way], "g", "a", rules)
    assert trace(made, [way]).steps[0].static == facts("dear")
    prices = {("dear",): 5.0, ("cheap",): 1.0}
    assert trace(made, [way], prices).steps[0].static == facts("cheap")
    assert trace(made, [way]).open  # another one was possible
    only = task([way, operator("p", "a", "g")], "g", "a", rules)
    assert not trace(only, [only.operators[1]]).open  # nothing rested on it


FORBIDDEN = operator("o", "a", "g", guards=(Guard(facts("c"), None),))


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (task([operator("o", "b", "g")], "g", "a"), r"\(o\) is not applicable"),
        (task([operator("o", "a", "g", absent="c")], "g", "a c"), r"\(o\) is not applicable"),
        (task([FORBIDDEN], "g", "a c"), r"\(o\) is forbidden while \[\('c',\)\] hold"),
        (task([operator("o", "a", "z")], "g", "a"), "the goal does not hold in the end"),
        (task([operator("o", "a", "g")], "g", "a", (), "a"), "the goal does not hold in the end"),
    ],
)
def test_what_is_no_plan(made: InstantiatedTask, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        trace(made, made.operators)


def test_actions_are_replayed_by_their_names_whichever_of_their_operators_applies() -> None:
    """A disjunction made two operators of one action: the second step needs what the second gave."""

    def action(name: str, before: str, after: str) -> Operator:
        return replace(operator(name, before, after), arguments=("x",))

    made = task([action("o", "a", "y"), action("o", "b", "z"), action("p", "z", "g")], "g", "a b")
    assert replayed(made, [("o", ("x",)), ("p", ("x",))])
    assert not replayed(made, [("p", ("x",)), ("o", ("x",))])
    assert not replayed(made, [("o", ("x",))])
    assert not replayed(made, [("o", ()), ("p", ("x",))])
    assert not replayed(made, [("q", ("x",)), ("o", ("x",)), ("p", ("x",))])
    assert not replayed(replace(made, goal=replace(made.goal, negative=facts("b"))),
                        [("o", ("x",)), ("p", ("x",))])  # fmt: skip


def test_guards_are_triggered_by_all_their_facts() -> None:
    pair = Guard(facts("c d"), None)
    way = operator("o", "a", "g", guards=(CLEAR, pair))
    assert triggered(way, facts("c")) == (CLEAR,)
    assert triggered(way, facts("d")) == ()
    assert triggered(way, facts("c d a")) == (CLEAR, pair)
