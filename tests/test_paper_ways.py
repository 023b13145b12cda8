"""The rows of `benchmarks.paper_variants`: what is trained for each, on which data set."""

from __future__ import annotations

import pytest

from benchmarks.paper_ways import CLASSIFIERS, VARIANTS, Variant
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
