"""Formulas are shown as they are written, without what sets variables of one name apart, and list their terms."""

from __future__ import annotations

from tamp.symbolic.pddl.structs import And, Atom, Exists, Forall, Not, Or, Parameter
from tamp.symbolic.search.instantiation.meanings import meaning_of

ON = Atom("on", ("?x 2", "table"))


def test_a_formula_is_shown_on_one_line_with_the_names_of_its_variables() -> None:
    formula = Exists((Parameter("?x 2"),), And((ON, Not(Or((Atom("wet", ("cup",)), ON))))))
    assert meaning_of(formula).text == (
        "(exists (?x) (and (on ?x table) (not (or (wet cup) (on ?x table)))))"
    )
    assert meaning_of(Forall((Parameter("?x 2"), Parameter("?y")), ON)).text == (
        "(forall (?x ?y) (on ?x table))"
    )


def test_types_are_shown_as_they_are_written() -> None:
    typed = Exists((Parameter("?x 2", ("cup", "mug")), Parameter("?y 3", ("table",))), ON)
    assert meaning_of(typed).text == "(exists (?x - (either cup mug) ?y - table) (on ?x table))"


def test_its_terms_come_from_left_to_right_and_again_where_they_stand_again() -> None:
    formula = And((Atom("wet", ("cup",)), Not(ON), Or((Atom("dry", ()), Atom("wet", ("cup",))))))
    assert meaning_of(formula).terms == ("cup", "?x 2", "table", "cup")
