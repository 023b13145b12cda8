"""What files written for PDDLStream take for granted: loose declarations, states that decide, numbers without end."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import count
from typing import Any

import pytest

from tamp.errors import InputError
from tamp.pddlstream import PDDLProblem, WildOutput, from_fn, from_gen_fn, from_test, solve
from tamp.symbolic.algorithms.registry import ALGORITHMS

SHELF = """
(define (domain shelf)
  (:predicates (Book ?b) (On ?b) (Reach ?b ?t) (Read ?b))
  (:action take :parameters (?b ?t) :precondition (and (Book ?b) (On ?b) (Reach ?b ?t))
    :effect (and (Read ?b) (not (On ?b)))))
"""
REACHES = """
(define (stream shelf)
  (:stream reach :inputs (?b) :domain (Book ?b) :fluents (On) :outputs (?t) :certified (Reach ?b ?t)))
"""


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_a_way_through_other_states_is_found(algorithm: str) -> None:
    """Nothing but the function says that books are taken from the left."""

    def reach(book: str, fluents: Sequence[tuple[str, str]]) -> tuple[str] | None:
        return None if any(other < book for _, other in fluents) else (f"way to {book}",)

    books = ("b1", "b2", "b3")
    init = [(name, book) for book in books for name in ("Book", "On")]
    problem = PDDLProblem(SHELF, {}, REACHES, {"reach": from_fn(reach)}, init, ("Read", "b3"))
    solution = solve(problem, algorithm, max_time=20.0)
    assert [action.args[0] for action in solution.plan or []] == list(books)


MONEY = """
(define (domain money)
  (:constants @price)
  (:predicates (Machine ?m) (Purse ?c) (Note ?n) (Stock ?c) (Plus ?a ?n ?b) (Enough ?a ?b)
    (Has ?c) (Holds ?m ?c) (Done))
  (:action withdraw :parameters (?m ?n ?a ?b ?s ?r)
    :precondition (and (Machine ?m) (Plus ?a ?n ?b) (Plus ?r ?n ?s) (Has ?a) (Holds ?m ?s))
    :effect (and (Has ?b) (Holds ?m ?r) (not (Has ?a)) (not (Holds ?m ?s)) (increase (total-cost) (Fee ?m))))
  (:action pay :parameters (?c) :precondition (and (Has ?c) (Enough ?c @price)) :effect (Done)))
"""
SUMS = """
(define (stream money)
  (:stream note :outputs (?n) :certified (Note ?n))
  (:stream add :inputs (?a ?n) :domain (and (Purse ?a) (Note ?n))
    :outputs (?b) :certified (and (Purse ?b) (Plus ?a ?n ?b)))
  (:stream take :inputs (?s ?n) :domain (and (Stock ?s) (Note ?n))
    :outputs (?r) :certified (and (Stock ?r) (Plus ?r ?n ?s)))
  (:stream enough :inputs (?a ?b) :domain (and (Purse ?a) (Price ?b)) :certified (Enough ?a ?b)))
"""


def notes() -> Iterator[tuple[int]]:
    yield from ((value,) for value in (1, 2, 5, 10))


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_sums_of_sums_do_not_hide_the_short_plan(algorithm: str) -> None:
    functions = {
        "note": from_gen_fn(notes),
        "add": from_fn(lambda a, n: (a + n,)),
        "take": from_fn(lambda s, n: (s - n,) if s >= n else None),
        "enough": from_test(lambda a, b: a >= b),
    }
    init: list[Any] = [("Has", 2), ("Purse", 2), ("Price", 13)]
    for machine, stock in (("m1", 7), ("m2", 20)):
        init += [
            ("Machine", machine),
            ("Holds", machine, stock),
            ("Stock", stock),
            ("=", ("Fee", machine), 1),
        ]
    solution = solve(
        PDDLProblem(MONEY, {"@price": 13}, SUMS, functions, init, ("Done",)),
        algorithm,
        max_time=20.0,
    )
    assert solution.plan is not None
    purse = 2
    for action in solution.plan[:-1]:
        assert action.args[2:4] == (purse, purse + action.args[1])
        purse = action.args[3]
    assert purse >= 13
    assert solution.cost == pytest.approx(len(solution.plan) - 1)


LOOSE = """
(define (domain loose)
  (:predicates (Ready ?x) (Near ?x) (Gone ?x))
  (:action leave :parameters (?x ?y) :precondition (and (Near ?x ?y) (Ready ?x))
    :effect (and (Gone ?x) (increase (total-cost) (Toll ?x ?y))))
  (:derived (Near ?x ?y) (and (Ready ?x) (Ready ?y) (not (= ?x ?y)))))
"""


def test_loose_declarations_are_taken_as_they_are_meant() -> None:
    init: list[Any] = [("Ready", "a"), ("Ready", "b"), ("Kilometres", "a", 3)]
    init += [("=", ("Toll", *pair), 7) for pair in ("ab", "ba")]
    loose = PDDLProblem(
        LOOSE, {"@elsewhere": 1}, "(define (stream none))", {"Collision": even}, init, ("Gone", "a")
    )
    solution = solve(loose)
    assert [(action.name, action.args) for action in solution.plan or []] == [("leave", ("a", "b"))]
    assert solution.cost == 7
    for told in ("'near' is declared with 1", "'kilometres'", "'collision'", "'@elsewhere'"):
        assert [text for text in solution.warnings if told in text], told
    for init_, functions, meant in (
        ([("Raedy", "a")], {}, "ready"),
        ([("=", ("Tol", "a", "b"), 7)], {}, "toll"),
    ):
        with pytest.raises(InputError, match=meant):
            solve(
                PDDLProblem(
                    LOOSE, {}, "(define (stream none))", functions, [*init, *init_], ("Gone", "a")
                )
            )


def even(number: int) -> bool:
    return number % 2 == 0


WALL = """
(define (domain wall)
  (:predicates (Brick ?b) (Standing ?b) (Gone ?b) (Way ?b ?t) (Hits ?t ?b) (Tool ?x) (Firm))
  (:action remove :parameters (?b ?t ?tool)
    :precondition (and (Way ?b ?t) (Standing ?b) (Firm) (forall (?other) (imply (Hits ?t ?other) (Gone ?other))))
    :effect (and (Gone ?b) (not (Standing ?b)))))
"""
WAYS = """
(define (stream wall)
  (:wild-stream way :inputs (?b) :domain (Brick ?b) :outputs (?t) :certified (Way ?b ?t))
  (:stream firm :fluents (Standing) :certified (Firm)))
"""


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_wild_streams_tests_of_the_state_and_parameters_that_nothing_mentions(
    algorithm: str,
) -> None:
    """A brick's way hits the one to its right; the tool makes no difference."""

    def way(brick: int) -> Iterator[WildOutput]:
        right = [("Hits", ("way", brick), brick + 1)] if brick < 3 else []
        yield WildOutput([(("way", brick),)], right)

    functions = {"way": way, "firm": from_test(lambda fluents: len(fluents) > 0)}
    init = [(name, brick) for brick in range(4) for name in ("Brick", "Standing")] + [
        ("Tool", "drill")
    ]
    goal = ("and", *(("Gone", brick) for brick in range(4)))
    solution = solve(PDDLProblem(WALL, {}, WAYS, functions, init, goal), algorithm, max_time=20.0)
    assert [action.args[0] for action in solution.plan or []] == [3, 2, 1, 0]


JUMP = """
(define (domain jump)
  (:predicates (Number ?n) (At ?n) (Ready) (Large ?n) (Done))
  (:action jump :parameters (?n) :precondition (Ready) :effect (and (At ?n) (not (Ready))))
  (:action finish :parameters (?n) :precondition (and (At ?n) (Large ?n)) :effect (Done)))
"""
NUMBERS = """
(define (stream jump)
  (:stream number :outputs (?n) :certified (Number ?n))
  (:stream large :inputs (?n) :domain (Number ?n) :certified (Large ?n)))
"""


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_a_parameter_that_only_an_effect_mentions_is_drawn(algorithm: str) -> None:
    functions = {
        "number": from_gen_fn(lambda: ((n,) for n in count())),
        "large": from_test(lambda n: n > 3),
    }
    solution = solve(
        PDDLProblem(JUMP, {}, NUMBERS, functions, [("Ready",)], ("Done",)), algorithm, max_time=20.0
    )
    assert [action.name for action in solution.plan or []] == ["jump", "finish"]
    assert {action.args[0] > 3 for action in solution.plan or []} == {True}
