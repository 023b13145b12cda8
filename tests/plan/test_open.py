"""A stored plan is opened with the problem that it was made for, or refused when that has changed."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.plan.open import open_plan, read_motions, robot_of
from tamp.plan.symbolic import FORMAT, is_symbolic
from tests.plan.making import plan_of

SHA = "0" * 64
DOCUMENT = {
    "format": "tamp-plan", "version": 1, "inputs": {"problem": {"path": "p.yaml", "sha256": SHA},
    "domain": {"path": "d.pddl", "sha256": SHA}}, "robot": "panda_mobile", "objects": {"cup": ["movable"]},
    "initial": [], "goal": "(and)", "values": {}, "actions": [], "certified": [], "cost": 0.0, "duration": 0.0,
}  # fmt: skip


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "plan.json"
    path.write_text(json.dumps(DOCUMENT))
    return path


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


@pytest.mark.parametrize("content", [DOCUMENT, {}, {"format": "tamp-plan"}])
def test_other_documents_are_not_symbolic(content: dict, tmp_path: Path) -> None:
    assert not is_symbolic(content)
    (tmp_path / "list.json").write_text("[1]")
    assert not is_symbolic(tmp_path / "list.json")


def test_a_robot_that_nobody_knows_is_refused_with_its_neighbour() -> None:
    from dataclasses import replace

    assert robot_of(plan_of()).name == "panda_mobile"
    with pytest.raises(
        InputError, match=r"unknown robot 'panda_mobil'.*Did you mean 'panda_mobile'?"
    ):
        robot_of(replace(plan_of(), robot="panda_mobil"))


def test_options_are_read_where_a_plan_tells_them(file: Path) -> None:
    plain = read_motions(file)
    assert (plain.algorithm, dict(plain.samplers)) == ("adaptive", {})
    file.write_text(
        json.dumps(
            {**DOCUMENT, "options": {"algorithm": "incremental", "samplers": {"on": "uniform"}}}
        )
    )
    told = read_motions(file)
    assert (told.algorithm, dict(told.samplers)) == ("incremental", {"on": "uniform"})
    assert told.source("mesh") is None and told.source("problem") is not None


def test_values_are_matrices_and_rows(file: Path) -> None:
    half = np.sqrt(0.5)
    values = {
        "p": {"type": "pose", "position": [1, 2, 3], "quaternion": [0, 0, half, half]},
        "b": {"type": "base-conf", "base": [0.1, 0.2, 0.3]},
        "g": {"type": "grasp", "body": "cup", "opening": 0.04,
              "T_tool_body": {"position": [0, 0, 0.1], "quaternion": [0, 0, 0, 1]}},
        "x": {"type": "of-a-later-version", "anything": 1},
    }  # fmt: skip
    file.write_text(json.dumps({**DOCUMENT, "values": values}))
    read = read_motions(file).values
    quarter = np.array([[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])
    assert read["p"].data == pytest.approx(quarter, abs=1e-7)
    assert read["b"].data.tolist() == [0.1, 0.2, 0.3]
    assert read["g"].data.T_tool_body[2, 3] == 0.1 and read["g"].data.opening == 0.04
    assert read["x"].data is None

    values["g"]["T_tool_body"]["position"] = [0, 0, 2.5]  # type: ignore[index]
    file.write_text(json.dumps({**DOCUMENT, "values": values}))
    with pytest.raises(
        InputError, match=r"values.g.T_tool_body.position: farther from the hand than anything"
    ):
        read_motions(file)
