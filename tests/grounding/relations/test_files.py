"""Weights of a learned relation and the domain that gets it: written, read again, damaged."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from grounding.registry import file_grounding, is_few_shot
from grounding.relations.demonstration_file import Demonstration, demonstrations_of
from grounding.relations.files import weights_of
from grounding.relations.grounding import LearnedRelation
from grounding.relations.learner import Learned, learn
from grounding.relations.pddl_text import added, diff
from grounding.relations.pddl_words import Words
from grounding.runtime import Proposer
from grounding.weights import Weights, read_weights, write_weights
from tamp.errors import InputError
from tamp.symbolic.pddl.parser import parse_domain, parse_streams
from tamp.symbolic.pddl.relations import relation_of
from tests.grounding.relations.shown import write_demos


@pytest.fixture(scope="module")
def demos(tmp_path_factory: pytest.TempPathFactory) -> list[Demonstration]:
    return list(demonstrations_of("left_of", [write_demos(tmp_path_factory.mktemp("demos"))]))


@pytest.fixture(scope="module")
def learned(demos: list[Demonstration]) -> Learned:
    return learn("left_of", demos, np.random.default_rng(0))


def test_weights_say_the_same_when_they_are_read(
    learned: Learned, demos: list[Demonstration], tmp_path: Path
) -> None:
    path = tmp_path / "left_of.safetensors"
    write_weights(path, weights_of(learned, {"seed": 0}))
    again, first = file_grounding("left_of", path), LearnedRelation(weights_of(learned, {}))
    assert isinstance(again, LearnedRelation) and is_few_shot(str(path))
    right = 0
    for one in demos:
        answer = again.classify(one.scene, one.arguments)
        assert answer == first.classify(one.scene, one.arguments)
        right += (answer >= 0.5) == one.holds
        poses = [
            relation.propose(one.scene, one.arguments, 4, np.random.default_rng(1))
            for relation in (again, first)
        ]
        assert poses[0] == poses[1] and 1 <= len(poses[0]) <= 4
    assert right >= 19
    with pytest.raises(InputError, match="weights for 'left_of', not 'right_of'"):
        file_grounding("right_of", path)
    with pytest.raises(InputError, match="has 2 arguments, not 1"):
        first.classify(demos[0].scene, ("cup",))


def test_a_classifier_that_cannot_tell_is_none(learned: Learned, tmp_path: Path) -> None:
    path = tmp_path / "left_of.safetensors"
    write_weights(path, weights_of(replace(learned, cannot_tell="because"), {}))
    found = file_grounding("left_of", path)
    assert isinstance(found, Proposer) and found.cannot_tell == "because"


@pytest.mark.parametrize(
    ("array", "value", "message"),
    [
        ("classifier_conditions", np.full((2, 2), 999), "do(es)? not fit together|has the shape"),
        ("classifier_used", np.array([100_000]), "do not fit together"),
        ("classifier_zero", np.zeros(3), "'classifier_zero' has the shape"),
        ("ranking_soft", None, "array 'ranking_soft' is missing"),
        ("shown_codes", np.full((5, 4), 50), "names what is not there"),
        ("shown_R", np.zeros((2, 2)), "do not fit together"),
    ],
)
def test_damaged_weights_are_refused(
    learned: Learned, array: str, value: np.ndarray | None, message: str
) -> None:
    whole = weights_of(learned, {})
    arrays = {name: one for name, one in whole.arrays.items() if name != array}
    if value is not None:
        arrays[array] = value
    with pytest.raises(InputError, match=message):
        LearnedRelation(Weights(arrays, whole.card))


@pytest.mark.parametrize(
    ("entry", "value", "message"),
    [("version", 99, "of version 99"), ("kinds", ["cup"], "'kinds'"), ("level", 7, "'level' is 7")],
)
def test_a_wrong_card_is_refused(learned: Learned, entry: str, value: object, message: str) -> None:
    whole = weights_of(learned, {})
    with pytest.raises(InputError, match=message):
        LearnedRelation(Weights(whole.arrays, {**whole.card, entry: value}))


def test_the_card_says_how_well_it_did(learned: Learned, tmp_path: Path) -> None:
    write_weights(tmp_path / "x.safetensors", weights_of(learned, {"seed": 3}))
    card = read_weights(tmp_path / "x.safetensors").card
    assert card["model"] == "conjunctions" and card["positive"] == 10 and card["samples"] == 20
    assert (
        card["kinds"] == ["movable", "movable"]
        and card["held out"][0] > 0.7
        and card["classifies"] is True
    )


KINDS = [
    ("movable",),
    ("movable", "movable"),
    ("movable", "movable", "movable"),
    ("movable", "surface"),
    ("movable", "container"),
    ("movable", "fixed"),
    ("movable", "surface", "movable"),
]


@pytest.mark.parametrize("kinds", KINDS, ids="-".join)
def test_a_new_domain_has_the_relation_and_parses(kinds: tuple[str, ...], tmp_path: Path) -> None:
    path = tmp_path / "mine.pddl"
    texts = added(path, Words("mine_too", kinds), "a note")
    streams = path.with_suffix(".streams.pddl")
    domain = parse_domain(texts[path][1], path)
    declared = parse_streams(texts[streams][1], domain, streams)
    assert len(domain.predicates["mine_too"].parameters) == len(kinds)
    assert [rule.head.predicate for rule in domain.derived].count("mine_too") == 1
    assert {"sample-mine_too", "test-mine_too"} <= {stream.name for stream in declared.streams}
    assert domain.name == "mine" and texts[path][0] == ""


def test_a_domain_gets_a_relation_once_and_keeps_its_text(tmp_path: Path) -> None:
    path = tmp_path / "mine.pddl"
    for file, (_, text) in added(path, Words("first", ("movable",)), "note").items():
        file.write_text("; my own comment (with a parenthesis\n" + text)
    texts = added(path, Words("second", ("movable", "movable")), "note")
    lines = [line for line in diff(texts).splitlines() if line.startswith(("+", "-"))]
    removed = [line for line in lines if line.startswith("-") and not line.startswith("---")]
    assert removed and all("second" not in line for line in removed)
    assert all(
        line[1:].rstrip(")") in "".join(new for _, new in texts.values()) for line in removed
    )
    assert any("(second ?o - movable ?o2 - movable)" in line for line in lines)
    assert all(
        new.startswith("; my own comment (with a parenthesis\n") for _, new in texts.values()
    )
    for file, (_, text) in texts.items():
        file.write_text(text)
    assert diff(added(path, Words("second", ("movable", "movable")), "other note")) == ""
    with pytest.raises(InputError, match="'second' has 2 arguments here, not 1"):
        added(path, Words("second", ("movable",)), "note")
    with pytest.raises(InputError, match="no rule says when it holds"):
        added(path, Words("holding", ("movable", "movable")), "note")


def test_what_stands_on_a_movable_body_begins_as_the_domain_of_those_that_carry(
    tmp_path: Path,
) -> None:
    pair, path = ("movable", "movable"), tmp_path / "mine.pddl"
    texts = added(path, Words("atop", pair, onto=1), "note")
    domain = parse_domain(texts[path][1], path)
    declared = parse_streams(texts[path.with_suffix(".streams.pddl")][1], domain)
    (sample,) = (one for one in declared.streams if one.name == "sample-atop")
    assert ("borne", ("?o", "?p", "?o2", "?p2")) in [
        (a.predicate, a.terms) for a in sample.certified
    ]
    for file, (_, text) in added(path, Words("beside", pair), "note").items():
        file.write_text(text)
    with pytest.raises(InputError, match="puts bodies onto movable ones, and this domain cannot"):
        added(path, Words("atop", pair, onto=1), "note")
    other = tmp_path / "other.pddl"
    for file, (_, text) in added(other, Words("atop", pair, onto=1), "note").items():
        file.write_text(text)
    streams = added(other, Words("beside", pair), "note")[other.with_suffix(".streams.pddl")][1]
    assert "(grounded ?o ?p) (sampled ?o ?p) (proposed-beside" in streams
    assert "sample-beside-on-movable" in streams


def test_what_only_proposes_has_no_test_in_the_domain(tmp_path: Path) -> None:
    path = tmp_path / "mine.pddl"
    texts = added(path, Words("beside", ("movable", "movable"), tells=False), "note")
    domain = parse_domain(texts[path][1], path)
    declared = parse_streams(texts[path.with_suffix(".streams.pddl")][1], domain)
    assert not [one.name for one in declared.streams if one.name.startswith("test-beside")]
    assert "proposed-beside" not in domain.predicates
    relation = relation_of(declared, domain, "beside")
    assert relation is not None and relation.predicates == {"beside-pose"}


def test_a_broken_domain_is_refused_with_its_line(tmp_path: Path) -> None:
    path = tmp_path / "mine.pddl"
    for file, (_, text) in added(path, Words("first", ("movable",)), "note").items():
        file.write_text(text)
    path.write_text(path.read_text().replace("(:predicates", "(:predicate"))
    with pytest.raises(InputError, match=r"mine\.pddl:"):
        added(path, Words("second", ("movable",)), "note")
