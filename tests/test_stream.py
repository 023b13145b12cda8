"""Rejections are data: kind and bodies, whatever the words are."""

from __future__ import annotations

import pickle
from collections import Counter
from dataclasses import replace

import tamp
from tamp import Rejection, RejectionKind
from tamp.stream import Call, LateGenerator
from tamp.system.deadline import Deadline


def test_blockers_without_a_kind_are_in_the_way() -> None:
    said = Rejection("quite another wording", ("can", "mug"))
    assert said.kind is RejectionKind.BLOCKED
    assert said.bodies == said.in_the_way == ("can", "mug")


def test_words_alone_blame_nobody() -> None:
    assert Rejection("hits can").in_the_way == ()
    assert Rejection("hits can").kind is RejectionKind.OTHER


def test_a_collision_names_what_was_hit_and_not_who_hit_it() -> None:
    said = Rejection.hits("shelf", "wall", who="mug carried here")
    assert said.reason == "mug carried here hits shelf or wall"
    assert (said.kind, said.in_the_way, said.blockers) == (
        RejectionKind.COLLISION,
        ("shelf", "wall"),
        (),
    )
    assert Rejection.hits("shelf").reason == "hits shelf"


def test_a_cause_that_is_no_obstacle_has_nothing_in_the_way() -> None:
    said = Rejection(
        "no motion (straight ahead: wall)", kind=RejectionKind.NO_MOTION, bodies=("wall",)
    )
    assert said.in_the_way == () and said.bodies == ("wall",)


def test_equal_causes_are_counted_together_and_cross_processes() -> None:
    said = Rejection.hits("can", blockers=("can",))
    assert Counter([said, Rejection.hits("can", blockers=("can",))]) == {said: 2}
    assert pickle.loads(pickle.dumps(said)) == said
    assert tamp.RejectionKind is RejectionKind


def test_a_generator_is_made_when_it_is_asked_for_and_once() -> None:
    made: list[object] = []

    def make() -> object:
        made.append(object())
        return made[-1]

    late = Call(LateGenerator(make), Deadline())
    other = replace(late, ahead=True)
    assert not made
    assert late.rng is other.rng is late.rng is made[0] and len(made) == 1
    assert Call("any", Deadline()).rng == "any"
