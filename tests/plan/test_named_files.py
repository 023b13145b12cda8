"""Files of the user's that a problem names beside its scene: found from the problem's folder."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tamp.geometric.loading.load import LoadedProblem, load_scene
from tamp.plan.named_files import named_files
from tamp.system.files import shipped

SCENE = """
domain: mine.pddl
robot: {model: panda_mobile, base: [0.0, 0.0, 0.0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  table: {furniture: table, size: [1.2, 0.7, 0.7], at: [1.6, 0, 0]}
goal: (and)
"""


@pytest.fixture
def loaded(tmp_path: Path) -> LoadedProblem:
    (tmp_path / "problem.yaml").write_text(SCENE)
    (tmp_path / "mine.pddl").write_text("(define (domain mine))")
    return load_scene(tmp_path / "problem.yaml")


def test_the_domain_is_named_with_its_streams(loaded: LoadedProblem) -> None:
    folder = loaded.path.parent
    assert named_files(loaded) == (folder / "mine.pddl", folder / "mine.streams.pddl")


def test_a_shipped_domain_is_where_it_ships(loaded: LoadedProblem) -> None:
    domain, streams = named_files(replace(loaded, domain="cupboard"))
    assert domain == shipped("domains") / "cupboard.pddl"
    assert streams == shipped("domains") / "cupboard.streams.pddl"


@pytest.mark.parametrize("domain", [None, "gone.pddl"])
def test_without_a_domain_there_are_none(loaded: LoadedProblem, domain: str | None) -> None:
    assert named_files(replace(loaded, domain=domain)) == ()


def test_samplers_files_are_named_with_their_cards(loaded: LoadedProblem, tmp_path: Path) -> None:
    weights = "left_of.safetensors"
    samplers = {"left_of": f"{weights}:alone", "near": str(tmp_path / "far" / "near.py"), "on": "x"}
    found = named_files(replace(loaded, samplers=samplers, domain=None))
    folder = loaded.path.parent
    assert {folder / weights, folder / "left_of.json", tmp_path / "far" / "near.py"} <= {*found}
    assert not any(file.stem in ("on", "x") for file in found)
