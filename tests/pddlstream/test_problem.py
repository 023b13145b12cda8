"""PDDLStream's problem as a task: what each part becomes, and what there is to say of it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.pddlstream.adapters import WildOutput, from_fn, from_test
from tamp.pddlstream.problem import Bound, PDDLProblem, bind
from tamp.stream import Call, Rejection, Wild
from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.pddl.formatter import to_text
from tamp.symbolic.pddl.structs import Atom
from tamp.system.deadline import Deadline

DOMAIN = """(define (domain shop) (:types cup - object) (:constants @home)
  (:predicates (thing ?x) (clean ?x) (seen ?x) (at ?x))
  (:functions (price ?x))
  (:action take :parameters (?x) :precondition (and (clean ?x) (at @home))
    :effect (and (seen ?x) (increase (total-cost) (price ?x)))))"""
STREAMS = """(define (stream shop)
  (:function (Price ?x) (thing ?x))
  (:stream Find :inputs () :outputs (?x) :certified (thing ?x))
  (:stream test-clean :inputs (?x) :domain (thing ?x) :certified (clean ?x)))"""
FUNCTIONS: dict[str, Any] = {
    "FIND": from_fn(lambda: (1,)), "test-clean": from_test(lambda x: x > 0), "price": lambda x: 2.0,
}  # fmt: skip
CUP = (1, "a cup")
DEAR = DOMAIN.replace("(at ?x))", "(at ?x) (dear ?x))")


def bound(
    goal: Any = ("seen", CUP),
    *,
    domain: Any = DOMAIN,
    streams: Any = STREAMS,
    functions: dict[str, Any] | None = None,
    constants: dict[str, Any] | None = None,
    init: tuple[Any, ...] = (("at", "@home"), ("thing", CUP)),
    unit_costs: bool = False,
) -> Bound:
    given = FUNCTIONS if functions is None else functions
    problem = PDDLProblem(domain, constants or {}, streams, given, init, goal)
    return bind(problem, unit_costs=unit_costs)


def streams_of(made: Bound) -> dict[str, BoundStream]:
    return {one.name: one for one in made.task.streams}


def called(stream: BoundStream, *inputs: object) -> Any:
    return stream.function(*inputs, call=Call(np.random.default_rng(0), Deadline(math.inf), ()))


def test_values_become_objects_and_names_find_their_functions_in_any_case() -> None:
    made = bound()
    (cup,) = made.task.task.objects
    assert made.task.values[cup] == CUP and made.task.by_value
    assert made.task.task.initial == {("at", "@home"), ("thing", cup)}
    assert made.task.task.goal == Atom("seen", (cup,))
    assert set(streams_of(made)) == {"find", "test-clean"}
    (cost,) = made.task.functions
    assert cost.function is FUNCTIONS["price"]
    assert (made.warnings, made.uncalled, dict(made.names)) == ((), (), {})


def test_a_constant_stands_for_its_value_or_for_its_name() -> None:
    assert bound().task.values["@home"] == "@home"
    given = bound(constants={"@HOME": (0, 0)}, init=(("at", (0, 0)), ("thing", CUP)))
    assert given.task.values["@home"] == (0, 0)
    assert ("at", "@home") in given.task.task.initial
    spare = bound(constants={"elsewhere": 1})
    assert spare.warnings == ("'elsewhere' is no constant of the domain",)
    with pytest.raises(InputError, match=r"'@hom' is no constant.*Did you mean '@home'"):
        bound(constants={"@hom": 1})


def test_a_function_that_no_stream_is_called_is_a_warning_unless_it_is_misspelt() -> None:
    spare = bound(functions={**FUNCTIONS, "unrelated": len})
    assert spare.warnings == ("the stream map has 'unrelated', which no stream is called",)
    with pytest.raises(InputError, match=r"has 'test-claen', which.*Did you mean 'test-clean'"):
        bound(functions={**FUNCTIONS, "test-claen": len})
    with pytest.raises(InputError, match=r"^3:3: 'find' has no function in the stream map"):
        bound(functions={name: one for name, one in FUNCTIONS.items() if name != "FIND"})


def test_streams_may_come_in_several_texts_and_files(tmp_path: Path) -> None:
    (tmp_path / "d.pddl").write_text(DEAR)
    (tmp_path / "s.pddl").write_text(STREAMS)
    more = "(define (stream more) (:stream test-dear :inputs (?x) :domain (thing ?x) :certified (dear ?x)))"
    made = bound(
        domain=tmp_path / "d.pddl", streams=[more, tmp_path / "s.pddl"],
        functions={**FUNCTIONS, "test-dear": from_test(lambda x: True)},
    )  # fmt: skip
    assert list(streams_of(made)) == ["test-dear", "find", "test-clean"]
    with pytest.raises(InputError, match=r"s.pddl:3:3: 'find' has no function"):
        bound(streams=tmp_path / "s.pddl", functions={"price": len, "test-clean": len})
    assert bound(streams=None, functions={}, goal=("at", "@home"), domain=DOMAIN.replace(
        "(increase (total-cost) (price ?x))", ""
    )).task.streams == ()  # fmt: skip


def test_unit_costs_leave_no_function_to_an_action() -> None:
    (priced,), (plain,) = (
        bound(unit_costs=unit).task.task.domain.actions for unit in (False, True)
    )
    assert priced.cost == Atom("price", ("?x",)) and plain.cost == 1.0


def test_a_predicate_that_only_streams_name_is_declared_with_a_warning_at_its_place() -> None:
    streams = STREAMS.replace("(clean ?x)))", "(and (clean ?x) (halved ?x ?x))))")
    made = bound(streams=streams)
    assert len(made.task.task.domain.predicates["halved"].parameters) == 2
    (said,) = made.warnings
    assert said.startswith("4:") and "'halved' is not among the domain's :predicates" in said


def test_a_test_that_must_fail_has_a_stream_for_the_opposite() -> None:
    """It is asked like the test, and says that of which the test is true."""
    domain = DEAR.replace("(clean ?x) (at @home)", "(clean ?x) (not (dear ?x)) (at @home)")
    streams = (
        STREAMS[:-1] + "(:stream test-dear :inputs (?x) :domain (thing ?x) :certified (dear ?x)))"
    )
    dear = from_test(lambda x: x > 5)
    made = bound(domain=domain, streams=streams, functions={**FUNCTIONS, "test-dear": dear})
    opposite = streams_of(made)["test-not-dear"]
    assert [to_text(atom) for atom in opposite.declaration.certified] == ["(not-dear ?x)"]
    (action,) = made.task.task.domain.actions
    assert "(not-dear ?x)" in to_text(action.precondition)
    assert called(opposite, 3) is True
    assert called(opposite, 7) == Rejection("dear holds")

    wild = {**FUNCTIONS, "test-dear": lambda x: WildOutput([()] if x > 5 else [], [("seen", x)])}
    opposite = streams_of(bound(domain=domain, streams=streams, functions=wild))["test-not-dear"]
    for value, answer in ((3, True), (7, Rejection("dear holds"))):
        found = called(opposite, value)
        assert isinstance(found, Wild) and found.value == answer
        assert list(found.facts) == [("seen", value)]


def test_a_decided_predicate_is_a_test_and_its_opposite() -> None:
    streams = STREAMS[:-1] + "(:predicate (dear ?x) (thing ?x)))"
    domain = DEAR.replace("(clean ?x) (at @home)", "(clean ?x) (not (dear ?x)) (at @home)")
    functions = {**FUNCTIONS, "dear": lambda x: x > 5}
    made = streams_of(bound(domain=domain, streams=streams, functions=functions))
    assert [called(made["test-dear"], x) for x in (3, 7)] == [False, True]
    assert [called(made["test-not-dear"], x) for x in (3, 7)] == [True, Rejection("dear holds")]


def test_what_actions_change_as_well_is_told_under_the_name_that_the_user_wrote() -> None:
    """`clean` is certified by a stream, and soiling ends it."""
    domain = DOMAIN[:-1] + "(:action soil :parameters (?x) :effect (not (clean ?x))))"
    made = bound(domain=domain)
    assert dict(made.names) == {"clean-start": "clean"}
    certified = streams_of(made)["test-clean"].declaration.certified
    assert [to_text(atom) for atom in certified] == ["(clean-start ?x)"]
