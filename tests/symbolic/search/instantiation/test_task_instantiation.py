"""Operators, guards and axioms that come out of small tasks written in PDDL."""

from __future__ import annotations

import pytest

from benchmarks.search import cupboard
from tamp.errors import InputError
from tamp.symbolic.pddl.parser import parse_domain, parse_task
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.operators import Guard, InstantiatedTask
from tamp.symbolic.search.search import Reason, search, unreachable

DOMAIN = """(define (domain d) (:requirements :adl :derived-predicates :action-costs)
  (:types node thing)
  (:predicates (at ?x - node) (edge ?x ?y - node) (seen ?x - node) (reach ?x ?y - node) (lamp) (dark))
  (:functions (total-cost) (length ?x ?y - node))
  {body})"""
PROBLEM = """(define (problem p) (:domain d) (:objects {objects}) (:init {init}) (:goal {goal})
  (:metric minimize (total-cost)))"""
MOVE = """(:action move :parameters (?x ?y - node) :precondition (and (at ?x) (edge ?x ?y))
  :effect (and (not (at ?x)) (at ?y)))"""


def ground(body: str, init: str, goal: str, objects: str = "a b c d - node") -> InstantiatedTask:
    domain = parse_domain(DOMAIN.format(body=body))
    return instantiate(parse_task(PROBLEM.format(objects=objects, init=init, goal=goal), domain))


def names(instantiated: InstantiatedTask) -> list[str]:
    return [str(operator) for operator in instantiated.operators]


def test_only_reachable_operators_are_instantiated() -> None:
    instantiated = ground(MOVE, "(at a) (edge a b) (edge b c) (edge d a)", "(at c)")
    assert names(instantiated) == ["(move a b)", "(move b c)"]
    assert instantiated.operators[0].static == {("edge", "a", "b")}
    assert instantiated.operators[0].positive == {("at", "a")}


def test_an_unreachable_goal_is_named() -> None:
    instantiated = ground(MOVE, "(at a) (edge a b)", "(and (at b) (at c) (seen a) (not (lamp)))")
    assert unreachable(instantiated) == (("at", "c"), ("seen", "a"))
    result = search(instantiated)
    assert result.plan is None
    assert result.reason is Reason.UNSOLVABLE


def test_a_fact_that_nothing_deletes_is_named() -> None:
    instantiated = ground(
        MOVE + "(:action light :parameters () :effect (lamp))", "(at a) (lamp)", "(not (lamp))"
    )
    assert unreachable(instantiated) == (("not", "lamp"),)
    assert search(instantiated).reason is Reason.UNSOLVABLE


def test_static_goals() -> None:
    assert search(ground(MOVE, "(at a) (edge a b)", "(edge a b)")).plan is not None
    assert unreachable(ground(MOVE, "(at a) (edge a b)", "(edge b a)")) == (("edge", "b", "a"),)


@pytest.mark.parametrize(
    "effect",
    ["(forall (?x - node) (not (at ?x)))", "(forall (?x - node) (when (at ?x) (not (at ?x))))"],
)
def test_deleting_all_is_unconditional_and_adding_wins(effect: str) -> None:
    jump = f"(:action jump :parameters (?x - node) :effect (and {effect} (at ?x)))"
    instantiated = ground(jump, "(at a)", "(at b)")
    (operator,) = (o for o in instantiated.operators if o.arguments == ("b",))
    assert operator.conditional == ()
    assert operator.deleted >= {("at", "a"), ("at", "c"), ("at", "d")}
    assert operator.added == {("at", "b")}
    both = ground(jump, "(at a)", "(and (at b) (at a))")
    assert search(both).reason is Reason.UNSOLVABLE
    assert search(instantiated).plan is not None


def test_conditional_effects_look_at_the_state_before() -> None:
    body = """(:action light :parameters () :effect (and (lamp) (when (lamp) (dark))))"""
    result = search(ground(body, "", "(dark)"), search="astar", heuristic="hmax")
    assert result.plan is not None
    assert len(result.plan.operators) == 2


@pytest.mark.parametrize("heuristic", ["ff", "hadd", "hmax", "blind"])
def test_recursive_axioms(heuristic: str) -> None:
    body = """(:derived (reach ?x ?y - node)
        (or (edge ?x ?y) (lamp) (exists (?z - node) (and (seen ?z) (edge ?x ?z) (reach ?z ?y)))))
      (:action see :parameters (?x - node) :precondition (not (dark)) :effect (seen ?x))"""
    init = "(edge a b) (edge b c) (edge c d) (edge d a)"
    instantiated = ground(body, init, "(reach a d)")
    result = search(instantiated, search="astar", heuristic=heuristic)
    assert result.plan is not None
    assert sorted(map(str, result.plan.operators)) == ["(see b)", "(see c)"]
    # negated: seeing everything makes everything reachable
    never = ground(body, init, "(and (seen b) (seen c) (seen d) (not (reach a a)))")
    assert search(never, search="astar", heuristic=heuristic).reason is Reason.UNSOLVABLE


def test_costs_are_looked_up() -> None:
    body = MOVE.replace("(at ?y)", "(at ?y) (increase (total-cost) (length ?x ?y))")
    init = "(at a) (edge a b) (edge b c) (edge a c) (= (length a b) 1) (= (length b c) 2) (= (length a c) 4)"
    result = search(ground(body, init, "(at c)"), search="astar", heuristic="hmax")
    assert result.plan is not None
    assert result.plan.cost == 3
    with pytest.raises(InputError, match="length b d"):
        ground(body, init + " (edge b d)", "(at c)")


def test_a_derived_fact_must_not_depend_on_its_negation() -> None:
    body = """(:derived (lamp) (not (dark))) (:derived (dark) (not (lamp)))
      (:action see :parameters (?x - node) :precondition (lamp) :effect (seen ?x))"""
    with pytest.raises(InputError, match=r"stratified|negation"):
        ground(body, "", "(seen a)")


def test_guards_are_lifted_by_tests_that_may_hold() -> None:
    task, facts, objects = cupboard(2, 1)
    place = next(
        o
        for o in instantiate(task, facts, objects).operators
        if o.name == "place" and "#p0_1" in o.arguments
    )
    other = frozenset([("at-pose", "o1", "#p1_1")])
    assert Guard(other, ("pose-clear", "o0", "#p0_1", "o1", "#p1_1")) in list(place.guards)
    assert len(place.guards) == 4  # two poses of the other body, for the pose and for the reach
    bare = [fact for fact in facts if not fact[0].endswith("-clear")]
    hard = next(
        o for o in instantiate(task, bare, objects).operators if o.arguments == place.arguments
    )
    assert other <= hard.negative  # nothing lifts it
    assert not hard.guards
    assumed = instantiate(task, bare, objects, assumed={"pose-clear": (), "reach-clear": ()})
    again = next(o for o in assumed.operators if o.arguments == place.arguments)
    assert set(again.guards) == set(place.guards)


def test_a_cartesian_product_is_never_enumerated() -> None:
    """Four parameters over 200 objects: 1.6 billion bindings, of which two are joined."""
    body = """(:action go :parameters (?w ?x ?y ?z - node)
        :precondition (and (edge ?w ?x) (edge ?x ?y) (edge ?y ?z) (not (= ?w ?z)) (at ?w)) :effect (at ?z))"""
    many = " ".join(f"n{i}" for i in range(200))
    init = "(at n0) (edge n0 n1) (edge n1 n2) (edge n2 n3) (edge n3 n4)"
    instantiated = ground(body, init, "(at n3)", many + " - node")
    assert names(instantiated) == ["(go n0 n1 n2 n3)"]


def test_quantified_disjunctive_and_negative_conditions() -> None:
    body = """(:action see :parameters (?x - node)
        :precondition (or (at ?x) (exists (?y - node) (and (seen ?y) (edge ?y ?x)))) :effect (seen ?x))
      (:action light :parameters ()
        :precondition (forall (?x ?y - node) (imply (edge ?y ?x) (seen ?x))) :effect (lamp))"""
    result = search(
        ground(body, "(at a) (edge a b) (edge a c)", "(lamp)"), search="astar", heuristic="hmax"
    )
    assert result.plan is not None
    assert sorted(map(str, result.plan.operators)) == ["(light)", "(see a)", "(see b)", "(see c)"]
