"""Which tests are taken to hold wherever they are asked for: those that can only lift a guard."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tamp.symbolic.algorithms.optimistic.assumable_tests import assumable, given_for
from tamp.symbolic.algorithms.result import Outcome, StreamTask
from tests.symbolic.algorithms.toys import replay, solve, stream_task

DOMAIN = """
(define (domain places)
  (:requirements :typing :negative-preconditions :derived-predicates :conditional-effects)
  (:types thing pose)
  (:predicates (pose ?o - thing ?p - pose) (at ?o - thing ?p - pose) (free ?o - thing ?p - pose ?q - pose) (done)
    (blocked ?o - thing ?p - pose) (given ?o - thing) EXTRA)
  (:derived (blocked ?o - thing ?p - pose)
    (exists (?o2 - thing ?q - pose) (and (at ?o2 ?q) (not (free ?o ?p ?q)))))
  (:action put :parameters (?o - thing ?p - pose)
    :precondition (and (pose ?o ?p) (not (blocked ?o ?p)) CONDITION)
    :effect (and (at ?o ?p) (when EFFECT (done)))))
"""
STREAMS = """
(define (stream places)
  (:stream draw :inputs (?o) :domain (thing ?o) :outputs (?p) :certified (pose ?o ?p))
  (:stream test :inputs (?o ?p ?q) :domain (and (pose ?o ?p) (pose ?o ?q)) :certified (free ?o ?p ?q))
  MORE)
"""


def task(
    condition: str = "(thing ?o)",
    effect: str = "(thing ?o)",
    more: str = "",
    streams: str = STREAMS,
) -> StreamTask:
    domain = DOMAIN.replace("CONDITION", condition).replace("EFFECT", effect).replace("EXTRA", "")
    functions = dict.fromkeys(("draw", "test", "other", "next"), lambda *values, call: iter(()))
    return stream_task(
        domain, streams.replace("MORE", more), functions, {"cup": ("thing",)}, "", "(done)"
    )


def names(problem: StreamTask) -> dict[str, str]:
    return {
        key: stream.name for key, (stream, _) in assumable(problem.streams, problem.task).items()
    }


def test_a_test_that_only_lifts_a_guard_is_assumable() -> None:
    problem = task()
    assert names(problem) == {"free": "test"}
    _, atom = assumable(problem.streams, problem.task)["free"]
    assert atom.terms == ("?o", "?p", "?q")


@pytest.mark.parametrize(
    "condition", ["(free ?o ?p ?p)", "(not (free ?o ?p ?p))", "(or (free ?o ?p ?p) (done))"]
)
def test_a_test_that_an_action_asks_for_is_not(condition: str) -> None:
    """In an action's condition even a negation counts as help: only rules become guards."""
    assert names(task(condition=condition)) == {}
    assert names(task(effect=condition)) == {}


@pytest.mark.parametrize(
    "more",
    [
        "(:stream other :inputs (?o ?p ?q) :domain (and (pose ?o ?p) (pose ?o ?q)) :certified (free ?o ?p ?q))",
        "(:stream next :inputs (?o ?p) :domain (free ?o ?p ?p) :outputs (?q) :certified (pose ?o ?q))",
    ],
)
def test_a_test_whose_fact_another_stream_certifies_or_needs_is_not(more: str) -> None:
    assert names(task(more=more)) == {}


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (":certified (free ?o ?p ?q))", ":certified (and (free ?o ?p ?q) (pose ?o ?q)))"),
        (":certified (free ?o ?p ?q))", ":certified (free ?o ?p ?p))"),
        (
            ":certified (free ?o ?p ?q))",
            ":outputs (?r) :certified (and (pose ?o ?r) (free ?o ?p ?q)))",
        ),
    ],
)
def test_it_certifies_one_fact_of_all_its_inputs(old: str, new: str) -> None:
    assert STREAMS.count(old) == 1
    assert names(task(streams=STREAMS.replace(old, new))) == {}


GUARD = "(not (exists (?o2 - thing ?q - pose) (and (at ?o2 ?q) (not (free ?o ?p ?q)))))"


@pytest.mark.parametrize(
    "rule",
    [
        "",
        f"(:derived (ok ?o - thing ?p - pose) {GUARD})",
        "(:derived (ok ?o - thing ?p - pose)"
        " (forall (?o2 - thing ?q - pose) (imply (at ?o2 ?q) (free ?o ?p ?q))))",
    ],
)
def test_polarity_is_that_of_the_normal_form(rule: str) -> None:
    """A condition of its own, or a rule that is unfolded, is a guard as a refuted rule is."""
    domain = DOMAIN.replace("EXTRA", "(ok ?o - thing ?p - pose)").replace("EFFECT", "(thing ?o)")
    domain = domain.replace("CONDITION", "(ok ?o ?p)" if rule else GUARD)
    domain = domain.replace("(:action put", f"{rule} (:action put")
    functions = dict.fromkeys(("draw", "test"), lambda *values, call: iter(()))
    streams = STREAMS.replace("MORE", "")
    problem = stream_task(domain, streams, functions, {"cup": ("thing",)}, "", "(done)")
    assert names(problem) == {"free": "test"}


APT = """
(define (domain places)
  (:types thing pose)
  (:predicates (apt ?o - thing ?p - pose) (at ?o - thing ?p - pose)
    (free ?o - thing ?p - pose ?q - pose) (done) (blocked ?o - thing ?p - pose))
  (:derived (blocked ?o - thing ?p - pose)
    (exists (?o2 - thing ?q - pose) (and (at ?o2 ?q) (not (free ?o ?p ?q)))))
  (:action put :parameters (?o - thing ?p - pose)
    :precondition (and (apt ?o ?p) CLEAR) :effect (and (at ?o ?p) (done))))
"""
APT_STREAMS = """
(define (stream places)
  (:stream draw :inputs (?o) :domain (thing ?o) :outputs (?p) :certified (apt ?o ?p))
  (:stream test :inputs (?o ?p ?q) :domain (and (apt ?o ?p) (apt ?o ?q))
    :certified (free ?o ?p ?q)))
"""


@pytest.mark.parametrize("clear", ["(not (blocked ?o ?p))", GUARD])
@pytest.mark.parametrize("algorithm", ["adaptive", "incremental"])
@pytest.mark.parametrize("apt", ["", "(apt cup p0) (apt box p0)"])
def test_a_test_is_asked_of_nothing_outside_of_its_domain(
    clear: str, algorithm: str, apt: str
) -> None:
    """No stream says (apt cup p0): that cup is free of what stands at p0 cannot be certified."""

    def draw(o: str, call: object) -> Iterator[tuple[object, ...]]:
        yield ((o, "drawn"),)

    problem = stream_task(
        APT.replace("CLEAR", clear),
        APT_STREAMS,
        {"draw": draw, "test": lambda *values, call: True},
        {"cup": ("thing",), "box": ("thing",), "p0": ("pose",)},
        f"(at box p0) {apt}",
        "(done)",
    )
    assert names(problem) == {"free": "test"}
    result = solve(algorithm, problem)
    assert result.outcome is (Outcome.SOLVED if apt else Outcome.INFEASIBLE)


def test_a_test_that_must_hold_within_a_refuted_rule_is_not() -> None:
    """`blocked` where no pose is free: the inner rule has to hold for `blocked` not to."""
    inner = "(and (at ?o ?p) (not (exists (?q - pose) (free ?o ?p ?q))))"
    domain = DOMAIN.replace("(and (at ?o2 ?q) (not (free ?o ?p ?q)))", f"(and (at ?o2 ?q) {inner})")
    for word, put in (("CONDITION", ""), ("EFFECT", "(thing ?o)"), ("EXTRA", "")):
        domain = domain.replace(word, put)
    functions = dict.fromkeys(("draw", "test"), lambda *values, call: iter(()))
    streams = STREAMS.replace("MORE", "")
    problem = stream_task(domain, streams, functions, {"cup": ("thing",)}, "", "(done)")
    assert names(problem) == {}


def test_what_must_be_given_is_looked_up() -> None:
    streams = STREAMS.replace(
        "(and (pose ?o ?p) (pose ?o ?q)) :certified (free",
        "(and (given ?o) (pose ?o ?p) (pose ?o ?q)) :certified (free",
    )
    problem = task(streams=streams)
    found = assumable(problem.streams, problem.task)
    assert given_for(found, problem.streams, problem.task) == {
        "free": [("given", (0,)), ("pose", (0, 1)), ("pose", (0, 2))]
    }


PLACES = """
(define (domain places) (:predicates (thing ?o) (place ?l) (at ?o ?l) (stands ?o ?p) (home ?o)
  (fits ?l ?o ?p) (pose ?p) (clear ?o ?p ?b ?q) (ok ?l ?o ?p))
 (:derived (ok ?l ?o ?p) (not (exists (?b ?q)
  (and (at ?b ?l) (stands ?b ?q) (not (= ?b ?o)) (not (clear ?o ?p ?b ?q))))))
 (:action put :parameters (?o ?l ?p) :precondition (and (home ?o) (fits ?l ?o ?p) (ok ?l ?o ?p))
  :effect (and (at ?o ?l) (stands ?o ?p) (not (home ?o)))))
"""
PLACES_STREAMS = """
(define (stream places)
 (:stream draw :inputs (?o ?l) :domain (and (thing ?o) (place ?l)) :outputs (?p)
  :certified (and (fits ?l ?o ?p) (pose ?p)))
 (:stream test :inputs (?o ?p ?b ?q) :domain (and (thing ?o) (pose ?p) (thing ?b) (pose ?q))
  :certified (clear ?o ?p ?b ?q)))
"""


@pytest.mark.parametrize(("many", "known"), [(8, True), (3, True), (8, False)])
def test_a_negated_rule_of_three_variables_asks_for_the_pairs_that_a_plan_meets(
    many: int, known: bool
) -> None:
    """Of 83,000 pairs; where a thing is not given as such, its test is never asked and fails."""
    things, places = [f"o{i}" for i in range(many)], [f"l{i}" for i in range(many - 2)]
    asked: list[tuple[object, ...]] = []

    def draw(*values: object, call: object) -> Iterator[tuple[int]]:
        yield from ((7 * number,) for number in range(3))

    def test(*values: object, call: object) -> bool:
        asked.append(values)
        return values[1] != values[3]

    init = [f"(thing {o})" for o in things] + [f"(place {at})" for at in places]
    init += [f"(home {o})" for o in things]
    problem = stream_task(
        PLACES,
        PLACES_STREAMS,
        {"draw": draw, "test": test},
        dict.fromkeys((*things, *places, "stone", "p0"), ("object",)),
        " ".join([*init, "(stands stone p0) (at stone l0)", "(thing stone) (pose p0)" * known]),
        f"(and {' '.join(f'(at {o} {places[i % len(places)]})' for i, o in enumerate(things))})",
    )
    result = solve("adaptive", problem)
    assert result.outcome is (Outcome.SOLVED if known else Outcome.INFEASIBLE)
    assert len(asked) < 100
    assert bool(asked) is known
    if many == 3:
        replay(problem, result)
