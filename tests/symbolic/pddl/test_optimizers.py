"""PDDLStream's optimizers are read and left aside; what they alone would certify is told."""

from __future__ import annotations

import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.optimizers import check_optimizer
from tamp.symbolic.pddl.parser import parse_domain, parse_streams
from tamp.symbolic.pddl.sections import read_sections

DOMAIN = parse_domain(
    "(define (domain d) (:predicates (conf ?q) (pose ?p) (near ?q ?p) (apart ?a ?b)))"
)
STREAMS = parse_streams(
    """(define (stream d)
    (:stream sample :inputs () :outputs (?q) :certified (conf ?q))
    (:stream test :inputs (?q ?p) :domain (and (conf ?q) (pose ?p)) :certified (near ?q ?p)))""",
    DOMAIN,
).streams


def checked(optimizer: str) -> tuple[list[str], list[str]]:
    _, (section,) = read_sections(
        f"(define (stream d) {optimizer})", "stream", (":optimizer",), "d.pddl"
    )
    return check_optimizer(section, STREAMS, DOMAIN)


def test_where_streams_certify_the_same_it_is_left_aside_with_a_note() -> None:
    notes, alone = checked(
        "(:optimizer gurobi (:variables (?q) :graph (conf ?q)) (:constraint (near ?q ?p)))"
    )
    assert alone == []
    assert notes == [
        "d.pddl:1:20: optimizer 'gurobi' is left aside: streams certify all that it would"
    ]


def test_what_nothing_else_certifies_is_named_once_with_its_place() -> None:
    notes, alone = checked(
        "(:optimizer gurobi (:constraint (apart ?a ?b) :necessary (conf ?a))\n (:constraint (apart ?b ?a))"
        " (:variables (?p) :inputs (?q) :domain (conf ?q) :graph (and (pose ?p) (near ?q ?p))))"
    )
    assert notes == alone and len(notes) == 2
    assert notes[0].startswith("d.pddl:1:") and "no stream certifies (apart ...)" in notes[0]
    assert notes[1].startswith("d.pddl:2:") and "no stream certifies (pose ...)" in notes[1]
    assert all("write each (:variables ...) as a :stream" in note for note in notes)


def test_an_objective_promises_nothing() -> None:
    assert checked("(:optimizer gurobi (:objective (distance)))")[1] == []
    assert checked("(:optimizer gurobi (:variables (?q)))")[1] == []
    assert checked("(:optimizer gurobi)")[1] == []


@pytest.mark.parametrize(
    ("optimizer", "words"),
    [
        ("(:optimizer)", "an optimizer has no name"),
        ("(:optimizer ?x)", "expected an optimizer's name, found '.x'"),
        (
            "(:optimizer o variables)",
            "expected a part of the optimizer, one of :variables, :constraint, :objective",
        ),
        (
            "(:optimizer o (:variable (?q)))",
            r"unknown part .* of optimizer 'o'.*Did you mean ':variables'",
        ),
        ("(:optimizer o ())", r"unknown part '\(\)' of optimizer 'o'"),
        ("(:optimizer o (:constraint))", "':constraint' needs a list of variables or a fact"),
        ("(:optimizer o (:constraint near))", "expected a list of variables, or a fact such as"),
        (
            "(:optimizer o (:constraint (nea ?q ?p)))",
            "unknown predicate 'nea'.*Did you mean 'near'",
        ),
        ("(:optimizer o (:variables (q)))", "expected a variable such as .x, found 'q'"),
        (
            "(:optimizer o (:variables (?q) :grap (conf ?q)))",
            "unknown keyword ':grap' of the variables",
        ),
        ("(:optimizer o (:variables (?q) :graph (near ?q ?p)))", "unknown variable '.p'"),
    ],
)
def test_malformed_ones_are_refused(optimizer: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        checked(optimizer)
