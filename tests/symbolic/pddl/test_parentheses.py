"""Every ')' of a domain is left out once, and one is put in at every place: the error is where a person would look."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Iterator

import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.sexpr import read

RaisesAt = Callable[..., InputError]


@pytest.mark.parametrize(
    ("marked", "message"),
    [
        ("@@(define (domain d)\n  (:predicates (on ?a ?b))", "never closed"),
        (
            "(define (domain d)\n  @@(:predicates (on ?a ?b)\n  (:action a :parameters ()))",
            "never closed",
        ),
        ("(define @@(domain d\n  (:predicates (on ?a ?b)))", "never closed"),
        (
            "(define (domain d)\n  (:action a :parameters @@(?x\n    :effect (on ?x))\n  (:action b))",
            "never closed",
        ),
        (
            "(define (domain d)\n(:action a :effect (and @@(on ?x\n (not (on ?y))))\n(:action b))",
            "never closed",
        ),
        ("(define (domain d)\n  (:action a\n    :effect @@(and (p)\n  )\n)", "never closed"),
        ("@@(and (on a b)", "never closed"),
        ("(and @@(on a b (on b c))", "never closed"),
        ("(and (on a b)\n     @@(on b c\n     (on c d))", "never closed"),
        ("(define (domain d)\n  (:predicates (on ?a ?b)))@@)", "closes nothing"),
        ("(define (domain d)\n  (:predicates (on ?a ?b))@@)\n  (:action a))", "closes nothing"),
        ("(define (domain d)\n  (:action a :precondition (p)@@) :effect (q)))", "closes nothing"),
        ("(and (on a b)@@) (on b c))", "closes nothing"),
        ("@@)", "closes nothing"),
    ],
)
def test_where(marked: str, message: str, raises_at: RaisesAt) -> None:
    raises_at(read, marked, message)


def mutations(text: str, kind: str) -> Iterator[tuple[str, list[tuple[int, int]]]]:
    """Texts with one ')' left out, or one too many, and the places that an error may name.

    Several changes may give the same text, as in "))": then each place is right.
    """
    comments = {i for match in re.finditer(";[^\n]*", text) for i in range(*match.span())}
    stack: list[int] = []
    result: dict[str, list[tuple[int, int]]] = defaultdict(list)
    for i, char in enumerate(text):
        if i in comments:
            continue
        if char == "(":
            stack.append(i)
        elif char == ")":
            opened = stack.pop()
            if kind == "left out":
                result[text[:i] + text[i + 1 :]].append(place(text, opened))
        if kind == "too many" and (not char.strip() or char in "()") and i - 1 not in comments:
            result[text[:i] + ")" + text[i:]].append(place(text, i))
    yield from result.items()


def place(text: str, index: int) -> tuple[int, int]:
    return text.count("\n", 0, index) + 1, index - text.rfind("\n", 0, index)


@pytest.mark.parametrize(("kind", "exact"), [("left out", 0.9), ("too many", 0.9)])
def test_most_are_found_exactly(
    kind: str, exact: float, domain_text: str, streams_text: str
) -> None:
    total = right = same_line = 0
    for text in (domain_text, streams_text):
        for broken, places in mutations(text, kind):
            with pytest.raises(InputError) as caught:
                read(broken)
            total += 1
            right += (caught.value.line, caught.value.column) in places
            same_line += caught.value.line in [line for line, _ in places]
    assert total > 70
    assert right / total >= exact, f"{right} of {total}"
    assert same_line / total >= 0.95


def test_without_indentation(domain_text: str) -> None:
    flat = "\n".join(line.strip() for line in domain_text.split("\n"))
    total = right = 0
    for broken, places in mutations(flat, "left out"):
        with pytest.raises(InputError) as caught:
            read(broken)
        total += 1
        right += (caught.value.line, caught.value.column) in places
    assert total > 50
    assert right / total >= 0.8, f"{right} of {total}"
