"""Facts that nothing ever makes false, the operators that they forbid, and what then lasts as well."""

from __future__ import annotations

from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.lasting import forbidden_by, lasting
from tamp.symbolic.search.operators import (
    Axiom,
    ConditionalEffect,
    Goal,
    Guard,
    InstantiatedTask,
    Operator,
)

NONE: frozenset[Fact] = frozenset()


def facts(text: str) -> frozenset[Fact]:
    return frozenset((word,) for word in text.split())


def operator(
    name: str, *, absent: str = "", deletes: str = "", when_deletes: str = "", guards: tuple = ()
) -> Operator:
    conditional = (
        (ConditionalEffect(NONE, NONE, NONE, facts(when_deletes)),) if when_deletes else ()
    )
    return Operator(
        name, (), NONE, facts(absent), NONE, facts(deletes), guards=guards, conditional=conditional
    )


def task(initial: str, *operators: Operator, axioms: tuple[Axiom, ...] = ()) -> InstantiatedTask:
    return InstantiatedTask(facts(initial), Goal(NONE), operators, axioms, NONE, {})


def names(operators: object) -> list[str]:
    return [one.name for one in operators]  # type: ignore[attr-defined]


def test_what_no_operator_deletes_lasts() -> None:
    found = lasting(task("a b c", operator("one", deletes="a"), operator("two", when_deletes="b")))
    assert (
        found.facts == facts("c")
        and names(found.operators) == ["one", "two"]
        and found.forbidden == ()
    )


def test_a_lasting_fact_forbids_what_wants_it_gone_and_so_more_lasts() -> None:
    made = task(
        "locked full",
        operator("empty", absent="locked", deletes="full"),
        operator("shake", absent="full"),
    )
    found = lasting(made)
    # Locked for good: nothing is emptied, so it is full for good, and nothing is shaken.
    assert found.facts == facts("locked full") and found.operators == ()
    assert [(one.name, against) for one, against in found.forbidden] == [
        ("empty", facts("locked")),
        ("shake", facts("full")),
    ]


def test_what_follows_from_lasting_facts_lasts_with_its_cause() -> None:
    rules = (
        Axiom(("blocked",), facts("stone door"), NONE),
        Axiom(("dark",), facts("blocked"), NONE),
    )
    found = lasting(
        task(
            "stone door lamp",
            operator("leave", absent="dark"),
            operator("drop", deletes="lamp"),
            axioms=rules,
        )
    )
    assert found.facts == facts("stone door blocked dark")
    assert found.causes == {("blocked",): facts("stone door"), ("dark",): facts("blocked")}
    assert names(one for one, _ in found.forbidden) == ["leave"]


def test_a_rule_with_a_negation_proves_nothing() -> None:
    rule = Axiom(("dark",), facts("night"), facts("lamp"))
    assert lasting(task("night", operator("read", absent="dark"), axioms=(rule,))).facts == facts(
        "night"
    )


def test_a_guard_that_nothing_waives_forbids_and_a_priced_one_does_not() -> None:
    firm, priced = Guard(facts("a b"), None), Guard(facts("a"), ("clear",))
    found = lasting(
        task("a b", operator("push", guards=(firm,)), operator("nudge", guards=(priced,)))
    )
    assert names(found.operators) == ["nudge"] and found.forbidden[0][1] == facts("a b")
    half = lasting(task("a", operator("push", guards=(firm,))))
    assert names(half.operators) == ["push"]  # only when all of its facts hold


def test_a_state_forbids_what_its_facts_deny_for_now() -> None:
    rules = (Axiom(("dark",), facts("night"), NONE),)
    made = task("a", operator("read", absent="dark"), operator("sleep", absent="day"), axioms=rules)
    assert [(one.name, against) for one, against in forbidden_by(made, facts("night"))] == [
        ("read", facts("dark"))
    ]
    assert [one.name for one, _ in forbidden_by(made, facts("day"))] == ["sleep"]
    assert forbidden_by(made, NONE) == []
