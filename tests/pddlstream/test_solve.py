"""Files written for PDDLStream, each of their features in a problem that hangs on it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib import import_module
from typing import Any

import pytest

from tamp.errors import InputError
from tamp.pddlstream import (
    Action,
    PDDLProblem,
    Solution,
    WildOutput,
    empty_gen,
    from_constant,
    from_fn,
    from_gen,
    from_gen_fn,
    from_list_fn,
    from_list_gen_fn,
    from_sampler,
    from_test,
    solve,
)
from tamp.symbolic.algorithms.result import Outcome

ALGORITHMS = ("adaptive", "incremental")

DOMAIN = """
(define (domain walk)
  (:requirements :strips :equality)
  (:constants @home)
  (:predicates (Conf ?q) (Step ?q1 ?q2) (At ?q) (Even ?q) (Bad ?q) (Rested) (Near ?q1 ?q2) (AtBad) (Mark ?q) (Seen ?q))
  (:functions (Length ?q1 ?q2))
  (:action go
    :parameters (?q1 ?q2)
    :precondition (and (Step ?q1 ?q2) (At ?q1))
    :effect (and (At ?q2) (not (At ?q1)) (increase (total-cost) (Length ?q1 ?q2))))
  (:action rest
    :parameters (?q)
    :precondition (and (At ?q) (Conf ?q) (Even ?q))
    :effect (and (Rested) (increase (total-cost) 2)))
  (:action hop
    :parameters (?q1 ?q2)
    :precondition (and (At ?q1) (Near ?q1 ?q2))
    :effect (and (At ?q2) (not (At ?q1)) (increase (total-cost) 1)))
  (:derived (AtBad) (exists (?q) (and (At ?q) (Bad ?q)))))
"""

STREAMS = """
(define (stream walk)
  (:function (Length ?q1 ?q2) (and (Conf ?q1) (Conf ?q2)))
  (:stream next
    :inputs (?q1) :domain (Conf ?q1)
    :outputs (?q2) :certified (and (Conf ?q2) (Step ?q1 ?q2)))
  (:stream test-even :inputs (?q) :domain (Conf ?q) :outputs () :certified (Even ?q)))
"""

HOME = (0, "home")


def length(a: tuple[int, str], b: tuple[int, str]) -> int:
    return abs(a[0] - b[0])


def even(q: tuple[int, str]) -> bool:
    return q[0] % 2 == 0 and q != HOME


def following(q: tuple[int, str]) -> tuple[tuple[int, str]]:
    return ((q[0] + 1, "on"),)


def walk(
    goal: Any = ("Rested",),
    streams: str = STREAMS,
    domain: str = DOMAIN,
    init: tuple[Any, ...] = (),
    *,
    algorithm: str = "adaptive",
    without: tuple[str, ...] = (),
    unit_costs: bool = False,
    max_time: float = 20.0,
    **functions: Any,
) -> Solution:
    """Walk along the integers; `functions` replace or join the usual ones, with _ for -."""
    known: dict[str, Any] = {
        "next": from_fn(following),
        "test-even": from_test(even),
        "length": length,
    }
    known |= {name.replace("_", "-"): function for name, function in functions.items()}
    for name in without:
        del known[name]
    start = [("Conf", HOME), ("At", HOME), ("=", ("total-cost",), 0), *init]
    problem = PDDLProblem(domain, {"@home": HOME}, streams, known, start, goal)
    return solve(problem, algorithm, unit_costs=unit_costs, max_time=max_time)


def planned(solution: Solution) -> list[Action]:
    assert solution.plan is not None, solution.explanation
    return solution.plan


def check_rested(solution: Solution) -> None:
    plan, cost, certificate = solution
    assert solution.outcome is Outcome.SOLVED, solution.explanation
    assert [action.name for action in plan] == ["go", "go", "rest"]
    assert plan[0].args == (HOME, (1, "on"))
    assert plan[2].args == ((2, "on"),)
    assert cost == 4
    assert ("step", HOME, (1, "on")) in certificate
    assert ("even", (2, "on")) in certificate


def generator(q: tuple[int, str]) -> Iterator[Any]:
    yield None
    yield following(q)


def lists(q: tuple[int, str]) -> Iterator[Any]:
    yield []
    yield [following(q)]


@pytest.mark.parametrize("algorithm", ALGORITHMS)
@pytest.mark.parametrize(
    "following_",
    [
        from_fn(following),
        from_gen_fn(generator),
        from_list_gen_fn(lists),
        from_list_fn(lambda q: [following(q)]),
        from_sampler(following, max_attempts=3),
        following,
        generator,
        lists,
        lambda q: [following(q)],
    ],
    ids=[
        "fn",
        "gen_fn",
        "list_gen_fn",
        "list_fn",
        "sampler",
        "raw",
        "raw gen",
        "raw list gen",
        "raw list",
    ],
)
def test_every_form_of_a_stream(following_: Any, algorithm: str) -> None:
    check_rested(walk(algorithm=algorithm, next=following_))


@pytest.mark.parametrize(
    "test", [from_test(even), even, lambda q: () if even(q) else None], ids=["test", "raw", "fn"]
)
def test_every_form_of_a_test(test: Any) -> None:
    check_rested(walk(test_even=test))


def test_sequences_and_constants() -> None:
    assert planned(walk(next=from_gen([((3, "x"),), None, ((4, "y"),)])))[-1].args == ((4, "y"),)
    assert planned(walk(next=from_constant(((6, "z"),))))[-1].args == ((6, "z"),)
    assert walk(next=empty_gen()).outcome is Outcome.INFEASIBLE


def test_unit_costs() -> None:
    assert walk(unit_costs=True).cost == 3


def test_costs_are_computed_for_real_values() -> None:
    """Two ways: the cheap one is known only from the function."""

    def ways(q: tuple[int, str]) -> list[Any]:
        return [((q[0] + 50, "far"),), ((q[0] + 2, "near"),)] if q == HOME else []

    solution = walk(next=from_list_fn(ways), algorithm="incremental")
    assert planned(solution)[0].args == (HOME, (2, "near"))
    assert solution.cost == 4
    wrong = r"function 'length' gave -1: a cost is a number"
    with pytest.raises(InputError, match=wrong):
        walk(length=lambda a, b: -1)


def test_goals_as_nested_tuples() -> None:
    goal = (
        "and",
        ("exists", ["?q"], ("and", ("At", "?q"), ("Even", "?q"))),
        ("not", ("At", HOME)),
        ("or", ("Rested",), ("At", HOME)),
    )
    check_rested(walk(goal))
    assert planned(walk(("forall", "?q", ("imply", ("At", "?q"), ("=", "?q", HOME))))) == []


def test_equal_values_are_one_object() -> None:
    goal = ("At", (3, "on"))
    solution = walk(goal, algorithm="incremental", init=(("Conf", (3, "on")),))
    assert [action.args[1] for action in planned(solution)] == [(1, "on"), (2, "on"), (3, "on")]


def test_constants() -> None:
    domain = DOMAIN.replace("(At ?q) (Conf ?q) (Even ?q)", "(At @home) (Even ?q) (Conf ?q)")
    solution = walk(domain=domain)
    assert [action.name for action in planned(solution)] == ["rest"]
    with pytest.raises(
        InputError, match=r"'@hme' is no constant of the domain.*Did you mean '@home'"
    ):
        solve(PDDLProblem(domain, {"@hme": 1}, STREAMS, {}, [], ("Rested",)))


PREDICATE = """
  (:predicate (Bad ?q) (Conf ?q))
"""


@pytest.mark.parametrize("algorithm", ALGORITHMS)
@pytest.mark.parametrize("condition", ["(Even ?q) (not (Bad ?q))", "(Even ?q) (not (AtBad))"])
def test_a_predicate_that_must_be_false(condition: str, algorithm: str) -> None:
    """Directly, and through a rule that is needed false."""
    streams = STREAMS.replace("(:stream next", PREDICATE + "(:stream next")
    domain = DOMAIN.replace("(Conf ?q) (Even ?q)", f"(Conf ?q) {condition}")
    solution = walk(domain=domain, streams=streams, algorithm=algorithm, bad=lambda q: q[0] <= 2)
    assert planned(solution)[-1].args == ((4, "on"),)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
@pytest.mark.parametrize("condition", ["(Even ?q) (Bad ?q)", "(Even ?q) (AtBad)"])
def test_a_predicate_that_must_be_true(condition: str, algorithm: str) -> None:
    streams = STREAMS.replace("(:stream next", PREDICATE + "(:stream next")
    domain = DOMAIN.replace("(Conf ?q) (Even ?q)", f"(Conf ?q) {condition}")
    solution = walk(domain=domain, streams=streams, algorithm=algorithm, bad=lambda q: q[0] > 2)
    assert planned(solution)[-1].args == ((4, "on"),)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
@pytest.mark.parametrize("condition", ["(Even ?q) (not (Bad ?q))", "(Even ?q) (not (AtBad))"])
def test_a_test_stream_that_must_fail(condition: str, algorithm: str) -> None:
    """What PDDLStream calls a negated stream: a plan rests on the test having been asked, and having failed."""
    streams = STREAMS.replace(
        "(:stream next",
        "(:stream test-bad :inputs (?q) :domain (Conf ?q) :certified (Bad ?q))\n(:stream next",
    )
    domain = DOMAIN.replace("(Conf ?q) (Even ?q)", f"(Conf ?q) {condition}")
    asked: list[int] = []

    def bad(q: tuple[int, str]) -> bool:
        asked.append(q[0])
        return q[0] <= 2

    solution = walk(domain=domain, streams=streams, algorithm=algorithm, test_bad=from_test(bad))
    assert planned(solution)[-1].args == ((4, "on"),)
    assert 4 in asked
    wild = walk(
        domain=domain,
        streams=streams,
        algorithm=algorithm,
        test_bad=lambda q: WildOutput([()], [("Mark", q)]),
        max_time=2.0,
    )
    assert not wild.solved


def test_rules() -> None:
    streams = STREAMS.replace(":certified (Even ?q)", ":certified (Mark ?q)")
    streams = (
        streams[: streams.rindex(")")]
        + "(:rule :inputs (?q) :domain (Mark ?q) :certified (Even ?q)))"
    )
    check_rested(walk(streams=streams))


def test_undeclared_predicates_are_taken_from_the_streams() -> None:
    streams = STREAMS.replace(":certified (Even ?q)", ":certified (and (Even ?q) (Halved ?q ?q))")
    solution = walk(streams=streams)
    check_rested(solution)
    assert [
        text
        for text in solution.warnings
        if "predicate 'halved' is not among the domain's :predicates" in text
    ]


def test_fluents() -> None:
    streams = STREAMS.replace("(Conf ?q) :outputs ()", "(Conf ?q) :fluents (At Seen) :outputs ()")
    shown: list[Any] = []

    def here(q: tuple[int, str], fluents: list[Any]) -> bool:
        shown.extend(fluents)
        return even(q)

    check_rested(walk(streams=streams, test_even=from_test(here)))
    assert ("at", (2, "on")) in shown


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_wild_facts_open_a_way_that_no_stream_promises(algorithm: str) -> None:
    """Only the wild fact (Near home far) leads to far."""

    def found(q: tuple[int, str]) -> Iterator[Any]:
        far = (8, "far")
        yield WildOutput(facts=[("Near", HOME, far), ("Conf", far)])
        yield WildOutput(values=[following(q)], facts=[("Near", following(q)[0], far)])

    solution = walk(
        ("At", (8, "far")),
        next=from_gen_fn(found),
        algorithm=algorithm,
        init=(("Seen", (8, "far")),),
    )
    assert solution.outcome is Outcome.SOLVED
    assert [action.name for action in planned(solution)] == ["hop"]
    assert ("near", HOME, (8, "far")) in solution.certificate


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_a_stream_that_nothing_asks_for_may_be_wild(algorithm: str) -> None:
    """Looking around certifies nothing that a condition names; the doors that it finds do."""
    domain = """(define (domain rooms) (:predicates (Room ?r) (Door ?a ?b) (In ?r) (Seen ?r))
      (:action go :parameters (?a ?b) :precondition (and (Door ?a ?b) (In ?a)) :effect (and (In ?b) (not (In ?a)))))"""
    streams = (
        "(define (stream rooms) (:stream look :inputs (?r) :domain (Room ?r) :certified (Seen ?r)))"
    )

    def around(r: int) -> WildOutput:
        return WildOutput(values=[()], facts=[("Room", r + 1), ("Door", r, r + 1)] if r < 4 else [])

    problem = PDDLProblem(
        domain, {}, streams, {"look": around}, [("Room", 0), ("In", 0)], ("In", 3)
    )
    solution = solve(problem, algorithm, max_time=20.0)
    assert [action.args for action in planned(solution)] == [(0, 1), (1, 2), (2, 3)]
    problem = problem._replace(goal=("exists", "?r", ("and", ("In", "?r"), ("Door", 7, "?r"))))
    assert solve(problem, algorithm, max_time=20.0).outcome is Outcome.INFEASIBLE


def test_a_value_of_the_goal_may_still_come_from_a_stream(monkeypatch: pytest.MonkeyPatch) -> None:
    """No call promises to give just this value, so only the end of the time says that none does."""
    monkeypatch.setattr(import_module("tamp.pddlstream.solve"), "CLOSER_LOOK", 20)
    assert len(planned(walk(("At", (40, "on"))))) == 40
    assert walk(("At", (-1, "on")), max_time=1.0).outcome is Outcome.TIMEOUT


def test_equal_numbers_are_one_object() -> None:
    streams = """(define (stream s)
      (:stream half :inputs (?a) :domain (Num ?a) :outputs (?b) :certified (and (Num ?b) (To ?a ?b))))"""
    domain = """(define (domain n) (:predicates (Num ?a) (To ?a ?b) (At ?a))
      (:action go :parameters (?a ?b) :precondition (and (To ?a ?b) (At ?a)) :effect (and (At ?b) (not (At ?a)))))"""
    problem = PDDLProblem(
        domain,
        {},
        streams,
        {"half": from_fn(lambda a: (a / 2,))},
        [("Num", 8), ("At", 8)],
        ("At", 2),
    )
    assert [action.args for action in planned(solve(problem))] == [(8, 4.0), (4.0, 2)]


def test_wild_tests() -> None:
    solution = walk(
        test_even=lambda q: WildOutput(values=[()] if even(q) else [], facts=[("Mark", q)])
    )
    check_rested(solution)


OPTIMIZER = """
  (:optimizer solver
    (:variables (?q2) :inputs (?q1) :domain (Conf ?q1) :graph (and (Conf ?q2) (Step ?q1 ?q2)))
    (:constraint (Even ?q) :necessary (Conf ?q))
    (:objective Length))
"""


def test_an_optimizer_that_streams_can_replace_is_left_aside() -> None:
    solution = walk(streams=STREAMS.replace("(:stream next", OPTIMIZER + "(:stream next"))
    check_rested(solution)
    assert [text for text in solution.warnings if "optimizer 'solver' is left aside" in text]


def test_an_optimizer_that_streams_cannot_replace_proves_nothing() -> None:
    streams = STREAMS[: STREAMS.index("(:stream next")] + OPTIMIZER + ")"
    solution = walk(streams=streams, without=("next", "test-even"))
    assert solution.outcome is Outcome.EXHAUSTED
    said = [
        text
        for text in solution.warnings
        if "optimizer 'solver' is not called, and no stream certifies" in text
    ]
    assert [text.partition(": ")[0] for text in said] == ["6:63", "6:63", "7:18"]
    assert set(said) <= set(solution.explanation)


def test_initial_facts_stand_for_what_an_optimizer_would_give() -> None:
    streams = STREAMS[: STREAMS.index("(:stream next")] + OPTIMIZER + ")"
    there = ((2, "on"), (3, "on"))
    init = (("Conf", there[0]), ("Step", HOME, there[0]), ("Even", there[0]))
    solution = walk(streams=streams, init=init, without=("next", "test-even"))
    assert [action.name for action in planned(solution)] == ["go", "rest"]


def test_a_malformed_optimizer_is_refused() -> None:
    with pytest.raises(
        InputError,
        match=r"unknown part '\(:objectve \.\.\.\)' of optimizer.*Did you mean ':objective'",
    ):
        walk(
            streams=STREAMS.replace(
                "(:stream next", OPTIMIZER.replace(":objective", ":objectve") + "(:stream next"
            )
        )


@pytest.mark.parametrize(
    ("run", "message"),
    [
        (lambda: walk(without=("next",)), r"4:3: 'next' has no function in the stream map"),
        (
            lambda: walk(nxt=even),
            r"the stream map has 'nxt', which no stream is called.*Did you mean 'next'",
        ),
        (lambda: walk(("Restd",)), r"unknown predicate 'restd'.*Did you mean 'rested'"),
        (lambda: walk(("At",)), r"'at' takes 1 argument, found 0"),
        (lambda: walk(("not",)), r"'not' takes 1 part, found 0"),
        (lambda: walk(("At", "?q")), r"unknown variable '\?q'"),
        (lambda: walk("Rested"), r"expected a condition"),
        (lambda: walk(init=(("Atbad",),)), r"'atbad' is derived"),
        (
            lambda: walk(init=(("=", ("Lenght", 1, 2), 3),)),
            r"unknown function 'lenght'.*Did you mean 'length'",
        ),
        (
            lambda: walk(algorithm="focused"),
            r"unknown algorithm 'focused'. Choices: adaptive, incremental",
        ),
        (
            lambda: walk(streams=STREAMS.replace("(Even ?q)))", "(AtBad)))")),
            r"'atbad' is derived, it cannot stand in",
        ),
        (lambda: walk(max_time=0.0), r"the time must be positive"),
    ],
)
def test_mistakes_are_named(run: Callable[[], Solution], message: str) -> None:
    with pytest.raises(InputError, match=message):
        run()


def test_a_wrong_number_of_outputs_is_a_warning() -> None:
    solution = walk(next=from_fn(lambda q: (1, 2)))
    assert not solution.solved
    assert solution.cost == float("inf")
    assert any("2 outputs for 1" in text for text in solution.warnings)


def test_no_plan_says_why() -> None:
    solution = walk(test_even=from_test(lambda q: False), max_time=1.0)
    assert solution.plan is None
    assert solution.explanation
