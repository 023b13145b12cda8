"""Weights of one's own in the planner: named by file, on the command line, in a problem file, and from Python."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import tamp
from grounding.registry import GROUNDINGS, load_grounding, shipped_weights
from grounding.weights import Weights, read_weights, write_weights
from tamp.benchmark.case import relations
from tamp.commands import solve as cli
from tamp.geometric.samplers.choice import parse_choice


@pytest.fixture
def weights(tmp_path: Path) -> Path:
    """Those of `transfer` for `on`, as if they were one's own."""
    shipped = read_weights(shipped_weights("on", "transfer"))
    path = tmp_path / "mine.safetensors"
    write_weights(path, Weights(shipped.arrays, shipped.card))
    return path


def test_a_file_serves_a_relation(
    weights: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plan = tmp_path / "plan.json"
    line = f"one_object --sampler on={weights}:alone --time 30 --quiet --verify --out {plan}"
    assert cli.run(line.split()) == cli.SOLVED, capsys.readouterr()
    assert f'"on": "{weights.resolve()}:alone"' in plan.read_text()
    problem = tamp.load_problem("one_object", samplers={"on": str(weights)}, registry=GROUNDINGS)
    mixture = problem.context.mixtures["on"]
    assert mixture.names == ("mine.safetensors", "surface")


def test_a_problem_names_files_from_where_it_is(weights: Path, root: Path, tmp_path: Path) -> None:
    text = (root / "problems/one_object.yaml").read_text()
    (tmp_path / "mine.yaml").write_text(text + "\nsamplers: {on: mine.safetensors}\n")
    problem = tamp.load_problem(tmp_path / "mine.yaml", registry=GROUNDINGS)
    assert problem.samplers["on"] == str(weights.resolve())
    with pytest.raises(tamp.InputError, match=r"unknown sampler .mine\.safetensors. for .on."):
        tamp.load_problem(tmp_path / "mine.yaml")


@pytest.mark.parametrize(
    ("choice", "message"),
    [
        ("inside={}", "mine.safetensors: these are weights for 'on', not 'inside'"),
        ("on=none.safetensors", "none.safetensors: no such weight file"),
        ("on={}:alnoe", "unknown sampler"),
        (
            "lying=fast",
            "unknown relation 'lying'. Choices: on, inside, stack, pack, left_of, between. "
            "Of one's own: lying=FILE.safetensors",
        ),
    ],
)
def test_what_is_wrong_is_said(
    choice: str, message: str, weights: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.run(["one_object", "--sampler", choice.format(weights)]) == cli.BAD_INPUT
    assert message in capsys.readouterr().err


def test_a_learned_grounding_says_what_it_takes(weights: Path) -> None:
    scene = tamp.load_problem("two_objects").scene
    grounding, bodies = load_grounding(weights), list(scene.movable)
    for arguments in (bodies[:2], ["nobody", "table"]):
        with pytest.raises(
            tamp.InputError, match=f"a surface or container: not .{', '.join(arguments)}."
        ) as raised:
            grounding.propose(scene, arguments, 1, np.random.default_rng(0))
        assert "takes a body" in str(raised.value)


def test_benchmarks_take_files(weights: Path) -> None:
    assert relations(f"on={weights}", GROUNDINGS) == {"on": str(weights.resolve())}
    with pytest.raises(tamp.InputError, match="unknown sampler") as raised:
        relations("flwo", GROUNDINGS)
    assert "safetensors" not in str(raised.value)
    assert parse_choice("lying", f"{weights}:mixed", GROUNDINGS).name == str(weights.resolve())
