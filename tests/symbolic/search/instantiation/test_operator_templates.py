"""Operators filled in for one binding: what they need, what they cost, when they may be kept."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from tamp.symbolic.pddl.structs import Atom, Fact
from tamp.symbolic.search.instantiation.datalog import Row
from tamp.symbolic.search.instantiation.effects import lifted_effects
from tamp.symbolic.search.instantiation.lazy_guards import LazyGuards
from tamp.symbolic.search.instantiation.operator_templates import (
    OperatorTemplate,
    Variant,
    action_rule,
    effect_rules,
)
from tamp.symbolic.search.instantiation.predicate_kinds import NOTHING, Assumed
from tamp.symbolic.search.operators import ANY_OBJECT, Guard
from tests.symbolic.search.instantiation.small import Parts, fact, facts, parts

GO = """(:action go :parameters (?x - thing ?p ?q - place)
    :precondition (and (at ?x ?p) (near ?p ?q){more})
    :effect (and (not (at ?x ?p)) (at ?x ?q){effect}))"""


def variant_of(made: Parts, number: int = 0, action: str = "go") -> Variant:
    one = made.action(action)
    effects = lifted_effects(one, made.normalizer)
    scope = {parameter.name: parameter.types for parameter in one.parameters}
    literals = made.normalizer.split(one.precondition, scope)[number]
    return Variant(one, literals, effects, action_rule(made.predicates, one, literals, effects))


def template(
    more: str = "",
    effect: str = "",
    *,
    init: str = "(near a b)",
    reached: str = "at box a, at box b",
    rules: str = "",
    assumed: Assumed = NOTHING,
    later: str = "",
    rows: tuple[Row, ...] = (("box", "a", "b"),),
    asked: list[Fact] | None = None,
    costs: Mapping[Fact, float] | None = None,
) -> OperatorTemplate:
    made = parts(GO.format(more=more, effect=effect) + rules, init, reached, assumed)
    made.predicates.add(sorted(facts(later)), {})
    need = [].append if asked is None else asked.append
    prices = costs or {}
    return OperatorTemplate(
        variant_of(made), list(rows), made.predicates, made.negation, need, prices.__getitem__
    )


ROW: Row = ("box", "a", "b")


def test_an_operator_of_literals_alone() -> None:
    made = template()
    one = made.instantiate(ROW)
    assert one is not None
    assert (one.name, one.arguments) == ("go", ROW)
    assert (one.positive, one.negative) == (facts("at box a"), frozenset())
    assert (one.added, one.deleted) == (facts("at box b"), facts("at box a"))
    assert one.static == facts("near a b")
    assert (one.guards, one.conditional) == ((), ())
    assert made.is_final(one)


def test_a_negative_condition_is_asked_where_it_can_be_broken() -> None:
    one = template(" (not (lamp ?q))", reached="at box a, at box b, lamp b").instantiate(ROW)
    assert one is not None and one.negative == facts("lamp b")
    other = template(" (not (lamp ?q))").instantiate(ROW)
    assert other is not None and other.negative == frozenset()


def test_no_operator_where_the_precondition_contradicts_itself() -> None:
    made = template(" (lamp ?q) (not (lamp ?q))", reached="at box a, lamp b")
    assert made.instantiate(ROW) is None


BUSY = "(:derived (busy ?p - place) (exists (?y - thing) (at ?y ?p)))"
DARK = "(:derived (dark ?p - place) (not (lamp ?p)))"


def test_derived_facts_are_asked_for_and_negated_ones_worked_out() -> None:
    asked: list[Fact] = []
    one = template(
        " (busy ?p) (not (busy ?q))", rules=BUSY, asked=asked,
        reached="at box a, at cup b, busy a",
    ).instantiate(ROW)  # fmt: skip
    assert one is not None
    assert one.positive == facts("at box a, busy a") and one.negative == facts("at cup b")
    assert set(asked) == facts("busy a, at cup b")


def test_what_a_negated_derived_fact_needs_joins_the_precondition() -> None:
    one = template(" (not (dark ?q))", rules=DARK, reached="at box a, lamp b").instantiate(ROW)
    assert one is not None and one.positive == facts("at box a, lamp b")
    assert template(" (not (dark ?q))", rules=DARK).instantiate(ROW) is None


def test_guards_at_hand_and_those_made_late() -> None:
    jam = """(:derived (jam ?p - place)
        (exists (?y ?z - thing) (and (at ?y ?p) (at ?z ?p) (not (= ?y ?z)))))"""
    blocked = """(:derived (busy ?p - place)
        (exists (?y - thing) (and (at ?y ?p) (not (clear ?y ?p)))))"""
    reached = "at box a, at box b, at cup b"
    one = template(" (not (jam ?q))", rules=jam, reached=reached).instantiate(ROW)
    assert one is not None and isinstance(one.guards, tuple)
    assert set(one.guards) == {Guard(facts("at box b, at cup b"), None)}
    late = template(
        " (not (busy ?q))", rules=blocked, reached=reached, assumed={"clear": ()}
    ).instantiate(ROW)
    assert late is not None and isinstance(late.guards, LazyGuards)
    assert Guard(facts("at cup b"), fact("clear cup b")) in list(late.guards)


def test_static_facts_are_those_that_conditions_name_and_objects_that_nothing_names() -> None:
    more = " (exists (?z - place) (near ?q ?z)) (exists (?w - thing) (not (wet ?w)))"
    made = template(
        more, init="(near a b) (near b c)", rows=(("box", "a", "b", "c", "cup"),),
    )  # fmt: skip
    one = made.instantiate(("box", "a", "b", "c", "cup"))
    assert one is not None and one.arguments == ROW
    assert one.static == {fact("near a b"), fact("near b c"), (ANY_OBJECT, "cup")}


def test_costs_are_numbers_or_looked_up_and_renewed() -> None:
    asked: list[Fact] = []
    costs = {fact("length a b"): 4.0}
    made = template(
        " (busy ?p)", " (increase (total-cost) (length ?p ?q))", costs=costs, asked=asked,
        rules=BUSY, reached="at box a, at box b, busy a",
    )  # fmt: skip
    one = made.instantiate(ROW)
    assert one is not None and one.cost == 4.0
    assert made.renew(one, ROW) is one
    costs[fact("length a b")] = 5.0
    asked.clear()
    again = made.renew(one, ROW)
    assert again.cost == 5.0 and again.positive == one.positive
    assert asked == [fact("busy a")]

    fixed = template(effect=" (increase (total-cost) 2.5)").instantiate(ROW)
    assert fixed is not None and fixed.cost == 2.5


@pytest.mark.parametrize(
    ("more", "effect", "reached"),
    [
        (" (not (lamp ?q))", "", "at box a"),  # a lamp may come along
        (" (not (busy ?q))", "", "at box a"),
        ("", " (when (lamp ?q) (dry ?q))", "at box a"),
        ("", " (not (wet ?x))", "at box a"),  # nothing wets the box so far
    ],
)
def test_what_may_still_change_is_not_kept(more: str, effect: str, reached: str) -> None:
    made = template(more, effect, reached=reached, rules=BUSY)
    one = made.instantiate(ROW)
    assert one is not None and not made.is_final(one)


def test_the_rule_of_an_action_joins_conditions_and_adds_simple_effects() -> None:
    made = parts(GO.format(more="", effect=" (when (lamp ?q) (dry ?q))"))
    rule = variant_of(made).rule
    assert rule.variables == ("?x", "?p", "?q")
    assert set(rule.body.positive) >= {Atom("at", ("?x", "?p")), Atom("near", ("?p", "?q"))}
    assert rule.heads == (Atom("at", ("?x", "?q")),)


def test_a_parameter_that_nothing_mentions_takes_one_value() -> None:
    action = "(:action idle :parameters (?x ?y - thing) :effect (wet ?x))"
    made = parts(action)
    rule = variant_of(made, action="idle").rule
    values = {
        atom.terms[0]: list(made.predicates.relations.rows(atom.predicate))
        for atom in rule.body.positive
    }
    assert values == {"?x": [("box",), ("cup",)], "?y": [("box",)]}


def test_each_conditional_effect_that_adds_has_a_rule() -> None:
    effect = " (forall (?z - thing) (when (wet ?z) (at ?z ?q))) (when (lamp ?q) (not (dry ?q)))"
    made = parts(GO.format(more="", effect=effect))
    (rule,) = effect_rules(made.predicates, variant_of(made))
    assert rule.variables == ("?x", "?p", "?q", "?z of effect")
    assert rule.heads == (Atom("at", ("?z of effect", "?q")),)
    assert {Atom("wet", ("?z of effect",)), Atom("at", ("?x", "?p"))} <= set(rule.body.positive)
    assert len(rule.body.positive) == len(set(rule.body.positive))
