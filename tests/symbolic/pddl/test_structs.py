"""What a domain knows of its types and predicates."""

from __future__ import annotations

from tamp.symbolic.pddl.parser import parse_domain
from tamp.symbolic.pddl.structs import Action, And, Atom, Derived, Domain, Effect


def test_types_form_a_hierarchy(domain: Domain) -> None:
    assert domain.is_a("movable", "body")
    assert domain.is_a("movable", "object")
    assert not domain.is_a("body", "movable")
    assert domain.fits(("fixed", "surface"), ("surface",))
    assert not domain.fits(("movable",), ("surface", "container"))


def test_a_type_may_stand_below_several() -> None:
    domain = parse_domain(
        "(define (domain d) (:types table - (either body surface) body surface - object))"
    )
    assert domain.is_a("table", "body")
    assert domain.is_a("table", "surface")
    assert not domain.is_a("surface", "table")


def test_what_stands_on_a_cycle_of_types_is_asked_and_answered() -> None:
    domain = Domain("d", {"a": "b", "b": "a"}, {}, {}, {}, (), ())
    assert domain.is_a("a", "b") and domain.is_a("b", "a")
    assert not domain.is_a("a", "c")


def test_an_unknown_type_is_below_object_alone() -> None:
    domain = Domain("d", {"object": "object"}, {}, {}, {}, (), ())
    assert domain.is_a("ghost", "object") and not domain.is_a("object", "ghost")
    assert domain.fits(("ghost",), ("cup", "object")) and not domain.fits(("ghost",), ("cup",))
    assert domain.fits((), ("object",))  # which asks for nothing


def test_fluents_are_what_actions_change_and_derived_what_rules_define() -> None:
    lit, dark, seen = Atom("lit", ()), Atom("dark", ()), Atom("seen", ())
    switch = Action("switch", (), Atom("power", ()), (Effect(lit, True), Effect(dark, False)))
    domain = Domain("d", {}, {}, {}, {}, (switch,), (Derived(seen, (), And((lit,))),))
    assert domain.fluent_predicates == {"lit", "dark"}
    assert domain.derived_predicates == {"seen"}
