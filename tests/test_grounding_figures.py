"""The figures of the groundings in miniature: measured, drawn, not measured twice, trained once."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from benchmarks.groundings import __main__ as figures
from benchmarks.groundings.__main__ import Options, main
from benchmarks.groundings.case import (
    DEPARTED,
    FAILING,
    FIGURES,
    NAMES,
    Case,
    Plan,
    cases,
)
from benchmarks.groundings.journal import Journal
from benchmarks.groundings.library import Library
from benchmarks.groundings.pictures import draw
from benchmarks.groundings.summary import failures, share
from benchmarks.paper_ways import PUBLISHED
from grounding.generate import Job, generate
from grounding.registry import MODELS, PARAMETER_FREE, SHARED_WEIGHTS, TRAINING_VARIANTS
from tamp.errors import InputError
from tests.needs import NEEDS_TORCH

pytestmark = pytest.mark.timeout(300)

WHOLE = 24
FEW = ("uniform", "uniform+mlp", "mlp-bb", "mlp-bb-classifier", "transfer")


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
        "all", relations=("on",), models=FEW, sizes=(10, 24), quick=True, out=out, **places
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
    with pytest.raises(InputError, match="unknown model 'gnn-bb-departed'"):  # of the layout paper
        main(replace(options, models=("gnn-bb-departed",)))
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


def test_figures_of_the_papers_layout_have_its_departures_too() -> None:
    plan = Plan(("on",), NAMES, (10, 100), seeds=1, scenes=5, cloud_scenes=5, draws=9)
    for figure in FIGURES:
        assert {*DEPARTED} <= {case.model for case in cases(figure, plan)}
        draws = {case.draws for case in cases(figure, plan)}
        assert draws == ({9} if figure in {"fig5", "fig6"} else {1})


@pytest.mark.parametrize(
    ("relation", "model", "network", "scheme", "departures"),
    [
        ("on", "uniform+gnn", "gnn-bb", "discriminator", set[str]()),
        ("inside", "mlp-pc", "mlp-pc", "both", set[str]()),
        ("on", "mlp-bb-classifier", "mlp-bb", "classifier", set[str]()),
        ("on", "gnn-pc-middle", "gnn-pc", "discriminator", {"middle-code"}),
        ("on", "gnn-bb-departed", "gnn-bb", "discriminator", {"edge-negatives", "own-choice"}),
        ("inside", "gnn-bb-departed", "gnn-bb", "both", {"attention", "turned-proposals"}),
    ],
)
def test_how_a_network_of_the_figures_is_trained(
    relation: str, model: str, network: str, scheme: str, departures: set[str]
) -> None:
    variant = Case("success", relation, model, 10, 0, 5).variant
    assert (variant.model, variant.scheme) == (network, scheme)
    assert departures <= {*variant.departures}
    assert bool(departures) == bool(variant.departures)


def test_a_case_of_one_draw_is_recorded_as_before_there_were_several() -> None:
    one = Case("success", "on", "flow", 10, 0, 5)
    assert "draws" not in one.config
    assert replace(one, draws=9).config == {**one.config, "draws": 9}


def test_data_of_the_papers_layout_that_are_missing_are_named(tmp_path: Path) -> None:
    library = Library(tmp_path, tmp_path, layout="paper")
    with pytest.raises(InputError, match=r"on_paper_edges_train\.npz.*no such data set") as raised:
        library.scenes("on", "train", edges=True)
    assert "tamp-learn generate on --layout paper --edges --split train" in str(raised.value)


def test_the_papers_figures_stand_beside_ours(tmp_path: Path) -> None:
    found = {
        "scenes": 10, "published": 0.4, "settled": 0.2, "feasible": 0.9,
        "blind_published": 0.8, "blind_mca": 0.9, "mca": 0.5,
    }  # fmt: skip
    lines = [
        {"seed": 0, "config": Case("success", "on", "mlp-pc", size, 0, 10, 9).config, **found}
        for size in (100, 20_000)
    ]
    path = draw("fig5", lines, tmp_path, "paper")
    assert path.name == "fig5_groundings_paper.png"
    assert path.stat().st_size > 5000
    assert path.read_bytes() != draw("fig5", lines, tmp_path).read_bytes()
    assert {model for _, model in PUBLISHED} <= {*NAMES}


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
