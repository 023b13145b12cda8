"""The parts of a PDDLStream problem: the first of another kind is named, with what it should be."""

from __future__ import annotations

from typing import Any

import pytest

from tamp.errors import InputError
from tamp.pddlstream import adapters
from tamp.pddlstream.checks import check_parts

PARTS: tuple[Any, ...] = ("(define)", {}, "(define)", {}, [], ("and",))


@pytest.mark.parametrize(
    ("index", "part", "words"),
    [
        (0, 3, "domain_pddl: expected the domain's text or a Path to it, found int 3"),
        (1, [("a", 1)], "constant_map: expected a dict of values by constant, found list"),
        (2, 5, "stream_pddl: expected the streams' text"),
        (2, ["(define)", 5], "stream_pddl: expected"),
        (3, None, "stream_map: expected a dict of functions by stream, found NoneType None"),
        (3, "debug", "tamp has no placeholder streams: give each stream a function"),
        (3, {"s": 7}, r"stream_map\['s'\]: expected a function, or one of from_fn"),
        (4, "ready", "init: expected a list of facts"),
        (4, {"a": 1}, "init: expected a list of facts"),
        (5, "ready", "goal: expected a condition"),
        (5, "x" * 1000, r"found str 'x+\.\.\.$"),
    ],
)
def test_a_part_of_another_kind_is_named(index: int, part: Any, words: str) -> None:
    with pytest.raises(InputError, match=words):
        check_parts((*PARTS[:index], part, *PARTS[index + 1 :]))


@pytest.mark.parametrize("streams", [None, [None, "(define)"], ()])
def test_parts_of_the_right_kind_pass(streams: Any) -> None:
    check_parts((*PARTS[:2], streams, {"s": len, "t": adapters.from_fn(len)}, {("a",)}, ["and"]))
