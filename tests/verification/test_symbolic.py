"""Plans in PDDL alone, judged action by action."""

from __future__ import annotations

import copy
import hashlib
from pathlib import Path
from typing import Any

import pytest

from tamp.errors import InputError
from tamp.verification.symbolic import verify_symbolic

DOMAIN = """(define (domain ferry) (:requirements :strips :typing :action-costs)
  (:types place)
  (:predicates (at ?p - place) (road ?a ?b - place) (seen ?p - place))
  (:functions (length ?a ?b - place) (total-cost))
  (:action drive :parameters (?a ?b - place)
    :precondition (and (at ?a) (road ?a ?b))
    :effect (and (not (at ?a)) (at ?b) (seen ?b) (increase (total-cost) (length ?a ?b)))))
"""
PROBLEM = """(define (problem p) (:domain ferry)
  (:objects home mill port - place)
  (:init (at home) (road home mill) (road mill port) (road mill home)
    (= (length home mill) 3) (= (length mill port) 4) (= (total-cost) 0))
  (:goal (and (at port) (seen mill)))
  (:metric minimize (total-cost)))
"""


def drive(a: str, b: str, cost: float) -> dict[str, Any]:
    return {"name": "drive", "arguments": [a, b], "cost": cost}


@pytest.fixture
def plan(tmp_path: Path) -> dict[str, Any]:
    files = {}
    for role, text in (("domain", DOMAIN), ("problem", PROBLEM)):
        file = tmp_path / f"{role}.pddl"
        file.write_text(text)
        files[role] = {"path": str(file), "sha256": hashlib.sha256(text.encode()).hexdigest()}
    actions = [drive("home", "mill", 3), drive("mill", "port", 4)]
    return {
        "format": "tamp-symbolic-plan",
        "version": 1,
        "inputs": files,
        "actions": actions,
        "cost": 7.0,
    }


def kinds(plan: dict[str, Any]) -> list[tuple[str, str]]:
    return [(one.kind, one.message) for one in verify_symbolic(plan).violations]


def test_a_plan_that_reaches_the_goal_at_its_cost_holds(plan: dict[str, Any]) -> None:
    assert verify_symbolic(plan).holds and kinds(plan) == []


@pytest.mark.parametrize(
    ("actions", "cost", "told"),
    [
        ([("home", "mill", 3)], 3, [("goal", "(at port) does not hold")]),
        ([("home", "port", 3)], 3,
         [("precondition", "(road home port) does not hold"), ("cost", "its cost is not known"),
          ("goal", "(seen mill) does not hold"), ("cost", "the plan costs 0, not 3")]),
        ([("mill", "port", 4), ("home", "mill", 3)], 7, [("precondition", "(at mill) does not hold")]),
        ([("home", "mill", 2), ("mill", "port", 4)], 7, [("cost", "it costs 3, not 2")]),
        ([("home", "mill", 3), ("mill", "port", 4)], 6, [("cost", "the plan costs 7, not 6")]),
        ([], 0, [("goal", "(at port) does not hold"), ("goal", "(seen mill) does not hold")]),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told(
    plan: dict[str, Any], actions: list, cost: float, told: list
) -> None:
    plan["actions"], plan["cost"] = [drive(*one) for one in actions], cost
    assert kinds(plan) == told


def test_violations_name_the_action(plan: dict[str, Any]) -> None:
    plan["actions"][1]["arguments"] = ["mill", "mill"]
    first = verify_symbolic(plan).violations[0]
    assert (first.index, first.action, first.message) == (
        1,
        "drive",
        "(road mill mill) does not hold",
    )


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda p: p["actions"][0].update(name="fly"), "unknown action 'fly'"),
        (lambda p: p["actions"][0].update(arguments=["home"]), "'drive' takes 2 arguments, not 1"),
        (
            lambda p: p["actions"][0].update(arguments=["home", "mil"]),
            "unknown object 'mil'.*Did you mean 'mill'",
        ),
        (lambda p: p.pop("cost"), "'cost' is missing"),
        (lambda p: p.update(version=9), "version"),
        (
            lambda p: p["inputs"]["problem"].update(path="/gone.pddl"),
            "the plan's problem /gone.pddl is missing",
        ),
    ],
)
def test_what_is_no_such_plan_is_refused(plan: dict[str, Any], spoil: Any, words: str) -> None:
    spoilt = copy.deepcopy(plan)
    spoil(spoilt)
    with pytest.raises(InputError, match=words):
        verify_symbolic(spoilt)


def test_a_file_that_has_changed_is_told(plan: dict[str, Any]) -> None:
    file = Path(plan["inputs"]["problem"]["path"])
    file.write_text(file.read_text() + "; another line\n")
    assert [kind for kind, _ in kinds(plan)] == ["hash"]


def test_the_users_files_count_more_than_the_plans(plan: dict[str, Any], tmp_path: Path) -> None:
    other = tmp_path / "other.pddl"
    other.write_text(PROBLEM.replace("(at port) (seen mill)", "(at mill)"))
    report = verify_symbolic(plan, problem=other)
    assert ("goal", "(at mill) does not hold") in [
        (one.kind, one.message) for one in report.violations
    ]
    with pytest.raises(InputError, match="no such file: "):
        verify_symbolic(plan, domain=tmp_path / "gone.pddl")
