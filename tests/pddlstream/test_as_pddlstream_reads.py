"""Files that PDDLStream reads: functions that only the streams file declares, facts of the start that streams find."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import count
from typing import Any

import pytest

from tamp.errors import InputError
from tamp.pddlstream import PDDLProblem, Solution, from_fn, from_gen_fn, from_test, solve

ALGORITHMS = ("adaptive", "incremental")

COSTS = """(define (domain costs) (:predicates (B ?x) (P ?x ?p) (At ?x ?p)) {functions}
 (:action go :parameters (?x ?p) :precondition (and (B ?x) (P ?x ?p))
  :effect (and (At ?x ?p) (increase (total-cost) (Cost ?x ?p)))))"""
MAKE = "(:stream make :inputs (?x) :domain (B ?x) :outputs (?p) :certified (P ?x ?p))"
COST = "(:function (Cost ?x ?p) (P ?x ?p))"


def priced(functions: str, streams: str, **more: Callable[..., Any]) -> Solution:
    known: dict[str, Any] = {
        "make": from_fn(lambda x: (x + "p",)),
        "Cost": lambda x, p: 2.0,
        **more,
    }
    texts = COSTS.format(functions=functions), f"(define (stream s) {streams})"
    return solve(
        PDDLProblem(
            texts[0], {}, texts[1], known, [("B", "a")], ("exists", ("?p",), ("At", "a", "?p"))
        )
    )


@pytest.mark.parametrize(
    ("functions", "note"),
    [
        ("", ""),
        ("(:functions (Cost ?x ?p))", ""),
        ("(:functions (Cost ?x))", "declared with 1 arguments, computed of 2"),
    ],
)
def test_a_function_of_the_streams_file(functions: str, note: str) -> None:
    solution = priced(functions, MAKE + COST)
    assert solution.plan is not None
    assert solution.cost == 2.0
    assert any(note in text for text in (*solution.warnings, ""))
    assert bool(note) == bool(solution.warnings)


def test_a_function_of_no_action_is_a_warning() -> None:
    solution = priced("", f"{MAKE}{COST}(:function (Duration ?x) (B ?x))", Duration=lambda x: 1.0)
    assert solution.cost == 2.0
    assert [
        text for text in solution.warnings if "function 'duration' is the cost of no action" in text
    ]


TABLE = """(define (domain table) (:predicates (Thing ?o) (OnTable ?o) (Held ?o) (Free) (Done ?o))
 (:action pick :parameters (?o) :precondition (and (Free) (OnTable ?o))
  :effect (and (Held ?o) (not (OnTable ?o)) (not (Free))))
 (:action drop :parameters (?o) :precondition (Held ?o) :effect (and (Free) (not (Held ?o)) (Done ?o)))
 (:action back :parameters (?o) :precondition (Held ?o) :effect (and (OnTable ?o) (Free) (not (Held ?o)))))"""
FIND = "(define (stream s) (:stream find :outputs (?o) :certified (and (Thing ?o) (OnTable ?o))))"


def things() -> Iterator[tuple[str]]:
    return ((f"thing{number}",) for number in count())


def found(
    goal: Any, algorithm: str, streams: str = FIND, domain: str = TABLE, **functions: Any
) -> Solution:
    known: dict[str, Any] = {"find": from_gen_fn(things), **functions}
    return solve(
        PDDLProblem(domain, {}, streams, known, [("Free",)], goal), algorithm, max_time=20.0
    )


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_what_a_stream_finds_holds_at_the_start_until_an_action_ends_it(algorithm: str) -> None:
    two = ("exists", ("?a", "?b"), ("and", ("Done", "?a"), ("Held", "?b")))
    solution = found(two, algorithm)
    assert solution.plan is not None, solution.explanation
    assert [action.name for action in solution.plan] == ["pick", "drop", "pick"]
    assert solution.plan[0].args != solution.plan[2].args  # the first one is no longer there
    assert ("ontable", solution.plan[0].args[0]) in solution.certificate


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_it_may_be_made_true_again_and_be_asked_to_be_false(algorithm: str) -> None:
    goal = ("exists", ("?o",), ("and", ("Thing", "?o"), ("Free",), ("not", ("OnTable", "?o"))))
    solution = found(goal, algorithm)
    assert solution.plan is not None, solution.explanation
    assert [action.name for action in solution.plan] == ["pick", "drop"]
    domain = TABLE.replace(
        "(OnTable ?o) (Free) (not (Held ?o))", "(OnTable ?o) (Free) (Done ?o) (not (Held ?o))"
    )
    both = ("exists", ("?o",), ("and", ("Done", "?o"), ("OnTable", "?o")))
    again = found(both, algorithm, domain=domain)
    assert again.plan is not None, again.explanation
    assert [action.name for action in again.plan] == ["pick", "back"]


@pytest.mark.parametrize(
    ("more", "goal", "message"),
    [
        (
            "(:stream test :inputs (?o) :domain (Thing ?o) :certified (Free))",
            ("not", ("Free",)),
            "'free' has to be false here, and a test that may still pass",
        ),
        (
            "(:stream test :inputs (?o) :domain (and (Thing ?o) (OnTable ?o)) :certified (Ok ?o))",
            ("Free",),
            "stream 'test' waits for 'ontable', which another stream certifies",
        ),
        (
            "(:stream test :inputs (?o) :domain (Thing ?o) :fluents (OnTable) :certified (Ok ?o))",
            ("Free",),
            "is shown 'ontable' through :fluents",
        ),
    ],
)
def test_what_has_no_meaning_is_refused(more: str, goal: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        found(goal, "adaptive", FIND[:-1] + more + ")", test=from_test(lambda o: True))


PARTS: tuple[Any, ...] = (TABLE, {}, FIND, {"find": from_gen_fn(things)}, [("Free",)], ("Free",))


@pytest.mark.parametrize(
    ("index", "part", "message"),
    [
        (0, None, "domain_pddl: expected the domain's text or a Path to it, found NoneType"),
        (0, b"(define)", "domain_pddl: expected"),
        (1, "debug", "constant_map: expected a dict"),
        (2, 3, "stream_pddl: expected"),
        (2, [3], "stream_pddl: expected"),
        (
            3,
            "debug",
            "stream_map: expected a dict of functions by stream, found str 'debug'. tamp has no placeholder",
        ),
        (3, None, "stream_map: expected"),
        (
            3,
            {"find": "debug"},
            r"stream_map\['find'\]: expected a function.*no placeholder streams",
        ),
        (4, "Free", "init: expected a list"),
        (4, None, "init: expected a list"),
        (4, [3], "expected an initial fact"),
        (5, "Free", "expected a condition"),
        (5, None, "goal: expected a condition"),
    ],
)
def test_parts_of_the_wrong_kind(index: int, part: Any, message: str) -> None:
    problem = (*PARTS[:index], part, *PARTS[index + 1 :])
    with pytest.raises(InputError, match=message):
        solve(problem)


@pytest.mark.parametrize("problem", [PARTS[:5], (*PARTS, 1), None, "problem", 3])
def test_a_problem_has_six_parts(problem: Any) -> None:
    with pytest.raises(
        InputError, match="a problem is a tuple of 6 parts: domain_pddl, constant_map"
    ):
        solve(problem)
