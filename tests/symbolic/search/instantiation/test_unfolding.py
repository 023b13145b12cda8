"""Unfolding derived predicates whose rule does not bind its head: which, and that it changes no plan."""

from __future__ import annotations

from random import Random

import pytest

from tamp.symbolic.pddl.parser import parse_domain, parse_task
from tamp.symbolic.pddl.structs import Atom
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.instantiation.normal_form import Normalizer
from tamp.symbolic.search.instantiation.unfolding import bound_variables, unfoldable
from tamp.symbolic.search.search import search
from tests.symbolic.search.interpreter import Interpreter

FREE = "(not (exists (?b ?q) (and (at ?b ?l) (pose ?b ?q) (hits ?o ?p ?b ?q))))"
DOMAIN = """(define (domain d) (:predicates (obj ?o) (at ?o ?l) (pose ?o ?p) (hits ?o ?p ?b ?q)
  (fits ?l ?o ?p) (ok ?l ?o ?p))
 (:derived (ok ?l ?o ?p) {body}) {more}
 (:action put :parameters (?o ?l ?p) :precondition (and (obj ?o) (fits ?l ?o ?p) (ok ?l ?o ?p))
  :effect (and (at ?o ?l) (pose ?o ?p))))"""


def names(body: str, more: str = "", given: frozenset[str] = frozenset()) -> list[str]:
    return [
        rule.head.predicate
        for rule in unfoldable(parse_domain(DOMAIN.format(body=body, more=more)), given)
    ]


def test_a_rule_whose_body_binds_nothing_is_unfolded() -> None:
    assert names(FREE) == ["ok"]


@pytest.mark.parametrize(
    ("body", "more"),
    [
        ("(and (fits ?l ?o ?p) (at ?o ?l))", ""),  # bound
        (f"(or (ok ?l ?p ?o) {FREE})", ""),  # recursive
        (FREE, "(:derived (ok ?l ?o ?p) (fits ?l ?o ?p))"),  # two rules
    ],
)
def test_other_rules_are_kept(body: str, more: str) -> None:
    assert names(body, more) == []


def test_a_predicate_of_which_facts_are_given_is_kept() -> None:
    assert names(FREE, given=frozenset({"ok"})) == []


def test_bound_variables_are_those_that_a_positive_atom_names_in_every_case() -> None:
    def bound(body: str, sign: bool = True) -> set[str]:
        (rule,) = parse_domain(DOMAIN.format(body=body, more="")).derived
        return set(bound_variables(rule.body, sign))

    assert bound("(and (at ?o ?l) (not (obj ?p)))") == {"?o", "?l"}
    assert bound("(or (at ?o ?l) (pose ?o ?p))") == {"?o"}
    assert bound("(not (or (not (obj ?o)) (not (obj ?p))))") == {"?o", "?p"}
    assert bound("(exists (?b) (at ?b ?l))") == {"?l"}
    assert bound("(forall (?b) (at ?b ?l))") == set()
    assert bound("(and (obj ?o) (= ?o ?p))") == {"?o"}
    assert bound("(at ?o ?l)", sign=False) == set()


def random_problem(rng: Random) -> str:
    places, things, poses = ["l0", "l1"], ["o0", "o1", "o2"], ["p0", "p1"]
    facts = [f"(obj {o})" for o in things]
    facts += [
        f"(fits {at} {o} {p})" for at in places for o in things for p in poses if rng.random() < 0.8
    ]
    facts += [
        f"(hits {o} {p} {b} {q})"
        for o in things
        for p in poses
        for b in things
        for q in poses
        if o != b and rng.random() < 0.4
    ]
    goal = " ".join(f"(at {o} {rng.choice(places)})" for o in things)
    objects = " ".join((*places, *things, *poses))
    return f"(define (problem p) (:domain d) (:objects {objects}) (:init {' '.join(facts)}) (:goal (and {goal})))"


def test_unfolding_changes_neither_verdict_nor_cost() -> None:
    domain = parse_domain(DOMAIN.format(body=FREE, more=""))
    solved = 0
    for seed in range(25):
        task = parse_task(random_problem(Random(seed)), domain)
        unfolded = search(instantiate(task), search="astar", heuristic="blind")
        kept = search(
            instantiate(task, {("ok", "nowhere", "o0", "p0")}, {"nowhere": ("object",)}),
            search="astar",
            heuristic="blind",
        )  # a given fact, which matters to nothing, keeps the rule whole
        assert (unfolded.plan is None) == (kept.plan is None)
        if unfolded.plan is not None and kept.plan is not None:
            solved += 1
            assert unfolded.plan.cost == kept.plan.cost
            steps = [(o.name, o.arguments) for o in unfolded.plan.operators]
            assert Interpreter(task).run(steps) == unfolded.plan.cost
    assert 5 <= solved <= 24


def test_nothing_is_instantiated_of_bindings_that_no_condition_asks_for() -> None:
    objects = " ".join(f"o{i}" for i in range(60))
    text = f"(define (problem p) (:domain d) (:objects {objects}) (:init (obj o0) (fits o1 o0 o2)) (:goal (at o0 o1)))"
    task = parse_task(text, parse_domain(DOMAIN.format(body=FREE, more="")))
    instantiated = instantiate(task)
    assert [str(operator) for operator in instantiated.operators] == ["(put o0 o1 o2)"]
    assert instantiated.axioms == ()


def test_types_of_the_head_are_kept() -> None:
    domain = parse_domain(
        "(define (domain d) (:types a b - object) (:predicates (p ?x) (d ?x ?y) (done))"
        " (:derived (d ?x - a ?y - b) (not (p ?y)))"
        " (:action go :parameters (?x ?y) :precondition (d ?x ?y) :effect (done)))"
    )
    text = (
        "(define (problem q) (:domain d) (:objects x - a y - b z - object) (:init) (:goal (done)))"
    )
    assert [str(operator) for operator in instantiate(parse_task(text, domain)).operators] == [
        "(go x y)"
    ]
    assert Normalizer(domain).definitions["d"][0].head == Atom("d", ("?x", "?y"))


TYPED = """(define (domain d) (:types a b - object) (:constants x - a y - b) (:predicates (done) (d ?v))
 (:derived (d ?v - a) (done)) (:action go :effect (done)))"""


@pytest.mark.parametrize(
    ("goal", "solvable"),
    [
        ("(d x)", True),
        ("(d y)", False),
        ("(a x)", True),
        ("(a y)", False),
        ("(not (a x))", False),
        ("(not (a y))", True),
    ],
)  # fmt: skip
def test_a_goal_may_ask_for_the_type_of_an_object(goal: str, solvable: bool) -> None:
    """Unfolded, a rule's head asks it; no other condition here does."""
    text = f"(define (problem q) (:domain d) (:init) (:goal {goal}))"
    found = search(
        instantiate(parse_task(text, parse_domain(TYPED))), search="astar", heuristic="blind"
    )
    assert (found.plan is not None) == solvable
