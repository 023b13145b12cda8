"""A stream without a function: the error says where it stands and how it is served."""

from __future__ import annotations

import pytest

from tamp.planner.missing_function import without_function
from tamp.symbolic.pddl.parser import parse_domain, parse_streams

DOMAIN = parse_domain("(define (domain d) (:predicates (thing ?x) (near ?x)))")


def said(name: str, *functions: str) -> str:
    text = f"(define (stream d)\n (:stream {name}\n  :inputs (?x) :domain (thing ?x) :certified (near ?x)))"
    (stream,) = parse_streams(text, DOMAIN).streams
    error = without_function(stream, "d.streams.pddl", dict.fromkeys(functions))
    assert error.line == 2 and str(error.file) == "d.streams.pddl"
    return str(error)


@pytest.mark.parametrize("verb", ["sample", "test"])
def test_a_relations_stream_wants_a_grounding(verb: str) -> None:
    text = said(f"{verb}-left-of")
    assert f"stream '{verb}-left-of' has no function" in text
    assert "--sampler left-of=FILE" in text and "groundings={'left-of': object}" in text


@pytest.mark.parametrize("name", ["find-way", "sample-", "test", "tested-near"])
def test_any_other_stream_wants_a_function(name: str) -> None:
    text = said(name)
    assert f"load_problem(..., functions={{'{name}': f}})" in text and "--sampler" not in text


def test_a_function_of_nearly_that_name_is_suggested() -> None:
    text = said("find-way", "find-wav", "weigh")
    assert "Did you mean 'find-wav'" in text and "weigh" in text
