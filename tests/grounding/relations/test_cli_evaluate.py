"""tamp-learn evaluate of one's own relation: shares of labels and of scenes, and what is refused."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from grounding.relations import cli_evaluate as module
from grounding.relations.cli_evaluate import MOST_PICTURES, _judged, evaluate_own
from tamp.errors import InputError


class Saying:
    """A classifier whose answers are the scenes."""

    def classify(self, scene: float, arguments: Sequence[str]) -> float:
        return scene


def shown(*answers: tuple[float, bool]) -> list[Any]:
    """Demonstrations with what the classifier says of them, and whether it holds."""
    return [
        SimpleNamespace(scene=says, arguments=("a",), holds=holds, source=f"{number}.yaml:3")
        for number, (says, holds) in enumerate(answers)
    ]


def test_what_holds_and_what_does_not_are_counted_apart(capsys: pytest.CaptureFixture[str]) -> None:
    demonstrations = shown((0.9, True), (0.5, True), (0.49, True), (0.2, False), (0.5, False))
    found = _judged(Saying(), demonstrations)
    assert found == {
        "right about what holds": pytest.approx(2 / 3), "right about what does not": 0.5,
    }  # fmt: skip
    said = capsys.readouterr().out
    assert "classifier, of 3 demonstrations of what holds: 0.667 right" in said
    assert [line for line in said.splitlines() if "wrong" in line] == [
        "  wrong: 2.yaml:3",
        "  wrong: 4.yaml:3",
    ]


def test_of_labels_that_there_are_none_of_nothing_is_said(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert _judged(Saying(), shown((0.9, True))) == {"right about what holds": 1.0}
    assert "what does not" not in capsys.readouterr().out


def test_some_wrong_ones_are_enough(capsys: pytest.CaptureFixture[str]) -> None:
    _judged(Saying(), shown(*[(0.0, True)] * 9))
    assert capsys.readouterr().out.count("wrong: ") == 5


@pytest.fixture
def weights(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> dict[str, Any]:
    """What is read, proposed and drawn: a card, candidates, and the pictures that are written."""
    given: dict[str, Any] = {
        "card": {"relation": "near", "examples": ["one"]}, "pictures": [], "why": None,
        "found": [
            SimpleNamespace(stayed=n < 3, probability=0.5 if n < 2 else 0.4, bodies={}, arguments=())
            for n in range(4)
        ],
    }  # fmt: skip
    monkeypatch.setattr(module, "read_weights", lambda path: SimpleNamespace(card=given["card"]))
    monkeypatch.setattr(module, "cannot_tell", lambda card: given["why"])
    monkeypatch.setattr(module, "LearnedRelation", lambda weights: Saying())
    monkeypatch.setattr(module, "read_examples", lambda plain: plain or [])
    monkeypatch.setattr(module, "candidates", lambda *_, near: given["found"] if near == 0 else [])
    monkeypatch.setattr(
        module, "demonstrations_of", lambda name, paths: shown((0.9, True), (0.1, False))
    )
    monkeypatch.setattr(
        module, "write_picture", lambda path, *_: given["pictures"].append(path.name)
    )
    return given


def evaluated(
    capsys: pytest.CaptureFixture[str], demos: Path | None = None, pictures: Path | None = None
) -> tuple[str, dict[str, Any]]:
    evaluate_own(Path("w.safetensors"), demos, pictures, 4, 0)
    said = capsys.readouterr().out
    return said, json.loads(said.splitlines()[-1])


def test_shares_of_what_is_proposed(
    weights: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    said, figures = evaluated(capsys)
    assert figures == {
        "relation": "near", "scenes": 4, "stays in physics": 0.75,
        "holds where it lies, says the classifier": 0.5,
    }  # fmt: skip
    assert "of 4 proposals" in said and "right" not in said
    _, figures = evaluated(capsys, demos=Path("demos"))
    assert figures["right about what holds"] == figures["right about what does not"] == 1.0


def test_who_cannot_tell_is_not_asked(
    weights: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    weights["why"] = "no negatives"
    said, figures = evaluated(capsys, demos=Path("demos"))
    assert "it cannot tell yet: no negatives" in said
    assert figures.keys() == {"relation", "scenes", "stays in physics"}


def test_without_a_proposal_nothing_stays(
    weights: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    weights["found"] = []
    assert evaluated(capsys)[1]["stays in physics"] == 0.0


def test_some_pictures_into_a_new_folder(
    weights: dict[str, Any], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    weights["found"] *= 4
    said, _ = evaluated(capsys, pictures=tmp_path / "new")
    assert weights["pictures"] == [f"near_{n:02d}.png" for n in range(1, MOST_PICTURES + 1)]
    assert f"{MOST_PICTURES} pictures" in said

    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "mine.png").touch()
    for taken in (tmp_path / "full", tmp_path / "full" / "mine.png"):
        with pytest.raises(InputError, match="it is there already"):
            evaluate_own(Path("w.safetensors"), None, taken, 4, 0)


def test_weights_without_examples_make_no_scenes(
    weights: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    weights["card"]["examples"] = []
    with pytest.raises(InputError, match="the card has no examples") as caught:
        evaluate_own(Path("w.safetensors"), None, None, 4, 0)
    assert caught.value.file == "w.safetensors"

    def broken(plain: object) -> None:
        raise InputError("an example has no bodies")

    monkeypatch.setattr(module, "read_examples", broken)
    with pytest.raises(InputError, match="an example has no bodies") as caught:
        evaluate_own(Path("w.safetensors"), None, None, 4, 0)
    assert caught.value.file == "w.safetensors"
