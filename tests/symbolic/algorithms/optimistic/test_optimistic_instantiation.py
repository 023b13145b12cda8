"""Guesses: which facts could become true, and by which call."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.algorithms.optimistic.optimistic_instantiation import (
    Guess,
    Optimism,
    imagine,
    relevant,
    type_facts,
    used_predicates,
)
from tamp.symbolic.pddl.structs import Fact
from tests.symbolic.algorithms.line import Line
from tests.symbolic.algorithms.toys import stream_task

CHAIN = """
(define (domain chain)
  (:requirements :typing)
  (:types link)
  (:predicates (first ?x - link) (second ?x ?y - link) (third ?y ?z - link) (last ?z - link) (unused ?x) (done))
  (:action finish :parameters (?z - link) :precondition (last ?z) :effect (done)))
"""

CHAIN_STREAMS = """
(define (stream chain)
  (:stream to-second :inputs (?x) :domain (first ?x) :outputs (?y) :certified (second ?x ?y))
  (:stream to-third :inputs (?x ?y) :domain (second ?x ?y) :outputs (?z) :certified (third ?y ?z))
  (:stream test-last :inputs (?y ?z) :domain (third ?y ?z) :certified (last ?z))
  (:stream waste :inputs (?x) :domain (first ?x) :outputs (?y) :certified (unused ?y)))
"""


@pytest.fixture
def chain() -> tuple[Sequence[BoundStream], list[Fact]]:
    functions = dict.fromkeys(("to-second", "to-third", "test-last", "waste"), lambda *values, call: iter(()))
    problem = stream_task(
        CHAIN, CHAIN_STREAMS, functions, {"a": ("link",), "b": ("link",)}, "(first a) (first b)", "(done)"
    )
    useful = relevant(problem.streams, used_predicates(problem.task))
    return useful, [*sorted(problem.task.initial), *type_facts(problem.task)]


def guesses(optimism: Optimism) -> list[Guess]:
    return list(dict.fromkeys(optimism.makers.values()))


def test_only_relevant_streams(chain: tuple[Sequence[BoundStream], list[Fact]]) -> None:
    assert [stream.name for stream in chain[0]] == ["to-second", "to-third", "test-last"]


def test_levels_of_a_chain(chain: tuple[Sequence[BoundStream], list[Fact]]) -> None:
    made = guesses(imagine(*chain))
    assert sorted((g.level, g.stream.name) for g in made) == sorted(
        2 * [(1, "to-second"), (2, "to-third"), (3, "test-last")]
    )
    assert all(g.has_real_inputs == (g.level == 1) for g in made)


@pytest.mark.parametrize(("levels", "count"), [(1, 2), (2, 4), (3, 6), (4, 6)])
def test_depth_is_limited(chain: tuple[Sequence[BoundStream], list[Fact]], levels: int, count: int) -> None:
    assert len(guesses(imagine(*chain, levels=levels))) == count


@pytest.mark.parametrize(("enough", "names"), [(1, ["to-second"] * 2), (3, ["to-second"] * 2 + ["to-third"])])
def test_with_enough_guesses_no_deeper_ones_are_made(
    chain: tuple[Sequence[BoundStream], list[Fact]], enough: int, names: list[str]
) -> None:
    """The first level is complete, the one that is reached then is not, and tests feed nothing: they may come after."""
    optimism = imagine(*chain, enough=enough)
    assert [g.stream.name for g in guesses(optimism) if not g.stream.is_test] == names
    assert not optimism.complete
    assert imagine(*chain).complete
    assert not imagine(*chain, levels=2).complete


def test_fixpoint(chain: tuple[Sequence[BoundStream], list[Fact]]) -> None:
    """Every domain fact is known or made earlier, placeholders are of one call, and nothing more can be called."""
    streams, known = chain
    optimism = imagine(streams, known)
    made = guesses(optimism)
    level = dict.fromkeys(known, 0) | {fact: guess.level for fact, guess in optimism.makers.items()}
    assert all(guess.level == 1 + max(level[fact] for fact in guess.domain) for guess in made)
    outputs = [name for guess in made for name in guess.outputs]
    assert len(outputs) == len(set(outputs)) == len(optimism.types) == 4
    calls = {(guess.stream.name, guess.inputs) for guess in made}
    assert len(calls) == len(made)
    assert calls == {
        *(("to-second", (x,)) for x in "ab"),
        *(("to-third", fact[1:]) for fact in level if fact[0] == "second"),
        *(("test-last", fact[1:]) for fact in level if fact[0] == "third"),
    }


def test_dead_calls_and_what_rests_on_them_are_left_out(chain: tuple[Sequence[BoundStream], list[Fact]]) -> None:
    made = guesses(imagine(*chain, dead=frozenset({("to-second", ("a",))})))
    assert [(g.stream.name, g.level) for g in made] == [("to-second", 1), ("to-third", 2), ("test-last", 3)]
    assert made[0].inputs == ("b",)


def test_known_facts_are_not_guessed(chain: tuple[Sequence[BoundStream], list[Fact]]) -> None:
    streams, known = chain
    optimism = imagine(streams, [*known, ("third", "a", "b"), ("last", "b")])
    assert ("last", "b") not in optimism.makers


def test_types_serve_as_facts() -> None:
    problem = Line({"a": 1.0}, {"left": (0.0, 5.0)}).problem("(on a left)")
    facts = type_facts(problem.task)
    assert ("block", "a") in facts and ("object", "a") in facts and ("region", "left") in facts
    makers = imagine(relevant(problem.streams, used_predicates(problem.task)), [*problem.task.initial, *facts]).makers
    poses = [fact for fact in makers if fact[0] == "supported"]
    assert len(poses) == 1 and poses[0][1] == "a" and poses[0][3] == "left"


def test_order_of_facts_does_not_change_how_much_is_guessed(
    chain: tuple[Sequence[BoundStream], list[Fact]],
) -> None:
    streams, known = chain
    forward, backward = guesses(imagine(streams, known)), guesses(imagine(streams, known[::-1]))
    assert len(forward) == len(backward) == 6
