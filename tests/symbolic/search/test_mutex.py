"""Goals that are said to exclude each other do, on random tasks against brute force; and the fewest are named."""

from __future__ import annotations

import time
from random import Random

import pytest

from tamp.symbolic.pddl.parser import parse_domain
from tamp.symbolic.pddl.tasks import parse_task
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.mutex import excluded
from tamp.system.deadline import Deadline
from tests.symbolic.search.interpreter import Interpreter
from tests.symbolic.search.test_random_tasks import random_task

TASKS = 800


def test_no_solvable_task_is_called_unsolvable() -> None:
    proven = unsolvable = 0
    for seed in range(TASKS):
        task = random_task(Random(seed))
        try:
            best = Interpreter(task).best(400)
        except OverflowError:
            continue
        found = excluded(instantiate(task), Deadline())
        assert best is None or found is None, (seed, found)
        unsolvable += best is None
        proven += found is not None
    assert proven > 0.9 * unsolvable > 100


@pytest.mark.parametrize("seed", [737, 2177])
def test_a_condition_that_adds_what_the_action_deletes_need_not_hold(seed: int) -> None:
    task = random_task(Random(seed))
    assert Interpreter(task).best(400) is not None
    assert excluded(instantiate(task), Deadline()) is None


ROOMS = """
(define (domain rooms)
  (:requirements :typing :negative-preconditions :derived-predicates :universal-preconditions)
  (:types ball room)
  (:predicates (at ?b - ball ?r - room) (carried ?b - ball) (free) (away ?b - ball) (moved))
  (:derived (away ?b - ball) (exists (?r - room) (and (at ?b ?r) (not (at ?b hall)))))
  (:action take :parameters (?b - ball ?r - room) :precondition (and (at ?b ?r) (free))
    :effect (and (carried ?b) (not (at ?b ?r)) (not (free)) (moved)))
  (:action put :parameters (?b - ball ?r - room) :precondition (carried ?b)
    :effect (and (at ?b ?r) (free) (not (carried ?b)))))
"""


def told(goal: str, balls: int) -> set[str] | None:
    names = [f"b{i}" for i in range(balls)]
    init = " ".join(f"(at {name} hall)" for name in names)
    domain = parse_domain(
        ROOMS.replace("(:types ball room)", "(:types ball room) (:constants hall - room)"), None
    )
    text = (
        f"(define (problem p) (:domain rooms) (:objects {' '.join(names)} - ball den loft - room)"
        f" (:init {init} (free)) (:goal {goal}))"
    )
    found = excluded(instantiate(parse_task(text, domain, None)), Deadline())
    return (
        None
        if found is None
        else {" ".join(fact) if wanted else f"not {' '.join(fact)}" for fact, wanted in found}
    )


@pytest.mark.parametrize("balls", [2, 5, 20])
def test_the_fewest_are_named(balls: int) -> None:
    assert told("(and (at b0 den) (at b1 loft) (at b0 loft))", balls) == {"at b0 den", "at b0 loft"}
    assert told("(and (carried b0) (at b1 loft) (carried b1))", balls) == {
        "at b1 loft",
        "carried b1",
    }
    assert told("(and (carried b0) (carried b1))", balls) == {"carried b0", "carried b1"}
    assert told("(and (carried b0) (free))", balls) == {"carried b0", "free"}
    assert told("(and (away b0) (at b0 hall))", balls) == {"away b0", "at b0 hall"}
    assert told("(and (at b0 den) (not (moved)))", balls) == {"at b0 den", "not moved"}
    assert told("(and (forall (?b - ball) (at ?b den)) (carried b1))", balls) == {
        "at b1 den",
        "carried b1",
    }
    assert told("(and (at b0 den) (not (at b0 den)))", balls) == {"at b0 den", "not at b0 den"}


@pytest.mark.parametrize("balls", [2, 7, 20])
def test_a_choice_of_which_each_way_is_excluded_by_another_goal_is_no_choice(balls: int) -> None:
    """No pair of goals excludes it: each ball's own place excludes that ball alone."""
    everywhere = "(forall (?b - ball) (or (at ?b den) (at ?b hall)))"
    assert told(f"(and {everywhere} (exists (?b - ball) (at ?b loft)))", balls) == {"goal 2"}
    assert told(f"(and {everywhere} (exists (?b - ball) (at ?b den)))", balls) is None


def test_what_can_be_had_together_is_not_named() -> None:
    assert told("(and (forall (?b - ball) (at ?b den)) (free))", 5) is None
    assert told("(and (carried b0) (not (at b1 hall)) (not (free)))", 5) is None
    assert told("(or (and (at b0 den) (at b0 loft)) (at b1 den))", 5) is None


CIRCLES = """
(define (domain circles)
  (:requirements :typing :derived-predicates)
  (:types room)
  (:predicates (door ?a ?b - room) (reach ?a ?b - room) (shut))
  (:derived (reach ?a ?b - room) (door ?a ?b))
  (:derived (reach ?a ?b - room) (exists (?k - room) (and (reach ?a ?k) (reach ?k ?b))))
  (:action build :parameters (?a ?b - room) :precondition (not (shut)) :effect (door ?a ?b)))
"""


@pytest.mark.parametrize(
    "goal", ["(reach r0 r9)", "(not (reach r0 r9))", "(and (reach r0 r9) (not (reach r9 r0)))"]
)
def test_rules_that_lead_in_circles_come_to_an_end(goal: str) -> None:
    """The ways to reach a room through all others are as many as their orders."""
    names = " ".join(f"r{i}" for i in range(10))
    text = (
        f"(define (problem p) (:domain circles) (:objects {names} - room) (:init) (:goal {goal}))"
    )
    instantiated = instantiate(parse_task(text, parse_domain(CIRCLES, None), None))
    began = time.process_time()
    assert excluded(instantiated, Deadline()) is None
    assert time.process_time() - began < 50.0
