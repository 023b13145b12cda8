"""Scenes to be asked about: what has to be there, and that the most telling ones come first."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from grounding.demonstrate import questions as module
from grounding.demonstrate.folder import DemonstrationFolder
from grounding.demonstrate.questions import POOL_SCENES, QUESTIONS_AT_ONCE, telling_stages
from grounding.demonstrate.relation import parse_relation
from grounding.demonstrate.scene import Stage, sample_stage
from grounding.demonstrate.use import Uses
from grounding.relations.candidates import Candidate
from grounding.relations.demonstration_file import Label
from grounding.relations.grounding import LearnedRelation
from grounding.relations.situation import Situations
from grounding.runtime import Proposer
from tamp.errors import InputError

STACK = parse_relation("stack(a, b)")
COMMITTEE = object()


@pytest.fixture(scope="module")
def stage() -> Stage:
    return sample_stage(STACK, np.random.default_rng(0))


@pytest.fixture
def learned(monkeypatch: pytest.MonkeyPatch) -> LearnedRelation:
    """What the weights are: a relation of whose committee nobody asks anything here."""
    made = LearnedRelation.__new__(LearnedRelation)
    made.committee = COMMITTEE  # pyright: ignore[reportAttributeAccessIssue]
    monkeypatch.setattr(module, "load_grounding", lambda path: made)
    return made


@pytest.fixture
def uses_of(tmp_path: Path, stage: Stage) -> Callable[..., Uses]:
    """Makes the files of a relation that was demonstrated with these labels, and learned."""

    def made(*labels: bool) -> Uses:
        folder = DemonstrationFolder(tmp_path, STACK)
        for holds in labels:
            folder.add(stage.file(Label("stack", stage.arguments, holds)))
        uses = Uses("stack", tmp_path)
        uses.weights.write_text("weights")
        return uses

    return made


def refused(uses: Uses) -> InputError:
    with pytest.raises(InputError) as caught:
        telling_stages(uses, np.random.default_rng(0))
    return caught.value


def test_it_has_to_be_learned_first(tmp_path: Path) -> None:
    error = refused(Uses("stack", tmp_path))
    assert error.message == "stack has not been learned yet" and error.remedy == "Learn it first"


def test_what_only_proposes_wants_more_labels(
    uses_of: Callable[..., Uses], monkeypatch: pytest.MonkeyPatch
) -> None:
    proposer = Proposer(SimpleNamespace(), "no negatives")
    monkeypatch.setattr(module, "load_grounding", lambda path: proposer)
    error = refused(uses_of(True))
    assert "cannot tell yet where stack holds" in error.message
    assert "both labels" in error.remedy


def test_weights_of_another_model_cannot_be_asked(
    uses_of: Callable[..., Uses], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "load_grounding", lambda path: SimpleNamespace())
    uses = uses_of(True)
    error = refused(uses)
    assert error.message == "nothing can be asked of these weights" and error.file == str(
        uses.weights
    )


def test_a_demonstration_in_which_it_holds_is_needed(
    uses_of: Callable[..., Uses], learned: LearnedRelation
) -> None:
    assert refused(uses_of(False)).message == "no demonstration says where stack holds"


def test_without_candidates_there_is_nothing_to_ask(
    uses_of: Callable[..., Uses], learned: LearnedRelation, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "gather", lambda *_: None)
    monkeypatch.setattr(module, "candidates", lambda *_: [])
    assert refused(uses_of(True, False)).message == "no scene to ask about was found"


@pytest.mark.parametrize("labels", [(True, False, True), (True, True)])
def test_the_most_telling_candidates_are_shown_first(
    labels: tuple[bool, ...], uses_of: Callable[..., Uses], learned: LearnedRelation, stage: Stage,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    pool = [
        Candidate(stage.entries, stage.scene, stage.arguments, True, True, 0.1 * n)
        for n in range(4)
    ]
    rows, evidence = [3, 1], object()

    def gathered(positives: Situations, negatives: Situations | None, rng: object) -> object:
        assert len(positives) == sum(labels)
        assert (0 if negatives is None else len(negatives)) == len(labels) - sum(labels)
        return evidence

    def made(relation: object, examples: Any, count: int, rng: object) -> list[Candidate]:
        assert relation is learned and count == POOL_SCENES
        return pool

    def chosen(given: object, committee: object, found: Situations, count: int) -> np.ndarray:
        assert given is evidence and committee is COMMITTEE
        assert len(found) == len(pool) and count == QUESTIONS_AT_ONCE
        return np.array(rows)

    monkeypatch.setattr(module, "gather", gathered)
    monkeypatch.setattr(module, "candidates", made)
    monkeypatch.setattr(module, "questions", chosen)
    pool[3] = Candidate(stage.entries, stage.scene, stage.arguments[::-1], True, True, 0.5)
    found = telling_stages(uses_of(*labels), np.random.default_rng(0))
    assert [one.arguments for one in found] == [stage.arguments[::-1], stage.arguments]
    assert all(one.scene is stage.scene and one.entries is stage.entries for one in found)
