"""Which item may stand in which group, as PDDL's grammar has it (Fox and Long 2003, appendix A)."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tamp.symbolic.pddl.grammar import may_contain


def fits(text: str) -> bool:
    """Ask about the last item in the text's outermost group: "(and (p) >(q)" for a group, ">word"."""
    before, item = text.split(">")
    words = before.replace("(", " ( ").replace(")", " ) ").split()
    depth = groups = 0
    for word in words:
        groups += word == "(" and depth == 1
        depth += (word == "(") - (word == ")")
    parts = item.replace("(", "( ").split()
    item_head = parts[1].strip(")") if parts[0] == "(" else ""
    return may_contain(words[1], groups, parts[0], item_head, words[-1])


ALLOWED = [
    "(and >(p)", "(and (p) (q) >(r)", "(or (p) >(q)", "(not >(p)", "(forall >(?x)", "(forall (?x) >(p)",
    "(when (p) >(q)", "(imply (p) >(q)", "(= >(f)", "(= (f) >3", "(= >?x", "(increase (total-cost) >1",
    "(define >(domain", "(define (domain d) >(:action", "(define (domain d) >(:predicates",
    "(:action >go", "(:action go >:parameters", "(:action go :parameters >(?x)",
    "(:action go :parameters (?x) >:effect", "(:action go :effect >(and", "(:stream >s", "(:stream s :inputs >(?x)",
    "(:predicates (p) >(q)", "(:init (p) >(q)", "(:goal >(p)", "(:derived (p) >(q)", "(:metric minimize >(total-cost)",
    "(on >a", "(on ?x >?y", "(?x - >(either", "(:requirements >:adl", "(:types >a", "((p) >(q)", "(:functions >(f)",
]  # fmt: skip
FORBIDDEN = [
    "(not (p) >(q)", "(forall (?x) (p) >(q)", "(when (p) (q) >(r)", "(imply (p) (q) >(r)", "(:derived (p) (q) >(r)",
    "(= (f) (g) >(h)", "(and >word", "(or (p) >word", "(not >p", "(when (p) >word", "(:init >word",
    "(define (domain d) >(p)", "(define (domain d) >(define", "(and >(define", "(and >(:action", "(on >(p)",
    "(on a >(p)", "(on >:effect", "(and (p) >:effect", "(:action go >(?x)", "(:action go :effect (p) >(q)",
    "(:action >(p)", "(:action go >word", "(total-cost >(p)", "(total-cost >word", "(:goal >word",
    "(define (domain d) >word", "(:predicates >word", "(:types >(p)",
]  # fmt: skip


@pytest.mark.parametrize("text", ALLOWED)
def test_what_the_grammar_allows(text: str) -> None:
    assert fits(text)


@pytest.mark.parametrize("text", FORBIDDEN)
def test_what_it_does_not(text: str) -> None:
    assert not fits(text)


def misplaced(text: str) -> tuple[list[str], int]:
    """Ask about every item of a text that is right; return those that are refused, and their number."""
    tokens = re.findall(r"[()]|[^\s()]+", re.sub(";[^\n]*", "", text).lower())
    heads: list[tuple[int, str]] = []  # of the open groups: where, and the first word
    groups: list[int] = []
    wrong: list[str] = []
    asked = 0
    for i, token in enumerate(tokens):
        if token == ")":
            heads.pop()
            groups.pop()
            continue
        if heads and i > heads[-1][0] + 1:
            asked += 1
            item_head = tokens[i + 1] if token == "(" else ""
            if not may_contain(heads[-1][1], groups[-1], token, item_head, tokens[i - 1]):
                wrong.append(" ".join(tokens[i - 3 : i + 2]))
        if token == "(":
            if groups:
                groups[-1] += 1
            heads.append((i, tokens[i + 1]))
            groups.append(0)
    return wrong, asked


def test_no_shipped_file_breaks_it(root: Path) -> None:
    """Every item of every group of the shipped files may stand where it does."""
    asked = 0
    for file in sorted(root.glob("domains/**/*.pddl")):
        wrong, count = misplaced(file.read_text())
        assert not wrong, (file, wrong)
        asked += count
    assert asked > 2000
