"""Weights of a learned relation: written, read again, damaged."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from grounding.registry import file_grounding, is_few_shot
from grounding.relations.demonstration_file import Demonstration
from grounding.relations.files import weights_of
from grounding.relations.grounding import LearnedRelation
from grounding.relations.learner import Learned
from grounding.runtime import Proposer
from grounding.weights import Weights, read_weights, write_weights
from tamp.errors import InputError


def test_weights_say_the_same_when_they_are_read(
    learned: Learned, demos: list[Demonstration], tmp_path: Path
) -> None:
    path = tmp_path / "left_of.safetensors"
    write_weights(path, weights_of(learned, {"seed": 0}))
    again, first = file_grounding("left_of", path), LearnedRelation(weights_of(learned, {}))
    assert isinstance(again, LearnedRelation) and is_few_shot(str(path))
    right = 0
    for one in demos:
        answer = again.classify(one.scene, one.arguments)
        assert answer == first.classify(one.scene, one.arguments)
        right += (answer >= 0.5) == one.holds
        poses = [
            relation.propose(one.scene, one.arguments, 4, np.random.default_rng(1))
            for relation in (again, first)
        ]
        assert poses[0] == poses[1] and 1 <= len(poses[0]) <= 4
    assert right >= 19
    with pytest.raises(InputError, match="weights for 'left_of', not 'right_of'"):
        file_grounding("right_of", path)
    with pytest.raises(InputError, match="has 2 arguments, not 1"):
        first.classify(demos[0].scene, ("cup",))


def test_a_classifier_that_cannot_tell_is_none(learned: Learned, tmp_path: Path) -> None:
    path = tmp_path / "left_of.safetensors"
    write_weights(path, weights_of(replace(learned, cannot_tell="because"), {}))
    found = file_grounding("left_of", path)
    assert isinstance(found, Proposer) and found.cannot_tell == "because"


@pytest.mark.parametrize(
    ("array", "value", "message"),
    [
        ("classifier_conditions", np.full((2, 2), 999), "do(es)? not fit together|has the shape"),
        ("classifier_used", np.array([100_000]), "do not fit together"),
        ("classifier_zero", np.zeros(3), "'classifier_zero' has the shape"),
        ("ranking_soft", None, "array 'ranking_soft' is missing"),
        ("shown_codes", np.full((5, 4), 50), "names what is not there"),
        ("shown_R", np.zeros((2, 2)), "do not fit together"),
    ],
)
def test_damaged_weights_are_refused(
    learned: Learned, array: str, value: np.ndarray | None, message: str
) -> None:
    whole = weights_of(learned, {})
    arrays = {name: one for name, one in whole.arrays.items() if name != array}
    if value is not None:
        arrays[array] = value
    with pytest.raises(InputError, match=message):
        LearnedRelation(Weights(arrays, whole.card))


@pytest.mark.parametrize(
    ("entry", "value", "message"),
    [("version", 99, "of version 99"), ("kinds", ["cup"], "'kinds'"), ("level", 7, "'level' is 7")],
)
def test_a_wrong_card_is_refused(learned: Learned, entry: str, value: object, message: str) -> None:
    whole = weights_of(learned, {})
    with pytest.raises(InputError, match=message):
        LearnedRelation(Weights(whole.arrays, {**whole.card, entry: value}))


def test_the_card_says_how_well_it_did(learned: Learned, tmp_path: Path) -> None:
    write_weights(tmp_path / "x.safetensors", weights_of(learned, {"seed": 3}))
    card = read_weights(tmp_path / "x.safetensors").card
    assert card["model"] == "conjunctions" and card["positive"] == 10 and card["samples"] == 20
    assert (
        card["kinds"] == ["movable", "movable"]
        and card["held out"][0] > 0.7
        and card["classifies"] is True
    )
