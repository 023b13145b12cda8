"""Symbolic search: time to instantiate and to solve, nodes per second. Writes results/search.jsonl.

python benchmarks/search.py
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from functools import partial
from random import Random

from benchmarks import common
from tamp.symbolic.pddl.parser import parse_domain
from tamp.symbolic.pddl.structs import And, Atom, Fact, Task
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.search import search

DOMAIN = """
(define (domain cupboard) ; the shipped one as it was when these figures were first measured
  (:requirements :adl :derived-predicates :action-costs)
  (:types movable fixed - body body surface - object pose grasp base-conf reach motion - object)
  (:predicates
    (at-pose ?o - movable ?p - pose) (holding ?o - movable ?g - grasp) (hand-empty) (at-base ?b - base-conf)
    (supported ?o - movable ?p - pose ?s - surface) (base-motion ?b - base-conf ?t - motion)
    (pick-motion ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?t - motion)
    (place-motion ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?t - motion)
    (pose-clear ?o - movable ?p - pose ?o2 - movable ?p2 - pose)
    (reach-clear ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?o2 - movable ?p2 - pose)
    (on ?o - body ?s - surface) (pose-blocked ?o - movable ?p - pose)
    (reach-blocked ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach))
  (:functions (total-cost))
  (:derived (on ?o - body ?s - surface) (exists (?p - pose) (and (supported ?o ?p ?s) (at-pose ?o ?p))))
  (:derived (pose-blocked ?o - movable ?p - pose)
    (exists (?o2 - movable ?p2 - pose)
      (and (at-pose ?o2 ?p2) (not (= ?o ?o2)) (not (pose-clear ?o ?p ?o2 ?p2)))))
  (:derived (reach-blocked ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach)
    (exists (?o2 - movable ?p2 - pose)
      (and (at-pose ?o2 ?p2) (not (= ?o ?o2)) (not (reach-clear ?o ?p ?g ?b ?q ?o2 ?p2)))))
  (:action move
    :parameters (?b - base-conf ?t - motion)
    :precondition (base-motion ?b ?t)
    :effect (and (forall (?b - base-conf) (when (at-base ?b) (not (at-base ?b)))) (at-base ?b)
                 (increase (total-cost) 1)))
  (:action pick
    :parameters (?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?t - motion)
    :precondition (and (pick-motion ?o ?p ?g ?b ?q ?t) (hand-empty) (at-base ?b) (at-pose ?o ?p)
                       (not (reach-blocked ?o ?p ?g ?b ?q)))
    :effect (and (holding ?o ?g) (not (hand-empty)) (not (at-pose ?o ?p)) (increase (total-cost) 1)))
  (:action place
    :parameters (?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?t - motion)
    :precondition (and (place-motion ?o ?p ?g ?b ?q ?t) (holding ?o ?g) (at-base ?b)
                       (not (pose-blocked ?o ?p)) (not (reach-blocked ?o ?p ?g ?b ?q)))
    :effect (and (at-pose ?o ?p) (hand-empty) (not (holding ?o ?g)) (increase (total-cost) 1))))
"""

TESTS = {"pose-clear": (), "reach-clear": ()}
Instance = tuple[Task, frozenset[Fact], dict[str, tuple[str, ...]]]


def cupboard(count: int, placements: int = 11, *, tests: bool = True) -> Instance:
    """The cupboard's optimistic task: `count` interchangeable bodies go from a table to a shelf.

    Each has a start pose and `placements` placeholders on the shelf, each of these a grasp, a base conf and motions.

    Args:
        count: Number of bodies.
        placements: Placeholders a body.
        tests: Whether collision tests are assumed to succeed; otherwise no pose is known to be clear of another.
    """
    domain = parse_domain(DOMAIN)
    objects: dict[str, tuple[str, ...]] = {"table": ("fixed", "surface"), "shelf": ("fixed", "surface")}
    initial: set[Fact] = {("hand-empty",), ("at-base", "b0")}
    facts: set[Fact] = set()
    objects["b0"] = ("base-conf",)
    poses: list[tuple[str, str, str]] = []
    for i in range(count):
        body = f"o{i}"
        objects[body] = ("movable",)
        objects[f"g{i}"] = ("grasp",)
        initial.add(("at-pose", body, f"{body}_start"))
        for k in range(placements + 1):
            pose = f"#p{i}_{k}" if k else f"{body}_start"
            base, reach, motion = f"#b{i}_{k}", f"#q{i}_{k}", f"#t{i}_{k}"
            objects |= {pose: ("pose",), base: ("base-conf",), reach: ("reach",)}
            objects |= {f"{motion}{m}": ("motion",) for m in ("base", "pick", "place")}
            kin = (body, pose, f"g{i}", base, reach)
            facts |= {
                ("supported", body, pose, "shelf" if k else "table"),
                ("base-motion", base, f"{motion}base"),
                ("pick-motion", *kin, f"{motion}pick"),
                ("place-motion", *kin, f"{motion}place"),
            }
            poses.append((body, pose, f"{i}_{k}"))
    if tests:
        for body, pose, i in poses:
            for other, at, _ in poses:
                if other != body:
                    facts.add(("pose-clear", body, pose, other, at))
                    facts.add(("reach-clear", body, pose, f"g{body[1:]}", f"#b{i}", f"#q{i}", other, at))
    goal = And(tuple(Atom("on", (f"o{i}", "shelf")) for i in range(count)))
    return Task(f"cupboard-{count}", domain, objects, frozenset(initial), goal, {}), frozenset(facts), {}


def effort(fact: Fact) -> float:
    """Prices such as `adaptive` sets: a little for each placeholder's stream, less for a test."""
    return 0.01 if fact[0].endswith("-clear") else 0.1


def measure(action: Callable[[], object], repeats: int) -> float:
    """The shortest of some runs, in milliseconds of CPU time: what a busy machine disturbs least."""
    best = math.inf
    for _ in range(repeats):
        start = time.process_time()
        action()
        best = min(best, time.process_time() - start)
    return 1e3 * best


def scale() -> None:
    """Instantiate and solve the cupboard with more and more bodies."""
    rows: list[dict[str, object]] = []
    for count in (4, 8, 12, 20):
        task, facts, objects = cupboard(count, tests=False)
        repeats = 5 if count <= 8 else 2
        instantiated = instantiate(task, facts, objects, assumed=TESTS)
        ready = measure(partial(instantiate, task, facts, objects, assumed=TESTS), repeats)
        for name in ("wastar", "greedy"):
            for kind, price in (("none", None), ("every fact", effort)):
                result = search(instantiated, search=name, price=price)
                solved = measure(partial(search, instantiated, search=name, price=price), repeats)
                row = {
                    "bodies": count,
                    "operators": len(instantiated.operators),
                    "facts": len(instantiated.reachable),
                    "search": name,
                    "prices": kind,
                    "instantiate_ms": ready,
                    "search_ms": solved,
                    "expanded": result.expanded,
                    "nodes_per_s": 1e3 * result.evaluated / solved,
                    "actions": len(result.plan.operators) if result.plan else 0,
                    "cost": result.plan.cost if result.plan else math.nan,
                }
                common.record("search.jsonl", config={"benchmark": "cupboard"}, **row)
                rows.append(row)
    common.table(rows, "Cupboard, 12 poses a body; milliseconds of CPU time")


def representations() -> None:
    """Subset tests, successors and membership of states as integers and as frozensets."""
    rows: list[dict[str, object]] = []
    for facts in (100, 500, 2000):
        rng = Random(0)
        states = [frozenset(rng.sample(range(facts), 20)) for _ in range(200)]
        needs = [frozenset(rng.sample(range(facts), 3)) for _ in range(50)]
        masks = [sum(1 << i for i in state) for state in states]
        needed = [sum(1 << i for i in need) for need in needs]

        def sets(states: list[frozenset[int]] = states, needs: list[frozenset[int]] = needs) -> None:
            seen: set[frozenset[int]] = set()
            for state in states:
                for need in needs:
                    if not need <= state:
                        seen.add((state - need) | need)

        def integers(states: list[int] = masks, needs: list[int] = needed) -> None:
            seen: set[int] = set()
            for state in states:
                for need in needs:
                    if need & state != need:
                        seen.add((state & ~need) | need)

        operations = len(states) * len(needs)
        row = {
            "facts": facts,
            "int_ns": 1e6 * measure(integers, 3) / operations,
            "frozenset_ns": 1e6 * measure(sets, 3) / operations,
        }
        common.record("search.jsonl", config={"benchmark": "states"}, **row)
        rows.append(row)
    common.table(rows, "One applicability test, successor and insertion; 20 facts hold")


if __name__ == "__main__":
    common.without_options(__doc__)
    scale()
    representations()
