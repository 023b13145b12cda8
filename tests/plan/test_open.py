"""A stored plan is opened with the problem that it was made for, or refused when that has changed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.plan.open import open_plan, read_motions, robot_of
from tamp.plan.symbolic import FORMAT, is_symbolic
from tests.plan.making import SHA, moved, plan_of


def test_a_plan_with_its_problem(stored_plan: Path) -> None:
    stored = open_plan(stored_plan)
    assert stored.plan.robot == stored.robot.name == stored.loaded.scene.robot.model
    assert stored.document["format"] == "tamp-plan"
    assert {name.lower() for name in stored.loaded.scene.movable} <= stored.plan.objects.keys()


def test_a_problem_that_is_gone_is_named_with_the_way_out(file: Path) -> None:
    with pytest.raises(
        InputError, match=r"the plan's problem p.yaml is missing. Give --problem FILE"
    ):
        open_plan(file)
    assert read_motions(file).actions == ()  # who needs no scene does not mind


def test_a_problem_that_has_changed_is_refused(stored_plan: Path, tmp_path: Path) -> None:
    document = json.loads(stored_plan.read_text())
    problem = Path(document["inputs"]["problem"]["path"])
    changed = tmp_path / "changed.yaml"
    changed.write_text(problem.read_text() + "\n# another line\n")
    with pytest.raises(
        InputError, match=r"changed.yaml is not the one that the plan was made from.*Plan again"
    ):
        open_plan(stored_plan, changed)

    document["inputs"]["domain"]["sha256"] = SHA
    spoilt = tmp_path / "plan.json"
    spoilt.write_text(json.dumps(document))
    for read in (open_plan, read_motions):
        with pytest.raises(
            InputError,
            match=r"the domain .*cupboard.pddl is not the one that the plan was made from",
        ):
            read(spoilt)


def test_a_plan_in_pddl_alone_has_no_motion(file: Path) -> None:
    symbolic = {"format": FORMAT, "version": 1, "actions": []}
    file.write_text(json.dumps(symbolic))
    for read in (open_plan, read_motions):
        with pytest.raises(
            InputError, match="a plan of a problem in PDDL alone has no scene and no motion"
        ):
            read(file)
    assert is_symbolic(file) and is_symbolic(symbolic)


def test_a_robot_that_nobody_knows_is_refused_with_its_neighbour() -> None:
    from dataclasses import replace

    assert robot_of(plan_of()).name == "panda_mobile"
    with pytest.raises(
        InputError, match=r"unknown robot 'panda_mobil'.*Did you mean 'panda_mobile'?"
    ):
        robot_of(replace(plan_of(), robot="panda_mobil"))


def test_a_plan_opens_with_its_scene_and_robot(stored_plan: Path, tmp_path: Path) -> None:
    stored = open_plan(stored_plan)
    assert stored.loaded.scene.name == "one_object"
    assert stored.robot.name == robot_of(read_motions(stored_plan)).name == "panda_mobile"
    plan, problem = moved(stored_plan, tmp_path)
    elsewhere = tmp_path / "elsewhere.yaml"
    problem.rename(elsewhere)
    with pytest.raises(Exception, match="Give --problem FILE"):
        open_plan(plan)
    assert open_plan(plan, elsewhere).loaded.path == elsewhere
