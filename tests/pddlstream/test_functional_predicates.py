"""Predicates that Python decides, wherever PDDL has conditions: planned as if their facts were written in `init`."""

from __future__ import annotations

from random import Random
from typing import Any

import pytest

from tamp.pddlstream import Action, PDDLProblem, from_test, solve
from tamp.symbolic.algorithms.registry import ALGORITHMS
from tamp.symbolic.algorithms.result import Outcome

PEGS = ("a", "b", "c")

DOMAIN = """
(define (domain pegs)
  (:requirements :adl)
  (:predicates (Peg ?x) (Near ?x ?y) (Hot ?x) (Lit ?x) (Burnt ?x) (Warm ?x) (Safe) (Todo ?x))
  (:action light :parameters (?x)
    :precondition (and (Peg ?x) (not (Lit ?x)) (not (Burnt ?x)))
    :effect (and (Lit ?x)
      (forall (?y) (when (and (Peg ?y) (Near ?x ?y) (not (= ?x ?y))) (Burnt ?y)))
      (forall (?y) (when (and (Peg ?y) (not (Near ?x ?y)) (Burnt ?y)) (not (Burnt ?y))))
      (when (Warm ?x) (not (Todo ?x)))))
  (:action cool :parameters (?x)
    :precondition (and (Lit ?x) (not (Warm ?x)))
    :effect (and (not (Lit ?x)) (not (Todo ?x))))
  (:derived (Warm ?x) (or (Hot ?x) (exists (?y) (and (Near ?y ?x) (Lit ?y) (not (Hot ?y)))))))
"""

STREAMS = """
(define (stream pegs)
  (:predicate (Near ?x ?y) (and (Peg ?x) (Peg ?y)))
  (:stream hot :inputs (?x) :domain (Peg ?x) :certified (Hot ?x)))
"""

GOAL = ("forall", ("?x",), ("imply", ("Peg", "?x"), ("not", ("Todo", "?x"))))


def table(seed: int) -> tuple[set[tuple[str, str]], set[str]]:
    rng = Random(seed)
    near = {(x, y) for x in PEGS for y in PEGS if rng.random() < 0.5}
    return near, {x for x in PEGS if rng.random() < 0.3}


def init() -> list[Any]:
    return [(name, peg) for peg in PEGS for name in ("Peg", "Todo")]


def reached(plan: list[Action], near: set[tuple[str, str]], hot: set[str]) -> bool:
    """Whether the plan holds in a world of its own."""
    lit: set[str] = set()
    burnt: set[str] = set()
    todo = set(PEGS)
    for action in plan:
        (peg,) = action.args
        warm = peg in hot or any((other, peg) in near and other not in hot for other in lit)
        if action.name == "light":
            if peg in lit or peg in burnt:
                return False
            healed = {other for other in burnt if (peg, other) not in near}
            burnt = burnt - healed | {
                other for other in PEGS if (peg, other) in near and other != peg
            }
            lit.add(peg)
            todo -= {peg} if warm else set()
        elif peg not in lit or warm:
            return False
        else:
            lit.discard(peg)
            todo.discard(peg)
    return not todo


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_conditions_of_effects_and_rules_needed_both_ways(algorithm: str) -> None:
    outcomes: dict[bool, int] = {True: 0, False: 0}
    for seed in range(25):
        near, hot = table(seed)
        functions = {
            "near": lambda x, y, near=near: (x, y) in near,
            "hot": from_test(lambda x, hot=hot: x in hot),
        }
        found = solve(
            PDDLProblem(DOMAIN, {}, STREAMS, functions, init(), GOAL), algorithm, max_time=30.0
        )
        facts = [
            *init(),
            *(("Near", *pair) for pair in sorted(near)),
            *(("Hot", peg) for peg in sorted(hot)),
        ]
        written = solve(PDDLProblem(DOMAIN, {}, None, {}, facts, GOAL), max_time=30.0)
        assert found.solved == written.solved, seed
        assert found.solved or found.outcome in (Outcome.INFEASIBLE, Outcome.EXHAUSTED), seed
        assert not found.solved or reached(found.plan or [], near, hot), (seed, found.plan)
        outcomes[found.solved] += 1
    assert min(outcomes.values()) >= 5, "both outcomes are tested"
