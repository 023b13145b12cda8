"""Rejections are data: kind and bodies, whatever the words are."""

from __future__ import annotations

import pickle
from collections import Counter

import tamp
from tamp import Rejection, RejectionKind


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
