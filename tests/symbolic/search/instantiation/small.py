"""A small world in PDDL, and the parts of its instantiation, for tests of one part at a time."""

from __future__ import annotations

from dataclasses import dataclass

from tamp.symbolic.pddl.parser import parse_domain, parse_task
from tamp.symbolic.pddl.structs import Action, Fact, Task
from tamp.symbolic.search.instantiation.negation import Negation
from tamp.symbolic.search.instantiation.normal_form import Normalizer
from tamp.symbolic.search.instantiation.predicate_kinds import NOTHING, Assumed, PredicateKinds

DOMAIN = """
(define (domain small)
  (:requirements :adl :derived-predicates :action-costs)
  (:types thing place)
  (:predicates (at ?x - thing ?p - place) (wet ?x - thing) (dry ?p - place) (lamp ?p - place)
    (near ?p ?q - place) (clear ?x - thing ?p - place) (busy ?p - place) (jam ?p - place)
    (dark ?p - place) (safe ?p - place) (hot ?p - place) (way ?p ?q - place) (blocked ?x - thing)
    (twin ?p ?q - place) (floor ?p - place))
  (:functions (total-cost) (length ?p ?q - place))
  (:action change :parameters (?x - thing ?p - place)
    :effect (and (not (at ?x ?p)) (at ?x ?p) (wet ?x) (not (wet ?x)) (lamp ?p) (not (lamp ?p))
      (dry ?p) (not (dry ?p))))
  {body})
"""
PROBLEM = """
(define (problem p) (:domain small) (:objects {objects}) (:init {init}) (:goal (and))
  (:metric minimize (total-cost)))
"""


@dataclass(frozen=True)
class Parts:
    """What the parts of an instantiation share."""

    task: Task
    normalizer: Normalizer
    predicates: PredicateKinds
    negation: Negation

    def action(self, name: str) -> Action:
        return next(action for action in self.task.domain.actions if action.name == name)


def parts(
    body: str,
    init: str = "",
    reached: str = "",
    assumed: Assumed = NOTHING,
    objects: str = "box cup - thing a b c - place",
) -> Parts:
    """The relations hold the initial facts and what is `reached`: "at box a, wet box"."""
    domain = parse_domain(DOMAIN.format(body=body))
    task = parse_task(PROBLEM.format(init=init, objects=objects), domain)
    normalizer = Normalizer(domain)
    predicates = PredicateKinds(task, normalizer, assumed)
    for one in map(fact, reached.split(",") if reached else ()):
        predicates.relations.add(one[0], [one[1:]])
    return Parts(task, normalizer, predicates, Negation(predicates, predicates.recursive()))


def fact(text: str) -> Fact:
    return tuple(text.split())


def facts(text: str) -> frozenset[Fact]:
    """Facts apart by commas: "at box a, wet box"."""
    return frozenset(fact(one) for one in text.split(",") if one.strip())
