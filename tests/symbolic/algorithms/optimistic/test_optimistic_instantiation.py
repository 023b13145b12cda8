"""Guesses: which facts could become true, and by which call."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.algorithms.optimistic.optimistic_facts import OptimisticFacts, OptimisticInstance
from tamp.symbolic.algorithms.optimistic.optimistic_instantiation import (
    instantiate_streams,
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
    functions = dict.fromkeys(
        ("to-second", "to-third", "test-last", "waste"), lambda *values, call: iter(())
    )
    problem = stream_task(
        CHAIN,
        CHAIN_STREAMS,
        functions,
        {"a": ("link",), "b": ("link",)},
        "(first a) (first b)",
        "(done)",
    )
    useful = relevant(problem.streams, used_predicates(problem.task))
    return useful, [*sorted(problem.task.initial), *type_facts(problem.task)]


def guesses(optimistic: OptimisticFacts) -> list[OptimisticInstance]:
    return list(dict.fromkeys(optimistic.producers.values()))


def test_only_relevant_streams(chain: tuple[Sequence[BoundStream], list[Fact]]) -> None:
    assert [stream.name for stream in chain[0]] == ["to-second", "to-third", "test-last"]


def test_levels_of_a_chain(chain: tuple[Sequence[BoundStream], list[Fact]]) -> None:
    made = guesses(instantiate_streams(*chain))
    assert sorted((g.depth, g.stream.name) for g in made) == sorted(
        2 * [(1, "to-second"), (2, "to-third"), (3, "test-last")]
    )
    assert all(g.has_real_inputs == (g.depth == 1) for g in made)


@pytest.mark.parametrize(("levels", "count"), [(1, 2), (2, 4), (3, 6), (4, 6)])
def test_depth_is_limited(
    chain: tuple[Sequence[BoundStream], list[Fact]], levels: int, count: int
) -> None:
    assert len(guesses(instantiate_streams(*chain, max_depth=levels))) == count


@pytest.mark.parametrize(
    ("enough", "names"), [(1, ["to-second"] * 2), (3, ["to-second"] * 2 + ["to-third"])]
)
def test_with_enough_guesses_no_deeper_ones_are_made(
    chain: tuple[Sequence[BoundStream], list[Fact]], enough: int, names: list[str]
) -> None:
    """The first level is complete, the one that is reached then is not, and tests feed nothing: they may come after."""
    optimistic = instantiate_streams(*chain, max_instances=enough)
    assert [g.stream.name for g in guesses(optimistic) if not g.stream.is_test] == names
    assert not optimistic.complete
    assert instantiate_streams(*chain).complete
    assert not instantiate_streams(*chain, max_depth=2).complete


def test_fixpoint(chain: tuple[Sequence[BoundStream], list[Fact]]) -> None:
    """Every domain fact is known or made earlier, placeholders are of one call, and nothing more can be called."""
    streams, known = chain
    optimistic = instantiate_streams(streams, known)
    made = guesses(optimistic)
    level = dict.fromkeys(known, 0) | {
        fact: guess.depth for fact, guess in optimistic.producers.items()
    }
    assert all(guess.depth == 1 + max(level[fact] for fact in guess.domain) for guess in made)
    outputs = [name for guess in made for name in guess.outputs]
    assert len(outputs) == len(set(outputs)) == len(optimistic.types) == 4
    calls = {(guess.stream.name, guess.inputs) for guess in made}
    assert len(calls) == len(made)
    assert calls == {
        *(("to-second", (x,)) for x in "ab"),
        *(("to-third", fact[1:]) for fact in level if fact[0] == "second"),
        *(("test-last", fact[1:]) for fact in level if fact[0] == "third"),
    }


def test_dead_calls_and_what_rests_on_them_are_left_out(
    chain: tuple[Sequence[BoundStream], list[Fact]],
) -> None:
    made = guesses(instantiate_streams(*chain, ended=frozenset({("to-second", ("a",))})))
    assert [(g.stream.name, g.depth) for g in made] == [
        ("to-second", 1),
        ("to-third", 2),
        ("test-last", 3),
    ]
    assert made[0].inputs == ("b",)


def test_known_facts_are_not_guessed(chain: tuple[Sequence[BoundStream], list[Fact]]) -> None:
    streams, known = chain
    optimistic = instantiate_streams(streams, [*known, ("third", "a", "b"), ("last", "b")])
    assert ("last", "b") not in optimistic.producers


def test_types_serve_as_facts() -> None:
    problem = Line({"a": 1.0}, {"left": (0.0, 5.0)}).problem("(on a left)")
    facts = type_facts(problem.task)
    assert ("block", "a") in facts and ("object", "a") in facts and ("region", "left") in facts
    producers = instantiate_streams(
        relevant(problem.streams, used_predicates(problem.task)), [*problem.task.initial, *facts]
    ).producers
    poses = [fact for fact in producers if fact[0] == "supported"]
    assert len(poses) == 1 and poses[0][1] == "a" and poses[0][3] == "left"


def test_order_of_facts_does_not_change_how_much_is_guessed(
    chain: tuple[Sequence[BoundStream], list[Fact]],
) -> None:
    streams, known = chain
    forward, backward = (
        guesses(instantiate_streams(streams, known)),
        guesses(instantiate_streams(streams, known[::-1])),
    )
    assert len(forward) == len(backward) == 6
