"""The rows of `benchmarks.paper_variants`: what is trained for each, on which data set."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.paper_variants import Options, main
from benchmarks.paper_ways import BEST, CLASSIFIERS, VARIANTS, Variant
from tamp.errors import InputError
from tests.needs import NEEDS_TORCH


def test_rows_have_names_of_their_own() -> None:
    names = [variant.name for variant in VARIANTS]
    assert len({*names}) == len(names)


@NEEDS_TORCH
def test_departures_are_those_of_the_training() -> None:
    from grounding.paper.training import DEPARTURES  # which imports torch

    assert {name for variant in VARIANTS for name in variant.departures} <= {*DEPARTURES}
    assert {*CLASSIFIERS} <= {*DEPARTURES}


@pytest.mark.parametrize(
    ("departures", "trained", "train_set"),
    [
        ((), (), "on_paper_train.npz"),
        (("attention", "own-choice", "turned-proposals"), ("attention",), "on_paper_train.npz"),
        (("edge-negatives", "own-choice"), ("edge-negatives",), "on_paper_edges_train.npz"),
    ],
)
def test_what_is_trained_for_a_row(
    departures: tuple[str, ...], trained: tuple[str, ...], train_set: str
) -> None:
    variant = Variant("gnn-bb", "discriminator", departures)
    assert variant.trained == Variant("gnn-bb", "discriminator", trained)
    assert variant.set_name("on", "train") == train_set
    assert variant.set_name("on", "test") == "on_paper_test.npz"


def test_the_household_layout_has_names_of_its_own() -> None:
    assert Variant("mlp-bb", "both").set_name("inside", "train", "household") == "inside_train.npz"


def test_what_passes_the_ceiling_is_among_the_rows() -> None:
    assert {*BEST.values()} <= {*VARIANTS}


@pytest.mark.parametrize(
    ("layout", "name", "said"),
    [
        ("paper", "mlp-bb discriminatr", "Choices: mlp-bb, gnn-bb, mlp-pc"),
        ("household", BEST["on"].name, "layout 'household' has no variant"),
    ],
)
def test_a_row_that_is_none_is_said(layout: str, name: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=said):
        main(Options(layout=layout, variants=(name,), out=tmp_path / "r.jsonl"))  # type: ignore[arg-type]
