from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from tamp.symbolic.pddl.formatter import to_text
from tamp.symbolic.pddl.parser import parse_domain, parse_goal
from tamp.symbolic.pddl.structs import (
    And,
    Atom,
    Domain,
    Exists,
    Forall,
    Formula,
    Not,
    Or,
    Parameter,
)

TINY = parse_domain("(define (domain d) (:types t u) (:predicates (p) (q ?x ?y)))")
OBJECTS = {"a": ("t",), "b": ("u",)}
types = st.sampled_from([("object",), ("t",), ("t", "u")])


def formulas(variables: tuple[str, ...], depth: int) -> st.SearchStrategy[Formula]:
    """Formulas over the variables in scope and the objects; no name is bound twice."""
    terms = st.sampled_from(("a", "b", *variables))
    atoms = st.one_of(
        st.just(Atom("p", ())),
        st.builds(lambda *t: Atom("q", t), terms, terms),
        st.builds(lambda x: Atom("t", (x,)), terms),
    )
    if depth == 0:
        return atoms
    inner = formulas(variables, depth - 1)
    names = (f"?v{depth}", f"?w{depth}")
    bound = st.builds(
        lambda one, two: (Parameter(names[0], one), Parameter(names[1], two)), types, types
    )
    body = formulas((*variables, *names), depth - 1)
    parts = st.lists(inner, max_size=3).map(tuple)
    return st.one_of(
        atoms,
        st.builds(Not, inner),
        st.builds(And, parts),
        st.builds(Or, parts),
        st.builds(Exists, bound, body),
        st.builds(Forall, bound, body),
    )


@given(formulas((), 3))
def test_parsing_the_text_gives_the_formula_back(formula: Formula) -> None:
    assert parse_goal(to_text(formula), TINY, OBJECTS) == formula


def test_facts_and_formulas(domain: Domain) -> None:
    assert to_text(("on", "mug", "table")) == "(on mug table)"
    assert to_text(("hand-empty",)) == "(hand-empty)"
    text = "(exists (?p - pose) (and (supported ?o ?p ?s) (at-pose ?o ?p)))"
    assert to_text(domain.derived[0].body) == text
