"""--why names a change that makes a problem solvable, and each change is one that can be."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from benchmarks.infeasible import named
from benchmarks.infeasible_scenes import KINDS
from tamp.cli import NO_PLAN, SOLVED, run
from tamp.problem import load_problem
from tamp.relaxation.changes import changes

BY_NAME = {make.__name__: (number, make) for number, make in enumerate(KINDS)}


def written(kind: str, folder: Path, seed: int = 0) -> Path:
    number, make = BY_NAME[kind]
    path = folder / f"{kind}.yaml"
    path.write_text(make(np.random.default_rng((number, seed))).text, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("kind", "change"),
    [
        ("start_too_high", "if board were 0.75 m high"),
        ("start_outside", "if far_table stood at"),
        ("fixed", "could be moved"),
        ("too_tall", "half its size"),
        ("two_places", "without the goal"),
        ("loaded", "without slab"),
    ],
)
def test_the_smallest_change(kind: str, change: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "plan.json"
    assert run([str(written(kind, tmp_path)), "--why", "--json", "--out", str(out)]) == NO_PLAN
    document = json.loads(capsys.readouterr().out)
    assert document["outcome"] == "infeasible" and not out.exists()
    found = document["why"]["relaxations"]
    assert any(change in one["change"] and one["actions"] >= 4 for one in found), document["why"]


def test_in_words(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run([str(written("loaded", tmp_path)), "--why", "--out", str(tmp_path / "plan.json")]) == NO_PLAN
    text = capsys.readouterr().out
    assert "It would be solvable without slab" in text and text.count("No plan") == 1


def test_nothing_is_asked_when_there_is_a_plan(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["one_object", "--why", "--json", "--out", str(tmp_path / "plan.json")]) == SOLVED
    assert "why" not in json.loads(capsys.readouterr().out)


@pytest.mark.parametrize("kind", BY_NAME)
def test_every_change_makes_one_thing_different(kind: str, tmp_path: Path) -> None:
    problem = load_problem(written(kind, tmp_path))
    for change in changes(problem):
        assert (change.scene is None) != (change.goal is None)
        assert change.about and change.text
        if change.scene is not None:
            ours, theirs = problem.scene.bodies, change.scene.bodies
            different = {name for name in ours if name not in theirs or theirs[name] is not ours[name]}
            assert different & set(change.about) and theirs.keys() <= ours.keys()


@pytest.mark.parametrize("kind", ["start_too_high", "too_wide", "fixed", "two_places"])
@pytest.mark.parametrize("seed", [3, 4])
def test_the_benchmark_names_causes_that_are_there(kind: str, seed: int) -> None:
    number, make = BY_NAME[kind]
    case = make(np.random.default_rng((number, seed)))
    assert not named(case, ("no plan in the time given",)) and not named(case, ())
    assert named(case, (" ".join(group[0] for group in case.cause),))
