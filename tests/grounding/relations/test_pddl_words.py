"""A relation's words in PDDL: variables by what each argument is, conditions by where others stand."""

from __future__ import annotations

import pytest

from grounding.relations.pddl_words import Words, domain_parts, settled_parts, stream_parts

PAIR = ("movable", "movable")


def samplers(words: Words, carries: bool = False) -> dict[str, str]:
    """Each sampler's text by its name."""
    parts = " ".join(stream_parts(words, carries)).split("(:stream ")
    return {part.split()[0]: part for part in parts if part.startswith("sample-")}


def names(words: Words, carries: bool = False) -> list[str]:
    lines = stream_parts(words, carries)
    return [line.split()[1] for line in lines if line.startswith("(:stream")]


def test_variables_are_named_by_what_they_are_and_only_what_moves_has_a_pose() -> None:
    words = Words("r", ("movable", "fixed", "container", "surface", "movable"))
    assert words.arguments == ["?o", "?b2", "?c3", "?s4", "?o5"]
    assert words.poses == {"?o": "?p", "?o5": "?p5"}
    assert words.posed == "?o ?p ?b2 ?c3 ?s4 ?o5 ?p5"
    assert words.typed == "?o - movable ?b2 - fixed ?c3 - container ?s4 - surface ?o5 - movable"
    assert Words("r", ("movable", "surface")).posed_typed == "?o - movable ?p - pose ?s2 - surface"


@pytest.mark.parametrize(
    ("kinds", "onto", "below"),
    [
        (PAIR, 0, ""),
        (PAIR, 1, "?o2"),
        (PAIR, -1, "?o2"),  # the floor of it
        (("movable", "fixed"), 1, ""),  # which does not move
        (("movable", "fixed", "movable"), 2, "?o3"),
    ],
)
def test_what_it_rests_on_counts_where_it_moves(
    kinds: tuple[str, ...], onto: int, below: str
) -> None:
    assert Words("r", kinds, onto=onto).below == below


def test_without_a_classifier_what_is_proposed_holds() -> None:
    assert Words("near", PAIR).certified == "(proposed-near ?o ?p ?o2 ?p2)"
    assert Words("near", PAIR, tells=False).certified == "(near-pose ?o ?p ?o2 ?p2)"
    assert names(Words("near", PAIR, tells=False)) == ["sample-near"]


def test_the_rule_says_that_it_holds_where_the_bodies_are() -> None:
    predicates, rule = domain_parts(Words("near", PAIR))
    heads = [one.split()[0] for one in predicates]
    assert heads == ["(wanted-near", "(also-near", "(proposed-near", "(near-pose", "(near"]
    assert " ".join(" ".join(rule).split()) == (
        "(:derived (near ?o - movable ?o2 - movable) "
        "(exists (?p - pose ?p2 - pose) "
        "(and (near-pose ?o ?p ?o2 ?p2) (at-pose ?o ?p) (at-pose ?o2 ?p2))))"
    )


@pytest.mark.parametrize(
    ("words", "heads"),
    [
        (Words("up", ("movable",)), ["(wanted-up", "(proposed-up", "(up-pose", "(up"]),
        (
            Words("at", ("movable", "fixed")),
            ["(wanted-at", "(proposed-at", "(at-pose", "(at"],
        ),
        (Words("near", PAIR, tells=False), ["(wanted-near", "(near-pose", "(near"]),
    ],
)
def test_only_two_that_move_may_also_be_related_where_they_are(
    words: Words, heads: list[str]
) -> None:
    assert [one.split()[0] for one in domain_parts(words)[0]] == heads
    assert not any(name.endswith("-also") for name in names(words))


def test_beside_a_body_wherever_that_one_stands() -> None:
    fixed = ["sample-near", "sample-near-inside"]
    movable = ["sample-near-on-movable", "sample-near-inside-movable"]
    tests = ["test-near", "test-near-also"]
    assert names(Words("near", PAIR)) == [*fixed, *tests]
    assert names(Words("near", PAIR), carries=True) == [*fixed, *movable, *tests]

    found = samplers(Words("near", PAIR), carries=True)
    assert "(supported ?o2 ?p2 ?s) (settled ?o2 ?p2)" in found["sample-near"]
    assert "(contained ?o ?p ?c) (grounded ?o ?p)" in found["sample-near-inside"]
    assert ":inputs (?o ?o2 ?p2 ?s ?below ?pb)" in found["sample-near-on-movable"]
    resting = "(packed ?o ?p ?c ?below ?pb) (borne ?o ?p ?below ?pb) (sampled ?o ?p)"
    assert resting in found["sample-near-inside-movable"]
    assert "grounded" not in " ".join(stream_parts(Words("near", PAIR), carries=False))


@pytest.mark.parametrize(
    ("kinds", "inputs", "domain", "resting"),
    [
        (("movable",), "?o ?s", "(surface ?s)", "(supported ?o ?p ?s)"),
        (("movable", "fixed"), "?o ?b2 ?s", "(surface ?s)", "(supported ?o ?p ?s)"),
        (("movable", "surface"), "?o ?s2", "(surface ?s2)", "(supported ?o ?p ?s2)"),
        (("movable", "container"), "?o ?c2", "(container ?c2)", "(contained ?o ?p ?c2)"),
        (
            ("movable", "movable", "container"),
            "?o ?o2 ?p2 ?c3",
            "(container ?c3) (contained ?o2 ?p2 ?c3) (settled ?o2 ?p2)",
            "(contained ?o ?p ?c3)",
        ),
    ],
)
def test_a_place_among_the_arguments_is_where_it_goes(
    kinds: tuple[str, ...], inputs: str, domain: str, resting: str
) -> None:
    words = Words("r", kinds)
    (found,) = samplers(words).values()
    assert f":inputs ({inputs})" in found
    assert f":domain (and {words.wanted} {domain}) " in found
    assert f"(and (pose ?o ?p) {resting} (proposed-r {words.posed}))" in found
    place = inputs.split()[-1]
    (carried,) = samplers(words, carries=True).values()
    assert f"(anchored {place})" in carried and "(grounded ?o ?p) (sampled ?o ?p)" in carried


def test_on_another_body_it_is_borne_by_it() -> None:
    found = samplers(Words("atop", PAIR, onto=1), carries=True)
    assert [*found] == ["sample-atop"]
    assert ":domain (and (wanted-atop ?o ?o2) (settled ?o2 ?p2)) " in found["sample-atop"]
    assert "(borne ?o ?p ?o2 ?p2) (sampled ?o ?p)" in found["sample-atop"]


def test_alone_any_pose_is_tested_and_of_several_what_was_proposed() -> None:
    alone, pair = (stream_parts(Words("r", kinds), False) for kinds in (("movable",), PAIR))
    assert "  :inputs (?o ?p) :domain (and (pose ?o ?p) (wanted-r ?o))" in alone
    assert "  :inputs (?o ?p ?o2 ?p2) :domain (proposed-r ?o ?p ?o2 ?p2)" in pair


def test_where_the_relation_is_wanted_and_holds_it_may_stay() -> None:
    assert stream_parts(Words("r", ("movable", "fixed")), False)[-3:] == [
        "(:rule :inputs (?o ?p ?b2)",
        "  :domain (and (wanted-r ?o ?b2) (r-pose ?o ?p ?b2))",
        "  :certified (settled ?o ?p))",
    ]


@pytest.mark.parametrize("supports", [(), ("supported",), ("supported", "contained")])
def test_the_goal_leaves_a_body_where_it_says_nothing_or_means_the_place(
    supports: tuple[str, ...],
) -> None:
    _, streams = settled_parts(supports)
    rules = [line for line in streams if line.startswith("(:rule")]
    assert "(:rule :inputs (?o ?p) :domain (and (unbound ?o) (pose ?o ?p))" in rules[0]
    assert len(rules) == 1 + len(supports)
    for fact, rule in zip(supports, rules[1:], strict=True):
        assert f":inputs (?o ?p ?s) :domain (and (meant ?o ?s) ({fact} ?o ?p ?s))" in rule
