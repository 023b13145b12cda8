"""What a learned classifier thinks of the scene on the page, where there is one that can tell."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from grounding.demonstrate import opinion as module
from grounding.demonstrate.opinion import Opinion
from grounding.demonstrate.relation import parse_relation
from grounding.demonstrate.scene import Stage, sample_stage
from grounding.demonstrate.use import Uses
from grounding.runtime import Proposer
from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Scene


@pytest.fixture(scope="module")
def stage() -> Stage:
    return sample_stage(parse_relation("stack(a, b)"), np.random.default_rng(0))


class Height:
    """How high the first argument is, in tens of metres, or what it is told to say."""

    def __init__(self, says: float | Exception | None = None) -> None:
        self.says, self.asked = says, list[tuple[str, ...]]()

    def classify(self, scene: Scene, arguments: Sequence[str]) -> float:
        self.asked.append(tuple(arguments))
        if isinstance(self.says, Exception):
            raise self.says
        return scene.bodies[arguments[0]].pose.position[2] / 10 if self.says is None else self.says


class Shelf:
    """The files of a relation, and what is loaded of them."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.uses, self.loaded = Uses("stack", folder), 0
        self.learned: Any = Height()
        monkeypatch.setattr(module, "load_grounding", self.load)

    def load(self, path: Path) -> Any:
        assert path == self.uses.weights
        self.loaded += 1
        if isinstance(self.learned, Exception):
            raise self.learned
        return self.learned

    def write(self, learned: Any, content: str = "weights", time: int = 1) -> None:
        self.learned = learned
        self.uses.weights.write_text(content)
        os.utime(self.uses.weights, ns=(time, time))


@pytest.fixture
def shelf(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Shelf:
    return Shelf(tmp_path, monkeypatch)


def test_where_nothing_was_learned_there_is_no_opinion(shelf: Shelf, stage: Stage) -> None:
    assert Opinion().of(shelf.uses, stage, {}) is None and shelf.loaded == 0


def test_it_is_about_the_arguments_where_the_page_has_them(shelf: Shelf, stage: Stage) -> None:
    shelf.write(classifier := Height())
    opinion, (name, *_) = Opinion(), stage.arguments
    there = Pose((0.0, 0.0, 4.0))
    assert opinion.of(shelf.uses, stage, {name: there}) == pytest.approx(0.4)
    own = stage.scene.bodies[name].pose.position[2] / 10
    assert opinion.of(shelf.uses, stage, {}) == pytest.approx(own)
    assert {*classifier.asked} == {stage.arguments}


def test_a_file_is_loaded_again_when_it_has_changed_and_only_then(
    shelf: Shelf, stage: Stage, tmp_path: Path
) -> None:
    opinion = Opinion()
    shelf.write(Height(0.25))
    assert [opinion.of(shelf.uses, stage, {}) for _ in range(3)] == [0.25] * 3
    assert shelf.loaded == 1
    shelf.write(Height(0.5), time=2)
    assert opinion.of(shelf.uses, stage, {}) == 0.5
    shelf.write(Height(0.75), content="others", time=2)
    assert opinion.of(shelf.uses, stage, {}) == 0.75

    shelf.uses = Uses("stack", tmp_path / "other")
    shelf.uses.folder.mkdir()
    shelf.write(Height(1.0), content="others", time=2)
    assert opinion.of(shelf.uses, stage, {}) == 1.0 and shelf.loaded == 4


def test_what_cannot_be_loaded_has_no_opinion_until_it_changes(shelf: Shelf, stage: Stage) -> None:
    opinion = Opinion()
    shelf.write(InputError("damaged"))
    assert [opinion.of(shelf.uses, stage, {}) for _ in range(2)] == [None, None]
    assert shelf.loaded == 1
    shelf.write(Height(0.5), time=2)
    assert opinion.of(shelf.uses, stage, {}) == 0.5


def test_what_only_proposes_has_no_opinion(shelf: Shelf, stage: Stage) -> None:
    shelf.write(Proposer(Height(1.0), "no negatives"))
    assert Opinion().of(shelf.uses, stage, {}) is None


@pytest.mark.parametrize("says", [math.nan, InputError("two arguments are wanted")])
def test_what_it_cannot_tell_is_no_opinion(
    says: float | Exception, shelf: Shelf, stage: Stage
) -> None:
    shelf.write(Height(says))
    assert Opinion().of(shelf.uses, stage, {}) is None


def test_of_a_body_below_the_floor_nobody_is_asked(shelf: Shelf, stage: Stage) -> None:
    shelf.write(classifier := Height(1.0))
    below = {stage.arguments[0]: Pose((0.0, 0.0, -3.0))}
    assert Opinion().of(shelf.uses, stage, below) is None and classifier.asked == []
