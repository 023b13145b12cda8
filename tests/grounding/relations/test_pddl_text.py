"""A domain that gets a learned relation: once, its own text kept, and refused where it is broken."""

from __future__ import annotations

from pathlib import Path

import pytest

from grounding.relations.pddl_text import added, diff
from grounding.relations.pddl_words import Words
from tamp.errors import InputError
from tamp.symbolic.pddl.parser import parse_domain, parse_streams
from tamp.symbolic.pddl.relations import relation_of

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
