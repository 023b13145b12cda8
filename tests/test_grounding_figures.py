"""The figures of the groundings in miniature: measured, drawn, not measured twice, trained once."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from benchmarks.groundings import __main__ as figures
from benchmarks.groundings.__main__ import Options, main
from benchmarks.groundings.case import FAILING, FIGURES, Case, Plan, cases
from benchmarks.groundings.journal import Journal
from benchmarks.groundings.summary import failures, share
from grounding.generate import Job, generate
from grounding.registry import MODELS, PARAMETER_FREE, SHARED_WEIGHTS, TRAINING_VARIANTS
from tamp.errors import InputError
from tests.needs import NEEDS_TORCH

pytestmark = pytest.mark.timeout(300)

WHOLE = 24
NAMES = ("uniform", "uniform+mlp", "mlp-bb", "mlp-bb-classifier", "transfer")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With on_train.npz, and the same again as on_test.npz: to make other bodies takes a while."""
    folder = tmp_path_factory.mktemp("figures")
    generate(Job("on", "train", WHOLE), folder / "on_train.npz", workers=1)
    for suffix in (".npz", ".json"):
        shutil.copy(folder / f"on_train{suffix}", folder / f"on_test{suffix}")
    return folder


@pytest.fixture
def options(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Options:
    """Of a run that is quicker than --quick."""
    for name, value in (("TRAIN", WHOLE), ("TEST", 8), ("ITERATIONS", 3)):
        monkeypatch.setattr(figures, f"QUICK_{name}", value)
    places = {"data": folder, "weights": folder / "weights", "pictures": folder / "pictures"}
    out = folder / "results.jsonl"
    return Options(
        "all", relations=("on",), models=NAMES, sizes=(10, 24), quick=True, out=out, **places
    )


@NEEDS_TORCH
def test_all_figures_are_measured_once_and_drawn(
    options: Options,
    folder: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    main(options)
    said = capsys.readouterr()
    for figure in FIGURES:
        assert (folder / "pictures" / f"{figure}_groundings.png").stat().st_size > 5000
        assert f"{figure}_groundings.png written" in said.out
    # uniform+mlp has mlp-bb's classifier: one training for both, in all four figures
    assert said.err.count("training") == 2 + 2 + 1
    lines = [json.loads(line) for line in (folder / "results.jsonl").read_text().splitlines()]
    assert {"commit", "machine", "seed", "load"} <= lines[0].keys()
    configs = [tuple(line["config"].values()) for line in lines]
    assert (
        len(configs) == len(set(configs)) == 2 + 7 + 1 + 4
    )  # of each figure what those before it lack
    success = [line for line in lines if line["config"]["measure"] == "success"]
    for line in success:
        assert line["mca"] + sum(line["mca_failures"].values()) == pytest.approx(1.0)
        assert line["settled"] + sum(line["failures"].values()) == pytest.approx(1.0)

    monkeypatch.setattr(figures, "MEASURES", {})  # nothing is left to be measured
    main(options)
    assert "training" not in capsys.readouterr().err
    assert len((folder / "results.jsonl").read_text().splitlines()) == len(lines)


def test_what_is_missing_is_left_out_without_training(
    options: Options, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bare = replace(
        options,
        figure="fig5",
        models=("uniform", "transfer"),
        train=False,
        weights=tmp_path,
        out=tmp_path / "r.jsonl",
    )
    main(bare)
    assert (
        "fig5: without weights, left out: on transfer 24 0, on transfer 10 0"
        in capsys.readouterr().out
    )
    (line,) = (tmp_path / "r.jsonl").read_text().splitlines()
    assert json.loads(line)["config"]["model"] == "uniform"


def test_mistakes_are_said(options: Options, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="Did you mean 'transfer'"):
        main(replace(options, models=("transfre",)))
    with pytest.raises(InputError, match=r"on_test\.npz: no such data set"):
        main(
            replace(
                options, quick=False, models=("uniform",), data=tmp_path, out=tmp_path / "r.jsonl"
            )
        )


def test_a_line_that_was_cut_off_is_measured_again(tmp_path: Path) -> None:
    path, one = tmp_path / "r.jsonl", Case("success", "on", "flow", 10, 0, 5)
    other = replace(one, seed=1)
    Journal(path, Case).add(one, mca=0.5)
    path.write_bytes(path.read_bytes() + b'{"config": {"meas')
    journal = Journal(path, Case)
    assert journal.missing([one, other, other]) == [other]
    journal.add(other, mca=0.25)
    assert [line["mca"] for line in Journal(path, Case).found([other, one])] == [0.5, 0.25]
    path.write_text('{"config": {"problem": "swap"}}\n')
    with pytest.raises(InputError, match="no measurement of a grounding"):
        Journal(path, Case)


def test_the_cases_of_the_figures() -> None:
    assert {*FAILING} == {*MODELS, *TRAINING_VARIANTS, *PARAMETER_FREE}
    plan = Plan(("on", "inside"), FAILING, (10, 100), seeds=3, scenes=500, cloud_scenes=200)
    for figure in FIGURES:
        found = cases(figure, plan)
        assert {case.samples for case in found} == {0, 100} | ({10} if figure == "fig5" else set())
        assert {case.seed for case in found} == ({0} if figure == "fig7" else {0, 1, 2})
        times = {"fig4": 2, "fig7": 0.1}.get(figure, 1)
        assert {case.scenes for case in found} == {500 * times, 200 * times}
    assert {case for case in cases("fig6", plan) if case.model not in TRAINING_VARIANTS} < {
        *cases("fig5", plan)
    }
    borrowed = Case("success", "on", "uniform+gnn", 100, 2, 5)
    assert (
        borrowed.weights
        == replace(borrowed, model=SHARED_WEIGHTS["uniform+gnn"]).weights
        == "on-gnn-bb-100-2"
    )


def test_means_over_seeds_and_the_interval_of_one_seeds_scenes() -> None:
    lines = [
        {"mca": 0.4, "scenes": 10, "mca_failures": {"outside": 0.6}},
        {"mca": 0.6, "scenes": 10},
    ]
    lines[1]["mca_failures"] = {"outside": 0.2, "collides": 0.2}
    found = share(lines, "mca")
    assert found.mean == pytest.approx(0.5) and found.each == (0.4, 0.6)
    assert found.interval == pytest.approx((0.2366, 0.7634), abs=1e-4)  # 5 of 10
    assert failures(lines, "mca") == pytest.approx({"outside": 0.4, "collides": 0.1})
