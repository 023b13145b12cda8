"""What other planners read is read here: oddities of published files, encodings, and words glued together."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.planner.pddl_only.problem import load_symbolic
from tamp.planner.pddl_only.solve import solve_symbolic
from tamp.symbolic.pddl.parser import parse_domain, parse_task
from tamp.symbolic.pddl.structs import Atom, Domain, Task

DOMAIN = """(define (domain saw) (:requirements :typing)
 (:types board part - object)
 (:constants)
 (:predicates (cut ?p - part) (near ?a ?b))
 (:functions (total-cost) - number)
 (:action saw :parameters (?p - part) :precondition () :effect (cut ?p)))
"""
PROBLEM = """(define (problem one) (:domain saw) (:objects p1 p2 - part b1 - board)
 (:init (near p1 p2))
 (:goal (cut p1)))
"""
SAW = ":parameters (?p - part) :precondition () :effect (cut ?p)"


def solved(
    tmp_path: Path, domain: str, problem: str = PROBLEM
) -> tuple[list[str], tuple[str, ...]]:
    """The plan's actions and the warnings of a domain and a problem in files."""
    (tmp_path / "d.pddl").write_text(domain, encoding="utf-8", newline="")
    (tmp_path / "p.pddl").write_text(problem, encoding="utf-8", newline="")
    loaded = load_symbolic(tmp_path / "d.pddl", tmp_path / "p.pddl")
    solution = solve_symbolic(loaded, max_time=20.0)
    assert solution.solved
    return [" ".join((step.name, *step.arguments)) for step in solution.plan], loaded.warnings


READ = [
    # an empty list before a type
    ("(:objects p1 p2 - part b1", "(:objects - board p1 p2 - part b1"),
    ("(:types board", "(:types - object board"),
    (":parameters (?p - part)", ":parameters (- board ?p - part)"),
    ("(cut ?p - part)", "(cut - board ?p - part)"),
    # a name twice
    ("(near ?a ?b)", "(near ?a ?a)"),
    ("(near ?a ?b)", "(near ?a ?a - part)"),
    ("(near ?a ?b)", "(near ?a ?b) (near ?x ?y)"),
    ("(total-cost) - number", "(total-cost) - number (total-cost) - number"),
    ("(:types board part - object)", "(:types board part board - object)"),
    ("(:types board part - object)", "(:types board part part - part)"),
    ("(:objects p1 p2 - part b1", "(:objects p1 p1 p2 - part b1"),
    ("(:constants)", "(:constants p1 p2 p1 - part)"),
    (f"(:action saw {SAW})", f"(:action saw {SAW})(:action saw {SAW})"),
    # words without a blank between them
    ("(cut ?p - part)", "(cut?p - part)"),
    (":effect (cut ?p)", ":effect(cut?p)"),
    ("(total-cost) - number", "(total-cost) - number - part"),
    ("(total-cost) - number", "- part (total-cost) - number"),
    # the type of an object is only said to be a more general one, or another one in a problem
    ("(near p1 p2)", "(near p1 p2) (cut b1)"),
    ("(:constants)", "(:constants k - object)"),
    ("(near p1 p2)", "(near p1 p2) (cut k)"),
    # requirements, case, blanks
    ("(:requirements :typing)", ""),
    ("(:requirements :typing)", "(:requirements :typing :no-such-thing)"),
    ("(:action saw", "(:ACTION Saw"),
    ("(:action saw", "\f(:action\t\v saw"),
    ("(define (domain", "\ufeff(define (domain"),
    ("\n", "\r\n"),
    ("\n", "\r"),
    ("\n", " ; (a comment\r"),
]


@pytest.mark.parametrize(("old", "new"), READ)
def test_read_as_fast_downward_does(old: str, new: str, tmp_path: Path) -> None:
    domain, problem = DOMAIN.replace(old, new), PROBLEM.replace(old, new)
    assert (domain, problem) != (DOMAIN, PROBLEM)
    if "(cut k)" in new:
        domain = domain.replace("(:constants)", "(:constants k)")
    plan, _ = solved(tmp_path, domain, problem)
    assert plan == ["saw p1"]


@pytest.mark.parametrize(
    ("old", "new", "note"),
    [
        (
            "(:requirements :typing)",
            "(:requirements :typng)",
            "1:37: unknown requirement ':typng'. Did you mean",
        ),
        (
            "(near ?a ?b)",
            "(near ?a ?b) (near ?a ?b)",
            "predicate 'near' stands twice; first in line 4",
        ),
        (
            f"(:action saw {SAW})",
            f"(:action saw {SAW})(:action saw {SAW})",
            "action 'saw' stands twice",
        ),
        (
            f"(:action saw {SAW})",
            f"(:action saw {SAW})(:action saw :effect ())",
            "plans have it as 'saw~2'",
        ),
        (
            "(:constants)",
            "(:constants k k - part)",
            "3:16: constant 'k' stands twice; first in line 3",
        ),
        (
            "(cut ?p)))",
            "(and (cut ?p) (cut k))))",
            "'k' is only said to be an object, where a part is declared",
        ),
    ],
)
def test_what_is_odd_is_said(old: str, new: str, note: str) -> None:
    text = DOMAIN.replace(old, new)
    assert text != DOMAIN
    if "(cut k)" in new:
        text = text.replace("(:constants)", "(:constants k)")
    assert any(note in found for found in parse_domain(text, "d.pddl").notes)


def test_a_parameter_twice_is_one_of_both_types(tmp_path: Path) -> None:
    """As Fast Downward has it: the plan says the object twice."""
    types = "(:types board part - object both - (either board part))"
    text = DOMAIN.replace("(:types board part - object)", types).replace(
        "(?p - part)", "(?p - board ?p - part)"
    )
    problem = PROBLEM.replace("b1 - board", "b1 - board w - both").replace("(cut p1)", "(cut w)")
    assert solved(tmp_path, text, problem)[0] == ["saw w w"]
    task = parse_task(
        PROBLEM.replace("(cut p1)", "(forall (?x - board ?x - part) (cut ?x))"), parse_domain(text)
    )
    assert (
        solved(
            tmp_path, text, PROBLEM.replace("(cut p1)", "(forall (?x - board ?x - part) (cut ?x))")
        )[0]
        == []
    )
    assert "~" in str(task.goal)


def test_a_rule_about_one_object_twice(tmp_path: Path) -> None:
    rule = "(:derived (near ?x ?x) (cut ?x))"
    text = DOMAIN.replace("(:action", f"{rule} (:action")
    problem = PROBLEM.replace("(near p1 p2)", "").replace(
        "(cut p1)", "(and (near p2 p2) (not (near p1 p2)))"
    )
    assert solved(tmp_path, text, problem)[0] == ["saw p2"]


def test_two_actions_of_one_name_are_both_there(tmp_path: Path) -> None:
    other = "(:action saw :parameters (?b - board) :effect (near ?b ?b))"
    problem = PROBLEM.replace("(cut p1)", "(and (cut p1) (near b1 b1))")
    plan, _ = solved(tmp_path, DOMAIN.replace("(:action", f"{other} (:action"), problem)
    assert sorted(plan) == ["saw b1", "saw~2 p1"]


FEATURES = [
    ("domain", "(:constants)", "(@@:durative-action a)", "durative actions"),
    ("domain", "(:constants)", "(@@:process a)", "processes"),
    ("domain", "(:constants)", "(@@:event a)", "events"),
    ("domain", "(:constants)", "(@@:constraints (and))", "trajectory constraints"),
    ("domain", "(:constants)", "(@@:task a)", "hierarchical tasks"),
    (
        "domain",
        "(total-cost) - number",
        "(total-cost) - number (spot ?x) - @@part",
        "object fluents",
    ),
    ("domain", ":precondition ()", ":precondition (@@>= (total-cost) 3)", "numeric fluents"),
    (
        "domain",
        ":precondition ()",
        ":precondition (= @@(total-cost) 3)",
        "numeric or object fluents",
    ),
    ("domain", ":precondition ()", ":precondition (@@preference p (cut ?p))", "preferences"),
    ("domain", ":precondition ()", ":precondition (@@over all (cut ?p))", "durative actions"),
    ("domain", ":precondition ()", "@@:duration (= ?duration 5)", "durative actions"),
    ("domain", ":effect (cut ?p)", ":effect (@@decrease (total-cost) 1)", "numeric fluents"),
    ("domain", ":effect (cut ?p)", ":effect (@@assign (total-cost) 1)", "numeric fluents"),
    ("domain", ":effect (cut ?p)", ":effect (increase @@(fuel) 1)", "numeric fluents"),
    (
        "domain",
        ":effect (cut ?p)",
        ":effect (@@probabilistic 0.5 (cut ?p))",
        "probabilistic effects",
    ),
    ("problem", "(near p1 p2)", "@@(at 5 (cut p1))", "timed initial literals"),
    ("problem", "(near p1 p2)", "(= (total-cost) @@p1)", "object fluents"),
    ("problem", "(:goal (cut p1))", "(:goal (@@preference p (cut p1)))", "preferences"),
    ("problem", "(:goal (cut p1))", "(:goal (@@sometime (cut p1)))", "trajectory constraints"),
    (
        "problem",
        "(:goal (cut p1))",
        "(@@:constraints (and)) (:goal (cut p1))",
        "trajectory constraints",
    ),
    (
        "problem",
        "(:goal (cut p1))",
        "(:goal (cut p1)) (:metric minimize @@(is-violated p))",
        "preferences",
    ),
    (
        "problem",
        "(:goal (cut p1))",
        "(:goal (cut p1)) (:metric minimize @@(+ (total-cost) (fuel)))",
        "numeric",
    ),
    (
        "problem",
        "(:goal (cut p1))",
        "(:goal (cut p1)) (:metric minimize @@total-time)",
        "durations",
    ),
    (
        "problem",
        "(:goal (cut p1))",
        "(:goal (cut p1)) (:metric @@maximize (total-cost))",
        "metrics to maximize",
    ),
]


@pytest.mark.parametrize(("kind", "old", "new", "feature"), FEATURES)
def test_a_feature_is_refused_by_its_name_where_it_stands(
    kind: str, old: str, new: str, feature: str, raises_at: Callable[..., InputError]
) -> None:
    def parse(text: str) -> Domain | Task:
        return parse_domain(text) if kind == "domain" else parse_task(text, parse_domain(DOMAIN))

    marked = (DOMAIN if kind == "domain" else PROBLEM).replace(old, new)
    raises_at(parse, marked, f"tamp has no {feature}")


def test_words_of_features_are_ordinary_predicates() -> None:
    text = "(define (domain d) (:predicates (at ?x ?y) (over ?x) (within ?x) (unknown ?x)) (:constants truck depot))"
    task = parse_task(
        "(define (problem p) (:domain d) (:init (at truck depot) (over truck)) (:goal (within truck)))",
        parse_domain(text),
    )
    assert ("at", "truck", "depot") in task.initial
    assert task.goal == Atom("within", ("truck",))


def chain(links: int) -> str:
    types = " ".join(f"t{i} - t{i + 1}" for i in range(links))
    return f"(define (domain d) (:types {types}) (:predicates (p ?x - t0)))"


def lattice(layers: int) -> str:
    """Each type stands below both types of the next layer: 2^layers ways up."""
    pairs = (f"a{i} b{i} - (either a{i + 1} b{i + 1})" for i in range(layers))
    return f"(define (domain d) (:types {' '.join(pairs)}) (:constants k - a0) (:predicates (p ?x - c)) (:types))"


HOSTILE = [
    (chain(10_000), "stands below 200 others"),
    (chain(9_999).replace("- t9999)", "- t0)"), "types form a cycle: t0 - t1"),
    ("(" * 1_000_000, "nested more than 100"),
    (
        chain(2).replace(
            "t0)))", "t0)) " + "(:action a :effect " + "(and " * 500 + ")" * 501 + ")"
        ),
        "nested more than",
    ),
    (
        f"(define (domain d) (:action a :effect (increase (total-cost) {'9' * 5000})))",
        "a word of 5,000 characters",
    ),
    (
        f"(define (domain d) (:action a :effect (increase (total-cost) {'9' * 900})))",
        "expected a number",
    ),
    (f"(define (domain {'n' * 100_000}))", "a word of 100,000 characters"),
    ("(define (domain d\x00))", "a control character (U+0000) in a word"),
    ("(define (domain d\x1b[31m))", "a control character (U+001B) in a word"),
    ("(define (domain d) " + "(a b) " * 400_000, "more than 1,000,000 words"),
    ("(define (domain d) " + "(:predicates (b)) (:action a :effect (a " * 40, "is never closed"),
    (
        f"(define (domain d) (:predicates (p {'?x ' * 20_000})) (:action a :effect (p)))",
        "'p' takes 20000 arguments",
    ),
]


@pytest.mark.parametrize(("text", "message"), HOSTILE, ids=range(len(HOSTILE)))
def test_hostile_texts_are_refused_soon(text: str, message: str) -> None:
    began = time.process_time()
    with pytest.raises(InputError) as caught:
        parse_domain(text, "d.pddl")
    assert message in str(caught.value)
    assert len(str(caught.value)) < 3_000
    assert time.process_time() - began < 40.0


def test_types_below_two_others_many_times_over() -> None:
    began = time.process_time()
    with pytest.raises(InputError, match="unknown type 'c'"):
        parse_domain(lattice(60).replace("(:types))", ")"))
    domain = parse_domain(lattice(60).replace("- c))", "- a60))").replace("(:types))", ")"))
    assert domain.is_a("a0", "b60")
    assert not domain.is_a("b60", "a0")
    assert time.process_time() - began < 15.0


def test_a_contradiction_at_the_start() -> None:
    for init, message in (
        ("(near p1 p2) (not (near p1 p2))", "is said and denied at the start"),
        ("(= (total-cost) 0) (= (total-cost) 1)", "has two values at the start, 0 and 1"),
    ):
        with pytest.raises(InputError, match=message):
            parse_task(PROBLEM.replace("(near p1 p2)", init), parse_domain(DOMAIN))
