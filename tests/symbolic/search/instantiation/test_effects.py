"""Effects of one action's operators: what holds in any case is told apart from what is conditional."""

from __future__ import annotations

import pytest

from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.instantiation.effects import EffectTemplates, lifted_effects
from tamp.symbolic.search.operators import ANY_OBJECT, ConditionalEffect, Facts
from tests.symbolic.search.instantiation.small import fact, facts, parts

PLACES = [("a",), ("b",)]


def effect_of(
    effect: str,
    row: str = "a",
    before: str = "",
    *,
    init: str = "",
    reached: str = "",
    later: str = "",
    rules: str = "",
    asked: list[Fact] | None = None,
) -> tuple[Facts, Facts, tuple[ConditionalEffect, ...]]:
    """The effects of (act ?p) at one place; `later` are static facts that the task does not give."""
    action = f"(:action act :parameters (?p - place) :effect {effect})"
    made = parts(action + rules, init, reached)
    made.predicates.add(sorted(facts(later)), {})
    effects = EffectTemplates(
        lifted_effects(made.action("act"), made.normalizer),
        ("?p",),
        PLACES,
        made.predicates,
        made.negation,
        [].append if asked is None else asked.append,
    )
    return effects.of((row,), facts(before))


def test_what_is_added_and_deleted_in_any_case() -> None:
    effect = "(and (lamp ?p) (not (dry ?p)))"
    assert effect_of(effect, reached="dry a") == (facts("lamp a"), facts("dry a"), ())


def test_what_can_never_hold_is_not_deleted() -> None:
    assert effect_of("(not (dry ?p))", "b", reached="dry a") == (frozenset(), frozenset(), ())


def test_a_universal_effect_is_expanded_over_the_objects_of_its_type() -> None:
    """Nothing but the type names the variable: the effect rests on the object's being there."""
    added, deleted, conditional = effect_of("(forall (?x - thing) (at ?x ?p))", "b")
    assert (added, deleted) == (frozenset(), frozenset())
    assert [(one.static, one.added) for one in conditional] == [
        ({(ANY_OBJECT, "box")}, facts("at box b")),
        ({(ANY_OBJECT, "cup")}, facts("at cup b")),
    ]


def test_a_universal_effect_deletes_only_what_can_hold() -> None:
    found = effect_of("(forall (?x - thing) (not (at ?x ?p)))", "b", reached="at cup b, at box a")
    assert found == (frozenset(), facts("at cup b"), ())


def test_an_effects_own_variable_hides_the_parameter_of_its_name() -> None:
    made = effect_of("(forall (?p - place) (lamp ?p))", "b")[2]
    assert frozenset().union(*(one.added for one in made)) == facts("lamp a, lamp b, lamp c")


def test_known_static_conditions_are_no_conditions_others_are_noted() -> None:
    effect = "(forall (?q - place) (when (near ?p ?q) (lamp ?q)))"
    found = effect_of(effect, init="(near a b) (near b a)", later="near a c")
    wanted = ConditionalEffect(
        frozenset(), frozenset(), facts("lamp c"), frozenset(), facts("near a c")
    )
    assert found == (facts("lamp b"), frozenset(), (wanted,))


def test_conditions_on_the_state_before() -> None:
    effect = "(forall (?x - thing) (when (and (at ?x ?p) (not (wet ?x))) (wet ?x)))"
    added, deleted, conditional = effect_of(effect, reached="at box a, at cup a, wet cup")
    assert (added, deleted) == (frozenset(), frozenset())
    assert set(conditional) == {
        # that the box is wet is reached by no operator, so it need not be asked
        ConditionalEffect(facts("at box a"), frozenset(), facts("wet box"), frozenset()),
        ConditionalEffect(facts("at cup a"), facts("wet cup"), facts("wet cup"), frozenset()),
    }


def test_what_the_precondition_says_is_not_repeated() -> None:
    effect = "(when (and (lamp ?p) (dry ?p)) (not (dry ?p)))"
    reached = "lamp a, dry a"
    (one,) = effect_of(effect, reached=reached)[2]
    assert one == ConditionalEffect(facts("lamp a"), frozenset(), frozenset(), facts("dry a"))
    assert effect_of(effect, before="lamp a", reached=reached) == (
        frozenset(),
        facts("dry a"),
        (),
    )


@pytest.mark.parametrize(
    ("condition", "before"),
    [("(and (lamp ?p) (not (lamp ?p)))", ""), ("(not (lamp ?p))", "lamp a")],
)
def test_what_cannot_come_about_is_left_out(condition: str, before: str) -> None:
    effect = f"(when {condition} (dry ?p))"
    assert effect_of(effect, before=before, reached="lamp a") == (frozenset(), frozenset(), ())


def test_a_condition_that_only_forbids_is_one() -> None:
    (one,) = effect_of("(when (not (lamp ?p)) (dry ?p))", reached="lamp a")[2]
    assert one == ConditionalEffect(frozenset(), facts("lamp a"), facts("dry a"), frozenset())


def test_a_negated_derived_fact_that_always_holds_leaves_nothing() -> None:
    rules = "(:derived (dark ?p - place) (not (lamp ?p)))"
    effect = "(when (not (dark ?p)) (dry ?p))"
    assert effect_of(effect, rules=rules) == (frozenset(), frozenset(), ())
    (one,) = effect_of(effect, rules=rules, reached="lamp a")[2]
    assert one.positive == facts("lamp a")


def test_deleting_what_is_absent_changes_nothing_so_it_needs_no_condition() -> None:
    found = effect_of("(when (dry ?p) (not (dry ?p)))", reached="dry a")
    assert found == (frozenset(), facts("dry a"), ())
    (one,) = effect_of("(when (dry ?p) (dry ?p))", reached="dry a")[2]
    assert one.positive == facts("dry a")  # adding does


def test_effects_of_one_condition_are_one_and_a_disjunction_is_two() -> None:
    effect = "(when (or (lamp ?p) (dry ?p)) (and (busy ?p) (not (jam ?p))))"
    found = effect_of(effect, reached="lamp a, dry a, jam a")[2]
    changed = facts("busy a"), facts("jam a")
    assert set(found) == {
        ConditionalEffect(facts("lamp a"), frozenset(), *changed),
        ConditionalEffect(facts("dry a"), frozenset(), *changed),
    }


def test_derived_conditions_are_asked_for_and_negated_ones_worked_out() -> None:
    rules = "(:derived (busy ?p - place) (exists (?x - thing) (at ?x ?p)))"
    rules += "(:derived (safe ?p - place) (or (lamp ?p) (dry ?p)))"
    asked: list[Fact] = []
    effect = "(when (and (safe ?p) (not (busy ?p))) (lamp ?p))"
    reached = "at box a, safe a, lamp a"
    (one,) = effect_of(effect, reached=reached, rules=rules, asked=asked)[2]
    assert one.positive == facts("safe a") and one.negative == facts("at box a")
    assert set(asked) == facts("safe a, at box a")


def test_what_all_operators_delete_is_one_set() -> None:
    """Of the effect's variables none is the action's: all bindings share the set."""
    action = "(:action act :parameters (?p - place) :effect (forall (?x - thing) (not (wet ?x))))"
    made = parts(action, reached="wet box, wet cup")
    effects = EffectTemplates(
        lifted_effects(made.action("act"), made.normalizer),
        ("?p",), PLACES, made.predicates, made.negation, [].append,
    )  # fmt: skip
    first, second = (effects.of(row, frozenset())[1] for row in PLACES)
    assert first == facts("wet box, wet cup") and first is second


def test_a_lifted_effect_is_simple_without_variables_and_condition_of_its_own() -> None:
    effect = "(and (lamp ?p) (when (dry ?p) (lamp ?p)) (forall (?x - thing) (at ?x ?p)))"
    made = parts(f"(:action act :parameters (?p - place) :effect {effect})")
    lifted = lifted_effects(made.action("act"), made.normalizer)
    assert [one.simple for one in lifted] == [True, False, False]
    assert lifted[2].atom.terms == ("?x of effect", "?p")
    assert fact("lamp ?p") == (lifted[0].atom.predicate, *lifted[0].atom.terms)
