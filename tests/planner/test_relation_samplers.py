"""Which samplers and classifiers serve a problem: whose word counts, and which stream each serves."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tamp.errors import InputError
from tamp.geometric.samplers.registry import SAMPLERS
from tamp.planner.relation_samplers import Served
from tamp.symbolic.pddl.parser import parse_domain, parse_streams

FIRST = next(iter(SAMPLERS["on"]))


class Proposes:
    def propose(self, scene: Any, arguments: Sequence[str], count: int, rng: Any) -> list[Any]:
        return []


class Judges:
    def classify(self, scene: Any, arguments: Sequence[str]) -> float:
        return 1.0


class Both(Proposes, Judges): ...


class Undecided(Proposes):
    cannot_tell = "too few labels"


def loaded(samplers: dict[str, str]) -> Any:
    return SimpleNamespace(
        samplers=samplers, path=Path("/there/mine.yaml"), line_of=lambda *keys: 7
    )


def served(
    problem: dict[str, str] | None = None,
    samplers: dict[str, str] | None = None,
    groundings: dict[str, Any] | None = None,
    registry: Any = None,
) -> Served:
    return Served.of(loaded(problem or {}), samplers or {}, groundings or {}, registry or {})


LEARNED = {"on": {"mine": lambda: Both(), "other": lambda: Proposes()}}


def test_without_a_word_the_first_hand_made_sampler_serves_alone() -> None:
    found = served()
    assert found.choices["on"].name == FIRST and found.choices["on"].alone
    assert set(found.choices) == set(SAMPLERS) and not found.classifiers


def test_the_command_lines_word_counts_over_the_problems() -> None:
    assert served({"on": "mine"}, registry=LEARNED).choices["on"].name == "mine"
    found = served({"on": "mine"}, {"on": "other:alone"}, registry=LEARNED)
    assert found.choices["on"].name == "other" and found.choices["on"].alone


def test_an_object_that_proposes_serves_over_both_and_one_that_judges_beside() -> None:
    own, judge = Proposes(), Judges()
    assert served({"on": "mine"}, groundings={"on": own}, registry=LEARNED).generators["on"] is own
    beside = served(groundings={"upright": judge})
    assert beside.classifiers["upright"] is judge and "upright" not in beside.generators
    both = served({"on": "mine"}, groundings={"on": judge}, registry=LEARNED)
    assert both.classifiers["on"] is judge and isinstance(both.generators["on"], Both)


def test_an_unknown_sampler_in_the_problem_is_told_with_its_line() -> None:
    with pytest.raises(InputError, match="unknown sampler 'mien' for 'on'") as told:
        served({"on": "mien"}, registry=LEARNED)
    assert (told.value.file, told.value.line) == ("/there/mine.yaml", 7)
    with pytest.raises(InputError, match="unknown sampler 'mien'") as plain:
        served(samplers={"on": "mien"}, registry=LEARNED)
    assert plain.value.line is None


def test_what_cannot_propose_is_no_sampler_of_a_relation_that_ships() -> None:
    with pytest.raises(InputError, match="sampler 'judge' for 'on' has no method propose"):
        served(samplers={"on": "judge"}, registry={"on": {"judge": lambda: Judges()}})


DOMAIN = """
(define (domain d) (:requirements :typing) (:types movable pose)
  (:predicates (pose ?o - movable ?p - pose) (nears ?o - movable ?p - pose ?o2 - movable)
    (borne ?o - movable ?p - pose ?b - movable ?pb - pose) (at-pose ?o - movable ?p - pose))
  (:action put :parameters (?o - movable ?p - pose) :precondition (pose ?o ?p)
    :effect (at-pose ?o ?p)))
"""
SAMPLE = """(:stream sample-near :inputs (?o ?o2) :domain (and (movable ?o) (movable ?o2))
  :outputs (?p) :certified (and (pose ?o ?p) (nears ?o ?p ?o2)))"""
TEST = """(:stream test-near :inputs (?o ?p ?o2) :domain (and (pose ?o ?p) (movable ?o2))
  :certified (nears ?o ?p ?o2))"""
BEARING = """(:stream sample-near-on-movable :inputs (?o ?o2 ?b ?pb)
  :domain (and (movable ?o) (movable ?o2) (pose ?b ?pb)) :outputs (?p)
  :certified (and (pose ?o ?p) (borne ?o ?p ?b ?pb)))"""


def functions(streams: str, item: Any) -> dict[str, Any]:
    domain = parse_domain(DOMAIN)
    declared = parse_streams(f"(define (stream d) {streams})", domain, "d.streams.pddl")
    return served(groundings={"near": item}).functions(declared, domain)


def test_a_sampler_serves_its_stream_and_judges_where_no_test_does() -> None:
    item = Both()
    serve = functions(SAMPLE, item)["sample-near"].keywords
    assert serve["generator"] is item and serve["relation"] == "near" and serve["below"] is None
    assert serve["judge"] == (item, (0, 1))
    made = functions(
        SAMPLE.replace("(and (pose ?o ?p) (nears ?o ?p ?o2))", "(pose ?o ?p)") + TEST, item
    )
    assert made["sample-near"].keywords["judge"] is None
    assert made["test-near"].keywords["classifier"] is item


def test_a_stream_of_poses_on_movable_bodies_says_which_input_bears() -> None:
    made = functions(SAMPLE + BEARING, Proposes())
    assert made["sample-near-on-movable"].keywords["below"] == 2
    assert made["sample-near"].keywords["below"] is None


def test_what_cannot_tell_yet_serves_no_test() -> None:
    with pytest.raises(InputError, match="that of 'near' cannot tell yet: too few labels") as told:
        functions(SAMPLE + TEST, Undecided())
    assert told.value.file == "d.streams.pddl" and told.value.line is not None
    assert "sample-near" in functions(SAMPLE, Undecided())
