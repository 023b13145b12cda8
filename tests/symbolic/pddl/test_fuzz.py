"""Whatever a file says, there is a result or an InputError that says where; never another exception."""

from __future__ import annotations

import random
import re
from collections.abc import Callable

import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.parser import parse_domain, parse_goal, parse_streams, parse_task
from tamp.symbolic.pddl.structs import Domain

GOAL = "(and (on mug table) (forall (?x - movable ?s - surface) (imply (on ?x ?s) (not (on ?x depot)))))"
TASK = """(define (problem p) (:domain cupboard) (:objects mug - movable table - surface) (:requirements :strips)
 (:init (hand-empty) (= (total-cost) 0)) (:goal (and (on mug table))) (:metric minimize (total-cost)))"""
EXTRA = [
    "(",
    ")",
    "-",
    "?x",
    ":effect",
    ":action",
    "and",
    "not",
    "either",
    "()",
    "=",
    "when",
    "object",
    "0",
    ";",
    "define",
]


def mutated(text: str, rng: random.Random) -> str:
    tokens = re.findall(r";[^\n]*\n|[()]|[^\s()]+|\s+", text)
    for _ in range(rng.choice((1, 1, 2, 4))):
        i, j = rng.randrange(len(tokens)), rng.randrange(len(tokens))
        match rng.randrange(6):
            case 0:
                del tokens[i]
            case 1:
                tokens.insert(i, f" {rng.choice(EXTRA)} ")
            case 2:
                tokens[i], tokens[j] = tokens[j], tokens[i]
            case 3:
                tokens[i] = tokens[j]
            case 4:
                tokens[i] = f" {rng.choice(EXTRA)} "
            case _:
                low, high = sorted((i, min(j, i + 8)))
                tokens[low:high] = tokens[low:high] * rng.choice((0, 2))
    return "".join(tokens)


def refusal(parse: Callable[[str], object], text: str) -> InputError | None:
    try:
        parse(text)
    except InputError as error:
        return error
    return None


@pytest.mark.parametrize("kind", ["domain", "streams", "goal", "task"])
def test_a_result_or_an_input_error(
    kind: str,
    domain: Domain,
    objects: dict[str, tuple[str, ...]],
    domain_text: str,
    streams_text: str,
) -> None:
    parsers: dict[str, tuple[str, Callable[[str], object]]] = {
        "domain": (domain_text, lambda text: parse_domain(text, "f")),
        "streams": (streams_text, lambda text: parse_streams(text, domain, "f")),
        "goal": (GOAL, lambda text: parse_goal(text, domain, objects, "f")),
        "task": (TASK, lambda text: parse_task(text, domain, "f")),
    }
    original, parse = parsers[kind]
    rng = random.Random(kind)
    refused = accepted = 0
    for _ in range(400):
        text = mutated(original, rng)
        error = refusal(parse, text)
        accepted += error is None
        if error is not None:
            refused += 1
            assert error.file == "f"
            assert error.line is not None
            assert error.column is not None
            assert 1 <= error.line <= text.count("\n") + 1
    assert refused > 100
    assert accepted > 10
