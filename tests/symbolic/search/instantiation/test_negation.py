"""What `not d(...)` needs: literals, guards, or a choice with an axiom a literal."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tamp.symbolic.pddl.structs import Atom
from tamp.symbolic.search.instantiation.negation import Needs
from tamp.symbolic.search.operators import Axiom, Guard
from tests.symbolic.search.instantiation.small import Parts, fact, facts, parts

BUSY = "(:derived (busy ?p - place) (exists (?x - thing) (at ?x ?p)))"
JAM = """(:derived (jam ?p - place)
    (exists (?x ?y - thing) (and (at ?x ?p) (at ?y ?p) (not (= ?x ?y)))))"""
DARK = "(:derived (dark ?p - place) (not (lamp ?p)))"
CHOICE = ("choice 1",)
NONE = frozenset[tuple[str, ...]]()


def refuted(made: Parts, text: str, *, guards: bool = True) -> Needs:
    return made.negation.refute(fact(text), guards=guards)


def axioms_of(made: Parts) -> set[tuple[frozenset, frozenset, frozenset]]:
    """The bodies of the first choice's axioms: positive, negative, static."""
    found = [one for one in made.negation.axioms if one.head == CHOICE]
    assert len(found) == len(set(found))
    return {(one.positive, one.negative, one.static) for one in found}


def test_a_rule_of_one_fluent_is_refuted_by_the_absence_of_each_that_can_hold() -> None:
    made = parts(BUSY, reached="at box a, at cup a, at cup b")
    assert refuted(made, "busy a") == Needs(negative=[fact("at box a"), fact("at cup a")])
    assert refuted(made, "busy c") == Needs()


def test_a_rule_of_two_fluents_is_a_guard_that_nothing_waives() -> None:
    made = parts(JAM, reached="at box a, at cup a, at cup b")
    found = refuted(made, "jam a").guards
    assert {guard.facts for guard in found} == {facts("at box a, at cup a")}
    assert all(guard.waived_by is None for guard in found)
    assert refuted(made, "jam b") == Needs()


def test_each_pair_is_a_guard_of_its_own() -> None:
    reached = "at box a, at cup a, at pan a"
    made = parts(JAM, reached=reached, objects="box cup pan - thing a b c - place")
    assert {guard.facts for guard in refuted(made, "jam a").guards} == {
        facts("at box a, at cup a"),
        facts("at box a, at pan a"),
        facts("at cup a, at pan a"),
    }


def test_a_static_fact_that_came_along_later_waives_like_a_tests() -> None:
    rule = """(:derived (jam ?p - place)
        (exists (?x - thing) (and (at ?x ?p) (not (near ?p ?p)))))"""
    made = parts(rule, "(near b b)", "at box a, at cup a, at box b, at box c")
    made.predicates.add([fact("near a a")], {})
    waived = [Guard(facts(f"at {name} a"), fact("near a a")) for name in ("box", "cup")]
    assert refuted(made, "jam a").guards == waived
    assert refuted(made, "jam b") == Needs()
    assert refuted(made, "jam c") == Needs(negative=[fact("at box c")])


def test_guards_of_a_derived_fact_in_the_rule_stay_guards() -> None:
    rule = JAM + "(:derived (hot ?p - place) (and (jam ?p) (near ?p ?p)))"
    made = parts(rule, "(near a a)", "at box a, at cup a, jam a")
    needs = refuted(made, "hot a")
    assert {guard.facts for guard in needs.guards} == {facts("at box a, at cup a")}
    assert not needs.positive


def test_where_guards_are_not_allowed_they_become_a_choice() -> None:
    made = parts(JAM, reached="at box a, at cup a")
    needs = refuted(made, "jam a", guards=False)
    assert not needs.guards and set(needs.positive) == {CHOICE}
    assert axioms_of(made) == {
        (NONE, facts("at box a"), NONE),
        (NONE, facts("at cup a"), NONE),
    }
    assert made.negation.meanings["choice 1"].text == "not at box a or not at cup a"
    assert made.negation.meanings["choice 1"].terms == ("box", "a", "cup", "a")
    assert () in made.predicates.relations.rows("choice 1")


def test_a_negated_fluent_in_the_rule_has_to_hold() -> None:
    made = parts(DARK, reached="lamp a")
    assert refuted(made, "dark a") == Needs(positive=[fact("lamp a")])
    assert refuted(made, "dark b").impossible  # no lamp burns there ever


def test_a_fact_given_besides_the_rules_cannot_be_refuted() -> None:
    made = parts(BUSY)
    made.predicates.add([fact("busy a")], {})
    assert refuted(made, "busy a").impossible
    assert not refuted(made, "busy b").impossible


def test_a_recursive_fact_is_asked_of_the_state_itself_where_it_can_hold() -> None:
    rule = """(:derived (way ?p ?q - place)
        (or (near ?p ?q) (exists (?m - place) (and (near ?p ?m) (way ?m ?q)))))"""
    made = parts(rule, init="(near a b)", reached="way a b")
    assert refuted(made, "way a b") == Needs(negative=[fact("way a b")])
    assert refuted(made, "way b a") == Needs()


def test_a_derived_fact_in_the_rule_is_refuted_in_turn() -> None:
    rule = BUSY + "(:derived (hot ?p - place) (and (busy ?p) (near ?p ?p)))"
    made = parts(rule, init="(near a a)", reached="at box a, busy a, busy b")
    assert refuted(made, "hot a") == Needs(negative=[fact("at box a")])
    assert refuted(made, "hot b") == Needs()  # the static part of the rule is broken


def test_a_negated_derived_fact_in_the_rule_has_to_hold() -> None:
    rule = BUSY + "(:derived (safe ?p - place) (and (not (busy ?p)) (near ?p ?p)))"
    made = parts(rule, init="(near a a) (near b b)", reached="at box a, busy a")
    assert refuted(made, "safe a") == Needs(positive=[fact("busy a")])
    assert refuted(made, "safe b").impossible


def test_a_clause_of_several_literals_is_a_choice_made_once() -> None:
    rule = "(:derived (dark ?p - place) (and (not (lamp ?p)) (dry ?p)))"
    made = parts(rule, reached="lamp a, dry a, dry b")
    assert refuted(made, "dark a") == Needs(positive=[CHOICE])
    assert axioms_of(made) == {
        (facts("lamp a"), NONE, NONE),
        (NONE, facts("dry a"), NONE),
    }
    assert refuted(made, "dark b") == Needs(negative=[fact("dry b")])  # one literal left
    assert refuted(made, "dark c") == Needs()  # it is never dry there
    assert [one.head for one in made.negation.axioms] == [CHOICE] * 2


def test_a_choice_over_derived_facts_refutes_them_in_its_axioms() -> None:
    rule = BUSY + "(:derived (hot ?p - place) (and (busy ?p) (not (lamp ?p))))"
    made = parts(rule, reached="at box a, busy a, lamp a")
    assert refuted(made, "hot a").positive == [CHOICE]
    assert axioms_of(made) == {
        (facts("lamp a"), NONE, NONE),
        (NONE, facts("at box a"), NONE),
    }


@pytest.mark.parametrize("given", [False, True])
def test_an_assumed_static_fact_waives_and_a_known_one_leaves_nothing(given: bool) -> None:
    rule = """(:derived (jam ?p - place)
        (exists (?x ?y - thing)
            (and (at ?x ?p) (at ?y ?p) (not (= ?x ?y)) (not (clear ?x ?p)))))"""
    init = "(clear box a) (clear cup a)" if given else ""
    made = parts(rule, init, "at box a, at cup a", assumed={"clear": ()})
    guards = refuted(made, "jam a").guards
    both = facts("at box a, at cup a")
    waivers = [Guard(both, fact("clear box a")), Guard(both, fact("clear cup a"))]
    assert sorted(guards) == ([] if given else waivers)


def test_a_waiver_comes_last_in_a_choice() -> None:
    rule = """(:derived (jam ?p - place)
        (exists (?x - thing) (and (at ?x ?p) (lamp ?p) (not (clear ?x ?p)))))"""
    made = parts(rule, "", "at box a, lamp a", assumed={"clear": ()})
    assert refuted(made, "jam a", guards=False).positive == [CHOICE]
    assert made.negation.axioms == [
        Axiom(CHOICE, NONE, facts("at box a")),
        Axiom(CHOICE, NONE, facts("lamp a")),
        Axiom(CHOICE, NONE, NONE, facts("clear box a")),
    ]


def test_guards_of_one_assumed_test_are_made_when_somebody_looks() -> None:
    rule = """(:derived (jam ?p - place)
        (exists (?x - thing) (and (at ?x ?p) (not (clear ?x ?p)))))"""
    made = parts(rule, "", "at box a, at cup b", assumed={"clear": ()})
    needs = refuted(made, "jam a")
    assert not needs.guards
    ((source, row),) = needs.blocked
    assert row == ("a",)
    assert source.of(row) == (Guard(facts("at box a"), fact("clear box a")),)
    assert refuted(made, "jam b").blocked[0][0] is source
    plain = refuted(made, "jam a", guards=False)
    assert not plain.blocked and plain.positive == [CHOICE]


def test_constants_and_repeated_variables_of_a_head_pick_the_facts_it_is_about() -> None:
    """As rules of a domain made in Python may have them; the parser writes equalities."""
    made = parts("(:derived (jam ?p - place) (lamp ?p))", reached="lamp a, lamp b")
    (rule,) = made.normalizer.definitions["jam"]
    made.normalizer.definitions["twin"] = [replace(rule, head=Atom("twin", ("?p", "?p")))]
    made.normalizer.definitions["way"] = [replace(rule, head=Atom("way", ("a", "?p")))]
    assert refuted(made, "twin a a") == Needs(negative=[fact("lamp a")])
    assert refuted(made, "twin a b") == Needs()
    assert refuted(made, "way a b") == Needs(negative=[fact("lamp b")])
    assert refuted(made, "way b a") == Needs()


def test_all_at_once_are_as_one_by_one() -> None:
    rows = [(place,) for place in "abc"]
    together = parts(JAM + DARK, reached="at box a, at cup a, lamp b")
    for predicate in ("jam", "dark"):
        together.negation.prepare(predicate, rows)
        for row in rows:
            alone = parts(JAM + DARK, reached="at box a, at cup a, lamp b")
            one = alone.negation.refute((predicate, *row), guards=True)
            assert together.negation.refute((predicate, *row), guards=True) == one


def test_needs_add_up() -> None:
    guard = Guard(facts("at box a"), None)
    needs = Needs([fact("lamp a")], [fact("dry a")])
    needs.add(Needs([fact("lamp b")], [fact("dry b")], [guard], [], impossible=True))
    needs.add(Needs())
    wanted = [fact("lamp a"), fact("lamp b")], [fact("dry a"), fact("dry b")]
    assert needs == Needs(*wanted, [guard], [], impossible=True)
