"""Formulas as disjunctions of literals: quantifiers, negation, too many cases, and which rules are needed."""

from __future__ import annotations

import pytest

from tamp.symbolic.pddl.parser import parse_goal
from tamp.symbolic.pddl.structs import Atom
from tamp.symbolic.search.instantiation import normal_form
from tamp.symbolic.search.instantiation.normal_form import Literals, Normalizer, type_relation
from tests.symbolic.search.instantiation.small import parts

BUSY = "(:derived (busy ?p - place) (exists (?x - thing) (at ?x ?p)))"


def shown(literals: Literals) -> str:
    """A conjunction in one line; variables made anew keep their numbers: "at ?x_1 a, -wet box"."""

    def one(atom: Atom) -> str:
        return " ".join(term.replace(" ", "_") for term in (atom.predicate, *atom.terms))

    return ", ".join((
        *map(one, literals.positive), *(f"-{one(atom)}" for atom in literals.negative),
        *(f"{a} {'=' if same else '!='} {b}".replace("?x ", "?x_") for a, b, same in literals.equalities),
    ))  # fmt: skip


def split(text: str, body: str = "") -> list[str]:
    task = parts(body).task
    normalizer = Normalizer(task.domain)
    return list(map(shown, normalizer.split(parse_goal(text, task.domain, task.objects), {})))


@pytest.mark.parametrize(
    ("formula", "disjuncts"),
    [
        ("(and)", [""]),
        ("(or)", []),
        ("(wet box)", ["wet box"]),
        ("(and (wet box) (wet box) (lamp a))", ["wet box, lamp a"]),
        ("(not (and (wet box) (not (lamp a))))", ["-wet box", "lamp a"]),
        ("(not (or (wet box) (not (lamp a))))", ["lamp a, -wet box"]),
        (
            "(and (or (wet box) (wet cup)) (or (lamp a) (lamp b)))",
            ["wet box, lamp a", "wet box, lamp b", "wet cup, lamp a", "wet cup, lamp b"],
        ),
        ("(imply (wet box) (lamp a))", ["-wet box", "lamp a"]),
        ("(thing box)", ["type_thing box"]),
        ("(exists (?x - thing) (and (at ?x a) (not (= ?x box))))", ["at ?x_1 a, ?x_1 != box"]),
        ("(exists (?x - thing) (or (wet ?x) (at ?x a)))", ["wet ?x_1", "at ?x_1 a"]),
        ("(not (forall (?x - thing) (wet ?x)))", ["-wet ?x_1"]),
        ("(forall (?x - thing) (wet ?x))", ["-forall_1"]),
        ("(forall (?x - thing) (and))", [""]),
    ],
)
def test_disjunctions_of_literals(formula: str, disjuncts: list[str]) -> None:
    assert split(formula) == disjuncts


def test_variables_keep_their_types_and_each_quantifier_has_its_own() -> None:
    task = parts("").task
    text = "(and (exists (?x - thing) (wet ?x)) (exists (?x - thing) (at ?x a)))"
    (only,) = Normalizer(task.domain).split(
        parse_goal(text, task.domain, task.objects), {"?q": ("place",)}
    )
    assert only.variables == (("?q", ("place",)), ("?x 1", ("thing",)), ("?x 2", ("thing",)))
    assert only.names == ("?q", "?x 1", "?x 2")


def test_a_universal_quantifier_is_the_negation_of_a_rule_about_what_is_free_in_it() -> None:
    action = """(:action act :parameters (?p - place)
        :precondition (forall (?x - thing) (imply (at ?x ?p) (wet ?x))) :effect (lamp ?p))"""
    given = parts(action)
    normalizer = Normalizer(given.task.domain)
    (only,) = normalizer.split(given.action("act").precondition, {"?p": ("place",)})
    assert shown(only) == "-forall_1 ?p"
    (rule,) = normalizer.definitions["forall 1"]
    assert rule.head == Atom("forall 1", ("?p",))
    assert shown(rule.literals) == "at ?x_1 ?p, -wet ?x_1"
    assert normalizer.meanings()["forall 1"].text.startswith("(forall (?x - thing)")


def test_a_disjunction_too_many_becomes_a_predicate(monkeypatch: pytest.MonkeyPatch) -> None:
    """Three pairs are eight cases; where four are the most, each pair is named."""
    text = "(and {})".format(" ".join(f"(or (lamp {p}) (dry {p}))" for p in "abc"))
    assert len(split(text)) == 8
    monkeypatch.setattr(normal_form, "MAX_CONJUNCTIONS", 4)
    assert split(text) == ["or_1, or_2, or_3"]
    monkeypatch.setattr(normal_form, "MAX_CONJUNCTIONS", 8)
    assert len(split(text)) == 8


def test_a_rule_whose_body_binds_nothing_is_put_in_the_place_of_its_head() -> None:
    rule = "(:derived (dark ?p - place) (not (lamp ?p)))"
    assert split("(dark a)", rule) == ["type_place a, -lamp a"]
    assert split("(not (dark a))", rule) == ["-dark a"]
    assert split("(busy a)", BUSY) == ["busy a"]


def test_rules_that_are_needed_to_hold_or_to_be_refuted() -> None:
    """hot rests on busy and denies jam; nothing asks for blocked."""
    body = (
        BUSY + "(:derived (jam ?p - place) (exists (?x - thing) (and (at ?x ?p) (wet ?x))))"
        "(:derived (hot ?p - place) (and (busy ?p) (lamp ?p) (not (jam ?p))))"
        "(:derived (blocked ?x - thing) (wet ?x))"
    )
    task = parts(body).task
    normalizer = Normalizer(task.domain)

    def asked(text: str) -> tuple[set[tuple[str, bool]], list[str]]:
        roots = normalizer.split(parse_goal(text, task.domain, task.objects), {})
        return set(normalizer.polarities(roots, frozenset())), normalizer.reached(
            roots, frozenset()
        )

    assert asked("(hot a)") == ({("hot", False), ("busy", False), ("jam", True)}, ["busy", "hot"])
    assert asked("(wet box)") == (set(), [])
    refuted, reached = asked("(not (hot a))")
    assert refuted == {("hot", True), ("busy", True), ("busy", False), ("jam", False)}
    assert reached == ["busy", "jam"]


def test_a_recursive_rule_that_is_denied_is_derived_all_the_same() -> None:
    rule = """(:derived (way ?p ?q - place)
        (or (near ?p ?q) (exists (?m - place) (and (near ?p ?m) (way ?m ?q)))))"""
    task = parts(rule).task
    normalizer = Normalizer(task.domain)
    roots = normalizer.split(parse_goal("(not (way a b))", task.domain, task.objects), {})
    assert normalizer.reached(roots, frozenset({"way"})) == ["way"]
    assert ("way", True) in normalizer.polarities(roots, frozenset({"way"}))
    busy = Normalizer(parts(BUSY).task.domain)
    roots = busy.split(parse_goal("(not (busy a))", task.domain, task.objects), {})
    assert busy.reached(roots, frozenset()) == []
    assert busy.reached(roots, frozenset({"busy"})) == ["busy"]  # asked of the state itself


def test_a_goal_in_several_cases_is_a_predicate_of_its_own() -> None:
    task = parts("").task
    normalizer = Normalizer(task.domain)
    formula = parse_goal("(or (wet box) (lamp a))", task.domain, task.objects)
    atom = normalizer.goal(normalizer.split(formula, {}), formula)
    assert atom == Atom("goal 1", ())
    assert [shown(one.literals) for one in normalizer.definitions["goal 1"]] == [
        "wet box",
        "lamp a",
    ]
    assert normalizer.meanings()["goal 1"].text == "(or (wet box) (lamp a))"


def test_the_relation_of_several_types_has_one_name() -> None:
    assert type_relation(("b", "a")) == type_relation(("a", "b")) == "type a b"
