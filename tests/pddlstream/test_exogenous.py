"""Streams whose `:domain` names what actions change: they give values once it has come true."""

from __future__ import annotations

from typing import Any

import pytest

from tamp.errors import InputError
from tamp.pddlstream import PDDLProblem, Solution, from_fn, solve
from tamp.symbolic.algorithms.registry import ALGORITHMS
from tamp.symbolic.algorithms.result import Outcome

DOMAIN = """
(define (domain safes)
  (:predicates (Safe ?s) (Code ?c) (Opens ?c ?s) (Key ?k) (Turns ?k ?c) (Lit ?s) (Dark ?s) (Open ?s) (Sealed ?s)
    (Readable ?s))
  (:action light :parameters (?s) :precondition (and (Safe ?s) (not (Sealed ?s))) :effect (Lit ?s))
  (:action dim :parameters (?s) :precondition (Lit ?s) :effect (and (Dark ?s) (not (Lit ?s))))
  (:action open :parameters (?s ?c ?k) :precondition (and (Opens ?c ?s) (Turns ?k ?c) (Dark ?s)) :effect (Open ?s))
  (:derived (Readable ?s) (and (Safe ?s) (Lit ?s))))
"""

STREAMS = """
(define (stream safes)
  (:stream read :inputs (?s) :domain (and (Safe ?s) (Lit ?s)) :outputs (?c) :certified (and (Code ?c) (Opens ?c ?s)))
  (:stream cut :inputs (?c) :domain (Code ?c) :outputs (?k) :certified (and (Key ?k) (Turns ?k ?c))))
"""

FUNCTIONS = {
    "read": from_fn(lambda s: (f"code of {s}",)),
    "cut": from_fn(lambda c: (f"key of {c}",)),
}


def opened(
    algorithm: str, init: list[Any], domain: str = DOMAIN, streams: str = STREAMS
) -> Solution:
    problem = PDDLProblem(domain, {}, streams, FUNCTIONS, [("Safe", "s"), *init], ("Open", "s"))
    return solve(problem, algorithm, max_time=20.0)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_what_has_been_true_is_enough(algorithm: str) -> None:
    """The key is cut from the code, the code is read in light, and the safe is opened in the dark."""
    solution = opened(algorithm, [])
    assert [action.name for action in solution.plan or []] == ["light", "dim", "open"]
    assert (solution.plan or [])[-1].args == ("s", "code of s", "key of code of s")
    assert ("read-result", "s", "code of s") in solution.certificate


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_what_is_true_at_first_need_not_be_made_true(algorithm: str) -> None:
    assert [action.name for action in opened(algorithm, [("Lit", "s")]).plan or []] == [
        "dim",
        "open",
    ]
    known = [("Code", 7), ("Opens", 7, "s"), ("Key", 8), ("Turns", 8, 7), ("Dark", "s")]
    assert [action.args[:2] for action in opened(algorithm, known).plan or []] == [("s", 7)]


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_what_never_comes_true_gives_nothing(algorithm: str) -> None:
    solution = opened(algorithm, [("Sealed", "s"), ("Dark", "s")])
    assert not solution.solved
    assert solution.outcome is Outcome.INFEASIBLE
    assert [action.name for action in opened(algorithm, [("Dark", "s")]).plan or []] == [
        "light",
        "open",
    ]


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_what_rules_derive_has_to_be_true_still(algorithm: str) -> None:
    streams = STREAMS.replace("(Lit ?s)", "(Readable ?s)")
    solution = opened(algorithm, [], streams=streams)
    assert [action.name for action in solution.plan or []] == ["light", "dim", "light", "open"]


def test_what_waits_cannot_be_asked_to_be_false() -> None:
    domain = DOMAIN.replace("(Dark ?s)) :effect (Open", "(not (Code ?s))) :effect (Open")
    with pytest.raises(
        InputError, match=r"7:\d+: 'code' has to be false here, and its stream waits"
    ):
        opened("adaptive", [], domain)
