from __future__ import annotations

from collections.abc import Callable

import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.parser import output_types, parse_domain, parse_streams
from tamp.symbolic.pddl.structs import Atom, Domain, Function, Stream, StreamFile

RaisesAt = Callable[..., InputError]
Changed = Callable[[str, str, str], str]


def test_streams(streams: StreamFile) -> None:
    assert streams.name == "cupboard"
    assert [stream.name for stream in streams.streams] == [
        "sample-grasp",
        "sample-on",
        "inverse-kinematics",
        "test-clear",
    ]
    assert streams.streams[1] == Stream(
        "sample-on",
        inputs=("?o", "?s"),
        domain=(Atom("movable", ("?o",)), Atom("surface", ("?s",))),
        outputs=("?p",),
        certified=(Atom("pose", ("?o", "?p")), Atom("supported", ("?o", "?p", "?s"))),
        fluents=("at-pose", "holding"),
    )
    assert streams.streams[3].outputs == ()
    condition = (Atom("base-conf", ("?b1",)), Atom("base-conf", ("?b2",)))
    assert streams.functions == (Function("distance", ("?b1", "?b2"), condition),)


def test_output_types_come_from_what_is_certified(streams: StreamFile, domain: Domain) -> None:
    types = {stream.name: output_types(stream, domain) for stream in streams.streams}
    assert types == {
        "sample-grasp": {"?g": ("grasp",)},
        "sample-on": {"?p": ("pose",)},
        "inverse-kinematics": {"?b": ("base-conf",)},
        "test-clear": {},
    }


def test_output_types_are_the_most_special_ones() -> None:
    domain = parse_domain(
        "(define (domain d) (:types a b - top c top - object) (:predicates (p ?x - top) (q ?x - a) (r ?x) (s ?x - c)))"
    )
    text = "(define (stream s) (:stream f :outputs (?x ?y ?z) :certified (and (p ?x) (q ?x) (r ?y) (q ?z) (s ?z))))"
    (stream,) = parse_streams(text, domain).streams
    assert output_types(stream, domain) == {"?x": ("a",), "?y": ("object",), "?z": ("a", "c")}


def test_spellings_of_pddlstream() -> None:
    domain = parse_domain(
        "(define (domain d) (:predicates (Conf ?q) (Kin ?q ?p)) (:functions (Distance ?q1 ?q2))"
        " (:action move :parameters (?q1 ?q2) :effect (increase (total-cost) (Distance ?q1 ?q2))))"
    )
    assert domain.actions[0].cost == Atom("distance", ("?q1", "?q2"))
    text = """(define (stream s)
      (:stream sample-conf :inputs () :domain () :outputs (?q) :certified (and (Conf ?q)))
      (:function (Distance ?q1 ?q2) {}))"""
    expected = parse_streams(text.format("(and (Conf ?q1) (Conf ?q2))"), domain)
    assert parse_streams(text.format(":domain (and (Conf ?q1) (Conf ?q2))"), domain) == expected
    assert (
        parse_streams(text.format(":inputs (?q1 ?q2) :domain (and (Conf ?q1) (Conf ?q2))"), domain)
        == expected
    )


WRONG = [
    (
        "(stream cupboard)",
        "@@(streams cupboard)",
        "expected (stream NAME), found '(streams ...)'",
        None,
    ),
    ("(:stream sample-grasp", "(@@:streams sample-grasp", "unknown section ':streams'", ":stream"),
    ("(:stream test-clear", "(:stream @@sample-on", "stream 'sample-on' stands twice", None),
    ("(:stream test-clear", "(:stream @@(test-clear)", "expected a stream's name", None),
    (
        ":fluents (at-pose",
        "@@:fluent (at-pose",
        "unknown keyword ':fluent' of stream 'sample-on'",
        ":fluents",
    ),
    (":fluents (at-pose holding)", ":fluents @@at-pose", "expected a list after :fluents", None),
    (":fluents (at-pose", ":fluents (@@at-poze", "unknown predicate 'at-poze'", "at-pose"),
    (":inputs (?o) ", ":inputs (?o @@- movable) ", ":inputs have no types", None),
    (":inputs (?o) ", ":inputs (@@o) ", "expected a variable such as ?x, found 'o'", None),
    (
        ":inputs (?o ?s)",
        ":inputs (?o ?s @@?o)",
        "variable of stream 'sample-on': '?o' stands twice",
        None,
    ),
    (
        "(?o ?s) :domain (and",
        "(?o ?s @@?r) :domain (and",
        "'?r': this input of stream 'sample-on' does not",
        None,
    ),
    (":outputs (?g)", ":outputs (@@?o)", "'?o' stands twice", None),
    (
        "(grasp ?o ?g))\n  (:stream sample-on",
        "(grasp ?o @@?h))\n  (:stream sample-on",
        "unknown variable '?h'",
        None,
    ),
    (":domain (movable ?o)", ":domain (movable @@?p)", "unknown variable '?p'. Choices: ?o", None),
    (":domain (movable ?o)", ":domain (@@movabel ?o)", "unknown predicate 'movabel'", "movable"),
    (
        ":domain (movable ?o)",
        ":domain @@(movable ?o ?o)",
        "'movable' takes 1 argument, found 2",
        None,
    ),
    (":domain (movable ?o)", ":domain (@@not (movable ?o))", "'not' is not possible here", None),
    (":domain (movable ?o)", ":domain (and (movable ?o) @@(on ?o depot))", "'on' is derived", None),
    (
        ":domain (movable ?o)",
        ":domain (and (movable ?o) @@(hand-empty))",
        "'hand-empty' is changed by actions",
        None,
    ),
    ("(kin ?o ?p ?g ?b)", "@@(at-base ?b)", "'at-base' is changed by actions", None),
    (
        ":certified (clear ?o ?p ?o2 ?p2)",
        ":certified @@()",
        "stream 'test-clear' certifies nothing",
        None,
    ),
    ("(Distance ?b1 ?b2)", "(@@Distanze ?b1 ?b2)", "unknown function 'Distanze'", "distance"),
    ("(Distance ?b1 ?b2)", "@@(Distance ?b1)", "'distance' takes 2 arguments, found 1", None),
    ("(Distance ?b1 ?b2)", "(Distance ?b1 @@?b1)", "argument '?b1' stands twice", None),
    ("(and (base-conf ?b1) (base-conf ?b2))", "(base-conf @@?b)", "unknown variable '?b'", "?b2"),
    (
        "(Distance ?b1 ?b2) (and (base-conf ?b1)",
        "(Distance @@?b1 ?b2) (and",
        "does not stand in its domain",
        None,
    ),
    (
        "(and (base-conf ?b1)",
        ":inputs @@(?b2 ?b1) :domain (and (base-conf ?b1)",
        "are not the arguments",
        None,
    ),
    ("  (:function", "  @@(:stream) (:function", "a stream has no name", None),
]


@pytest.mark.parametrize(("old", "new", "message", "suggestion"), WRONG)
def test_wrong(
    old: str,
    new: str,
    message: str,
    suggestion: str | None,
    domain: Domain,
    streams_text: str,
    changed: Changed,
    raises_at: RaisesAt,
) -> None:
    marked = changed(streams_text, old, new)
    error = raises_at(lambda text: parse_streams(text, domain, "s.pddl"), marked, message)
    assert str(error).startswith("s.pddl:")
    assert error.suggestion == suggestion


def test_a_function_stands_once(
    domain: Domain, streams_text: str, changed: Changed, raises_at: RaisesAt
) -> None:
    again = "(:function (Distance ?a ?b) (and (base-conf ?a) (base-conf ?b)))"
    marked = changed(streams_text, "  (:function (D", f"{again}  (:function (@@D")
    raises_at(lambda text: parse_streams(text, domain), marked, "function 'Distance' stands twice")


MORE = """\
(define (stream more)
  (:predicate (hot ?o)
    (movable ?o))
  (:rule :inputs (?o ?p) :domain (pose ?o ?p) :certified (seen ?o))
  (:stream sample :inputs (?o) :domain (movable ?o) :outputs (?p) :certified (pose ?o ?p)))
"""

HOT = """\
(define (domain hot)
  (:types movable place)
  (:predicates (hot ?o - movable) (seen ?o - movable) (pose ?o - movable ?p - place) (cold ?o) (warm ?o))
  (:action cool :parameters (?o - movable) :precondition (not (hot ?o)) :effect (cold ?o))
  (:derived (warm ?o) (not (cold ?o))))
"""


def test_predicates_and_rules() -> None:
    domain = parse_domain(HOT)
    streams = parse_streams(MORE, domain)
    (hot,) = streams.predicates
    assert (hot.name, hot.inputs, hot.domain) == ("hot", ("?o",), (Atom("movable", ("?o",)),))
    (rule,) = streams.rules
    assert (rule.inputs, rule.outputs, rule.certified) == (
        ("?o", "?p"),
        (),
        (Atom("seen", ("?o",)),),
    )


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("(:predicate (hot ?o)", "(:predicate @@(hot ?o ?p)", "'hot' takes 1 argument, found 2"),
        (
            "(:predicate (hot ?o)",
            "@@(:predicate (cold ?o)",
            "'cold' is changed by actions, so Python cannot decide it",
        ),
        (
            "(:predicate (hot ?o)",
            "@@(:predicate (warm ?o)",
            "'warm' is derived, so Python cannot decide it",
        ),
        (
            "(movable ?o))\n",
            "(movable ?o))\n(:predicate (@@hot ?o) (movable ?o))",
            "predicate 'hot' stands twice",
        ),
        (
            ":inputs (?o ?p) :domain (pose ?o ?p)",
            ":inputs (?o ?p @@?r) :domain (pose ?o ?p)",
            "not stand in its :domain",
        ),
        (
            ":certified (seen ?o))",
            ":certifies@@ (seen ?o))",
            "unknown keyword ':certifies' of rule 1",
        ),
        ("(:rule :inputs", "(:rule @@sample :inputs", "unknown keyword 'sample' of rule 1"),
    ],
)
def test_wrong_predicates_and_rules(old: str, new: str, message: str, raises_at: RaisesAt) -> None:
    marked = MORE.replace(old, new.replace(":certifies@@", "@@:certifies"), 1)
    raises_at(lambda text: parse_streams(text, parse_domain(HOT)), marked, message)
