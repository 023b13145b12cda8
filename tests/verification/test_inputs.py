"""What a plan is judged by: which files count, whose objects, which relations a classifier decides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.plan.read import PlanFile, PlanSource, Value
from tamp.plan.sources import sha256
from tamp.symbolic.pddl.structs import Atom
from tamp.system.files import find_domain
from tamp.verification.inputs import Inputs, find_files, read_inputs
from tests.own import SAMPLED, write_domain, write_problem
from tests.plan.making import plan_of

PROBLEM = """\
domain: cupboard
robot: {model: panda_mobile, base: [0.0, 0.0, 0.0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  table: {furniture: table, size: [1.2, 0.7, 0.6], at: [1.2, 0.0, 0.0]}
  cup:   {box: [0.06, 0.06, 0.1], on: table}
goal: (on cup table)
"""
OBJECTS = {"cup": ("movable",), "table": ("fixed", "surface")}


class Never:
    """A classifier that is not asked."""

    def classify(self, scene: object, arguments: object) -> float:
        raise AssertionError


@pytest.fixture
def problem(tmp_path: Path) -> Path:
    file = tmp_path / "own.yaml"
    file.write_text(PROBLEM, encoding="utf-8")
    return file


def plan(**more: Any) -> PlanFile:
    return replace(plan_of(**more), objects=OBJECTS)


def inputs(
    made: PlanFile, problem: Path | None, classifiers: Mapping[str, Any] | None = None,
    domain: Path | None = None, streams: Path | None = None,
) -> Inputs:  # fmt: skip
    cupboard = find_domain("cupboard") if domain is None else domain
    return read_inputs(find_files(made, problem, cupboard, streams), classifiers or {})


# ---------------------------------------------------------------- which files


def test_what_is_given_counts_before_what_the_plan_names(problem: Path, tmp_path: Path) -> None:
    domain = find_domain("cupboard")
    sources = (
        PlanSource("problem", tmp_path / "gone.yaml", "0"),
        PlanSource("domain", domain, sha256(domain)),
    )
    made = replace(plan(), sources=sources)
    files = find_files(made, problem, None, None)
    assert (files.problem, files.domain.resolve()) == (problem, domain.resolve())
    assert files.given == {"problem": problem, "domain": None, "streams": None}


def test_a_file_that_is_neither_given_nor_named_is_asked_for(problem: Path) -> None:
    with pytest.raises(InputError, match="problem"):
        find_files(plan(), None, find_domain("cupboard"), None)
    with pytest.raises(InputError, match="domain"):
        find_files(plan(), problem, None, None)


# ---------------------------------------------------------------- objects, facts, the goal


def test_goal_and_facts_are_the_problems(problem: Path) -> None:
    with problem.open("a", encoding="utf-8") as file:
        file.write("init: [(hand-empty)]\n")
    read = inputs(plan(), problem)
    assert read.goal == Atom("on", ("cup", "table"))
    assert read.initial == {("hand-empty",)}
    assert read.loaded.scene.movable == ("cup",)
    assert read.streams is not None and read.streams_file is not None
    assert read.asked == {} and read.decided == frozenset()


def test_values_are_objects_of_their_type_where_the_domain_has_it(problem: Path) -> None:
    values = {"p1": Value("pose", np.eye(4)), "x1": Value("thing", None)}
    objects = inputs(plan(values=values), problem).objects
    assert objects["p1"] == ("pose",) and objects["x1"] == ("object",)
    assert objects["cup"] == ("movable",)


@pytest.mark.parametrize(
    ("made", "where"),
    [
        (plan(initial=[("at-pose", "cup", "p1")]), "initial: unknown object 'p1'"),
        (plan(certified=[("pose", "cup", "p2")]), "certified: unknown object 'p2'"),
    ],
)
def test_an_object_that_the_plan_does_not_have_is_named(
    made: PlanFile, where: str, problem: Path
) -> None:
    with pytest.raises(InputError) as caught:
        inputs(made, problem)
    assert where in caught.value.message
    assert "cup" in (caught.value.choices or ())


def test_an_argument_is_told_with_its_action(problem: Path) -> None:
    made = replace(plan_of(("pick", ("cup", "mug"), [])), objects=OBJECTS)
    with pytest.raises(InputError, match=r"actions\[0\]\.arguments: unknown object 'mug'"):
        inputs(made, problem)


# ---------------------------------------------------------------- relations of classifiers


@pytest.fixture
def own(root: Path, tmp_path: Path) -> tuple[Path, Path]:
    """A domain with a relation `upright` of the user's own, and a problem."""
    domain = write_domain(root, tmp_path, SAMPLED)
    return domain, write_problem(tmp_path, "(upright milk shelf)")


def owned(own: tuple[Path, Path], name: str) -> Inputs:
    domain, problem = own
    return inputs(replace(plan_of(), objects=everything(problem)), problem, {name: Never()}, domain)


def everything(problem: Path) -> dict[str, tuple[str, ...]]:
    return {"milk": ("movable",), "tea": ("movable",), "shelf": ("fixed", "surface")}


def test_a_classifier_decides_the_facts_of_its_relation(own: tuple[Path, Path]) -> None:
    read = owned(own, "upright")
    relation, classifier = read.asked["upright"]
    assert isinstance(classifier, Never)
    assert read.decided == relation.predicates and read.decided


def test_an_unknown_relation_is_told_with_those_that_there_are(own: tuple[Path, Path]) -> None:
    with pytest.raises(InputError, match="the streams have no relation 'uprigt'") as caught:
        owned(own, "uprigt")
    assert "upright" in (caught.value.choices or ())


def test_on_is_decided_by_geometry(own: tuple[Path, Path]) -> None:
    with pytest.raises(InputError, match="'on' is decided by the bodies' geometry"):
        owned(own, "on")
