"""Guards that are made when they are asked for: by row, by state, by fact, by what waives them."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tamp.symbolic.pddl.structs import Atom
from tamp.symbolic.search.instantiation.datalog import Row
from tamp.symbolic.search.instantiation.lazy_guards import DerivedGuards, LazyGuards
from tamp.symbolic.search.instantiation.predicate_kinds import Assumed
from tamp.symbolic.search.operators import Guard
from tests.symbolic.search.instantiation.small import Parts, fact, facts, parts

JAM = """(:derived (jam ?p - place)
    (exists (?x - thing ?q - place) (and (at ?x ?q) (near ?p ?q) (not (clear ?x ?q)))))"""
OPEN: Assumed = {"clear": ()}


def made(
    init: str = "(near a b) (near a c) (near b c)",
    reached: str = "at box b, at cup c",
    assumed: Assumed = OPEN,
    rule: str = JAM,
    rows: tuple[Row, ...] = (("a",), ("b",)),
) -> tuple[Parts, DerivedGuards]:
    found = parts(rule, init, reached, assumed)
    (definition,) = found.normalizer.definitions["jam"]
    assert DerivedGuards.fits(found.predicates, definition)
    guards = DerivedGuards(found.predicates, definition)
    guards.add(rows)
    return found, guards


BOX_B = Guard(facts("at box b"), fact("clear box b"))
CUP_C = Guard(facts("at cup c"), fact("clear cup c"))


def test_the_guards_of_a_row() -> None:
    _, guards = made()
    assert set(guards.of(("a",))) == {BOX_B, CUP_C}
    assert guards.of(("b",)) == (CUP_C,)
    assert guards.of(("c",)) == ()
    assert guards.fluent == "at"


def test_a_state_triggers_those_whose_fact_it_has() -> None:
    _, guards = made()
    state = facts("at cup c, at box a, lamp b")
    assert guards.triggered(("a",), state) == [CUP_C]
    assert guards.triggered(("b",), facts("at box b")) == []
    guards.of(("a",))  # from what has been made it is the same
    assert guards.triggered(("a",), state) == [CUP_C]


def test_a_state_triggers_also_what_shares_a_variable_with_the_head() -> None:
    rule = """(:derived (jam ?p - place)
        (exists (?x - thing) (and (at ?x ?p) (not (clear ?x ?p)))))"""
    _, guards = made("", "at box b, at cup c", rule=rule)
    assert guards.triggered(("b",), facts("at box b, at cup c")) == [BOX_B]


def test_a_fact_triggers_the_guards_of_all_registered_rows() -> None:
    _, guards = made()
    assert sorted(guards.on(fact("at cup c"))) == [(("a",), CUP_C), (("b",), CUP_C)]
    assert guards.on(fact("at box b")) == [(("a",), BOX_B)]
    guards.add([("c",)])
    assert sorted(row for row, _ in guards.on(fact("at cup c"))) == [("a",), ("b",)]


def test_a_row_that_is_registered_later_is_found_as_well() -> None:
    _, guards = made(rows=(("b",),))
    assert [row for row, _ in guards.on(fact("at cup c"))] == [("b",)]
    guards.add([("a",)])
    assert sorted(row for row, _ in guards.on(fact("at cup c"))) == [("a",), ("b",)]


def test_what_waives() -> None:
    _, guards = made()
    assert sorted(guards.waived_by([fact("clear cup c"), fact("near a b")])) == [
        (("a",), CUP_C),
        (("b",), CUP_C),
    ]
    assert list(guards.waived_by([])) == []


def test_what_is_refused_waives_nothing() -> None:
    found, guards = made()
    found.predicates.refused = facts("clear box b")
    forbidden = Guard(facts("at box b"), None)
    assert set(guards.of(("a",))) == {forbidden, CUP_C}
    assert list(guards.unwaivable(facts("at box b, at cup c"))) == [(("a",), forbidden)]


def test_what_is_certainly_clear_is_no_guard() -> None:
    _, guards = made("(near a b) (near a c) (clear box b)")
    assert guards.of(("a",)) == (CUP_C,)


def test_a_test_that_is_never_asked_of_the_fluents_terms_waives_nothing() -> None:
    """`clear ?x ?q` is asked where `floor ?q` is known: that is about the fluent's terms."""
    init = "(near a b) (near a c) (floor c)"
    _, guards = made(init, assumed={"clear": (("floor", (1,)),)})
    forbidden = Guard(facts("at box b"), None)
    assert set(guards.of(("a",))) == {forbidden, CUP_C}
    found = list(guards.unwaivable(facts("at box b, at cup c, lamp b")))
    assert found == [(("a",), forbidden)]
    assert list(guards.unwaivable(facts("at cup c"))) == []


def test_a_test_that_is_never_asked_of_the_rows_terms_waives_nothing() -> None:
    rule = """(:derived (jam ?p - place)
        (exists (?x - thing) (and (at ?x ?p) (not (clear ?x ?p)))))"""
    assumed = {"clear": (("floor", (1,)),)}
    _, guards = made("(floor b)", "at box a, at box b", assumed, rule)
    forbidden = Guard(facts("at box a"), None)
    assert guards.of(("a",)) == (forbidden,) and guards.of(("b",)) == (BOX_B,)
    assert list(guards.unwaivable(frozenset())) == [(("a",), forbidden)]


def test_a_test_that_wants_facts_of_both_is_looked_for_among_all_guards() -> None:
    rule = """(:derived (blocked ?y - thing)
        (exists (?x - thing ?q - place) (and (at ?x ?q) (not (= ?x ?y)) (not (clear ?y ?q)))))"""
    found = parts(rule, "(at box b)", "at box b, at cup c", {"clear": (("at", (0, 1)),)})
    (definition,) = found.normalizer.definitions["blocked"]
    guards = DerivedGuards(found.predicates, definition)
    guards.add([("box",), ("cup",)])
    assert list(guards.unwaivable(frozenset())) == [
        (("box",), Guard(facts("at cup c"), None)),
        (("cup",), Guard(facts("at box b"), None)),
    ]


@pytest.mark.parametrize(
    "body",
    [
        "(exists (?x - thing) (and (at ?x ?p) (wet ?x) (not (clear ?x ?p))))",  # two fluents
        "(exists (?x - thing) (and (at ?x ?p) (not (near ?p ?p))))",  # not assumed
        "(exists (?x - thing) (and (at ?x ?p) (not (clear ?x ?p)) (not (lamp ?p))))",
        "(exists (?x - thing) (and (at ?x ?p) (not (clear ?x ?p)) (busy ?p)))",
        "(exists (?x - thing) (and (at ?x ?p) (not (clear ?x ?p)) (not (busy ?p))))",
        "(exists (?x - thing) (at ?x ?p))",  # nothing waives
    ],
)
def test_other_rules_do_not_fit(body: str) -> None:
    busy = "(:derived (busy ?p - place) (exists (?x - thing) (at ?x ?p)))"
    found = parts(f"(:derived (jam ?p - place) {body}){busy}", assumed=OPEN)
    assert not DerivedGuards.fits(found.predicates, found.normalizer.definitions["jam"][0])


@pytest.mark.parametrize("terms", [("?p", "?p"), ("?p", "a")])
def test_a_head_of_constants_or_repeated_variables_does_not_fit(terms: tuple[str, ...]) -> None:
    found = parts(JAM, assumed=OPEN)
    definition = replace(found.normalizer.definitions["jam"][0], head=Atom("twin", terms))
    assert not DerivedGuards.fits(found.predicates, definition)


def test_an_operators_guards_are_a_sequence_made_late() -> None:
    _, guards = made()
    ready = Guard(facts("lamp a"), None)
    lazy = LazyGuards((ready,), ((guards, ("b",)),))
    assert list(lazy) == [ready, CUP_C] and len(lazy) == 2
    assert lazy[1] == CUP_C and lazy[:1] == (ready,)
    assert lazy == LazyGuards((ready, CUP_C), ()) != LazyGuards((ready,), ())
    assert hash(lazy) == hash(LazyGuards((ready, CUP_C), ()))
    assert lazy != (ready, CUP_C)


def test_only_triggered_guards_are_made_in_a_state() -> None:
    _, guards = made()
    ready = Guard(facts("lamp a"), None)
    lazy = LazyGuards((ready,), ((guards, ("a",)),))
    assert lazy.triggered(facts("at cup c")) == (CUP_C,)
    assert lazy.triggered(facts("lamp a, at box b")) == (ready, BOX_B)
    assert lazy.triggered(frozenset()) == ()


def test_guards_that_may_be_there_count_as_there() -> None:
    """To know that a row has none, all would have to be made."""
    _, guards = made()
    assert not LazyGuards((), ())
    assert LazyGuards((), ((guards, ("c",)),))
