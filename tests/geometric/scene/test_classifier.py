"""What a classifier of one's own may answer, and how an answer that is none is told."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest

from tamp.geometric.scene.classifier import Classifier, NoClassifier, Unanswered, probability
from tamp.geometric.scene.scene import Scene
from tests.geometric.making import scene, table

SCENE = scene(table())


class Answering:
    """Answers the same to every question, or raises it, and keeps what it was asked."""

    def __init__(self, answer: object) -> None:
        self.answer = answer
        self.asked: list[Sequence[str]] = []

    def classify(self, scene: Scene, arguments: Sequence[str]) -> float:
        self.asked.append(arguments)
        if isinstance(self.answer, BaseException):
            raise self.answer
        return self.answer  # type: ignore[return-value]


@pytest.mark.parametrize(
    "answer", [0, 1, 0.25, True, np.float32(0.5), np.array(0.75), "0.5", 1 + 5e-7, -5e-7]
)
def test_what_reads_as_a_number_in_0_1_is_a_probability(answer: object) -> None:
    assert probability(Answering(answer), SCENE, ["cup", "table"]) == float(answer)  # type: ignore[arg-type]


def test_it_is_asked_with_a_tuple() -> None:
    asked = Answering(1.0)
    probability(asked, SCENE, ["cup", "table"])
    assert asked.asked == [("cup", "table")]


def test_not_a_number_says_that_it_cannot_tell() -> None:
    assert math.isnan(probability(Answering(math.nan), SCENE, ["cup"]))


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (1.5, "it returned 1.5, which is no probability"),
        (-0.1, "it returned -0.1, which is no probability"),
        (math.inf, "it returned inf, which is no probability"),
        (-math.inf, "it returned -inf, which is no probability"),
        (None, "it raised TypeError: "),
        ("likely", "it raised ValueError: could not convert string to float"),
        (ValueError("no such body"), "it raised ValueError: no such body"),
        (KeyError(), "it raised KeyError$"),
        (SystemExit(3), "it raised SystemExit: 3"),
    ],
)
def test_anything_else_is_no_answer(answer: object, words: str) -> None:
    with pytest.raises(Unanswered, match=words):
        probability(Answering(answer), SCENE, ["cup"])


def test_an_interrupt_passes() -> None:
    with pytest.raises(KeyboardInterrupt):
        probability(Answering(KeyboardInterrupt()), SCENE, ["cup"])


def test_who_is_a_classifier_and_who_is_none_yet() -> None:
    class Silent:
        cannot_tell = "it was trained without labels"

    assert isinstance(Answering(1.0), Classifier) and not isinstance(Answering(1.0), NoClassifier)
    assert isinstance(Silent(), NoClassifier) and not isinstance(Silent(), Classifier)
