"""Classical planning domains with quantifiers, conditional effects and derived predicates; see `classical_domains`."""

from __future__ import annotations

from random import Random

from benchmarks.pddl_task import Task, problem

MICONIC = """
(define (domain miconic)
  (:requirements :adl)
  (:types passenger floor - object vip never-alone attendant - passenger)
  (:predicates (from ?p - passenger ?f - floor) (to ?p - passenger ?f - floor) (barred ?p - passenger ?f - floor)
    (boarded ?p - passenger) (served ?p - passenger) (lift-at ?f - floor) (above ?a ?b - floor))
  (:action stop :parameters (?f - floor)
    :precondition (and (lift-at ?f)
      (imply (exists (?p - vip) (not (served ?p)))
             (exists (?p - vip) (and (not (served ?p)) (or (from ?p ?f) (to ?p ?f)))))
      (forall (?p - passenger) (imply (barred ?p ?f) (not (boarded ?p))))
      (imply (exists (?p - never-alone) (or (and (from ?p ?f) (not (served ?p))) (and (boarded ?p) (not (to ?p ?f)))))
             (exists (?q - attendant) (or (and (boarded ?q) (not (to ?q ?f))) (and (from ?q ?f) (not (served ?q)))))))
    :effect (and
      (forall (?p - passenger) (when (and (boarded ?p) (to ?p ?f)) (and (not (boarded ?p)) (served ?p))))
      (forall (?p - passenger) (when (and (from ?p ?f) (not (served ?p))) (boarded ?p)))))
  (:action up :parameters (?a ?b - floor) :precondition (and (lift-at ?a) (above ?b ?a))
    :effect (and (lift-at ?b) (not (lift-at ?a))))
  (:action down :parameters (?a ?b - floor) :precondition (and (lift-at ?a) (above ?a ?b))
    :effect (and (lift-at ?b) (not (lift-at ?a)))))
"""


def miconic(size: int, rng: Random) -> Task:
    """A lift serves `size` passengers, some with wishes: quantified preconditions, conditional effects."""
    floors = [f"f{i}" for i in range(size + 2)]
    special = ("vip", "never-alone", "attendant") if size >= 3 else ()
    kinds = {f"p{i}": special[i] if i < len(special) else "passenger" for i in range(size)}
    init = ["(lift-at f0)", *(f"(above {b} {a})" for i, a in enumerate(floors) for b in floors[i + 1 :])]
    for name in kinds:
        start, end, barred = rng.sample(floors, 3)
        init += [f"(from {name} {start})", f"(to {name} {end})"]
        if rng.random() < 0.2:
            init.append(f"(barred {name} {barred})")
    objects = " ".join(floors) + " - floor " + " ".join(f"{name} - {kind}" for name, kind in kinds.items())
    return MICONIC, problem("miconic", objects, init, ["(forall (?p - passenger) (served ?p))"])


NETWORK = """
(define (domain network)
  (:requirements :typing :derived-predicates :negative-preconditions)
  (:types node line - object source - node)
  (:predicates (joins ?l - line ?a ?b - node) (closed ?l - line) (faulty ?l - line) (fed ?n - node)
    (linked ?a ?b - node) (unsafe) (mended ?l - line))
  (:derived (linked ?a ?b - node) (exists (?l - line) (and (closed ?l) (or (joins ?l ?a ?b) (joins ?l ?b ?a)))))
  (:derived (fed ?n - source) (linked ?n ?n))
  (:derived (fed ?n - node) (exists (?m - node) (and (linked ?n ?m) (fed ?m))))
  (:derived (unsafe) (exists (?l - line ?a ?b - node) (and (faulty ?l) (not (mended ?l)) (joins ?l ?a ?b)
    (or (fed ?a) (fed ?b)) (closed ?l))))
  (:action open :parameters (?l - line) :precondition (closed ?l) :effect (not (closed ?l)))
  (:action close :parameters (?l - line) :precondition (and (not (closed ?l)) (not (unsafe))) :effect (closed ?l))
  (:action mend :parameters (?l - line ?a ?b - node)
    :precondition (and (joins ?l ?a ?b) (faulty ?l) (not (fed ?a)) (not (fed ?b))) :effect (mended ?l)))
"""


def network(size: int, rng: Random) -> Task:
    """A supply network of `size` nodes: which are fed is derived, recursively; faulty lines must be mended unfed."""
    nodes = [f"n{i}" for i in range(size)]
    lines: list[tuple[str, str]] = [("main", "main")]
    lines += [(rng.choice(["main", *nodes[:i]]), node) for i, node in enumerate(nodes)]
    lines += [(a, b) for a, b in ((rng.choice(nodes), rng.choice(nodes)) for _ in range(size // 3)) if a != b]
    init = [f"(joins l{i} {a} {b})" for i, (a, b) in enumerate(lines)]
    init += [f"(closed l{i})" for i in range(len(lines)) if i == 0 or rng.random() < 0.3]
    init += [f"(faulty l{i})" for i in range(1, len(lines)) if rng.random() < 0.3]
    goal = [f"(fed {node})" for node in nodes] + ["(not (unsafe))"]
    objects = f"main - source {' '.join(nodes)} - node {' '.join(f'l{i}' for i in range(len(lines)))} - line"
    return NETWORK, problem("network", objects, init, goal)
