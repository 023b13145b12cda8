"""tamp-learn ask and explore: what a person answers becomes a demonstration, and nothing else does."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from grounding.relations import cli_ask as module
from grounding.relations.candidates import Candidate
from grounding.relations.cli_ask import ask, explore_own
from grounding.relations.demonstration_file import demonstrations_of
from grounding.relations.demonstration_text import BodyEntry
from grounding.relations.options import Ask
from grounding.relations.scenes import loaded
from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose


def candidate(
    height: float, probability: float, proposed: bool = True, stayed: bool = True
) -> Candidate:
    """A block that stands on a table; how high that one is tells the candidates apart."""
    on = Pose.from_xyz_yaw(1.0, 0.0, height + 0.051, 0.3)
    bodies = {
        "table": BodyEntry(
            {"furniture": "table", "size": [1.0, 0.7, height]}, Pose.from_xyz_yaw(1.0, 0, 0, 0)
        ),
        "block": BodyEntry({"box": [0.06, 0.08, 0.1]}, on),
    }
    scene = loaded(bodies, ("block", "table"))
    return Candidate(bodies, scene, ("block", "table"), proposed, stayed, probability)


POOL = [candidate(0.5, 0.9), candidate(0.6, 0.2, stayed=False), candidate(0.7, 0.5, proposed=False)]


@pytest.fixture
def pool(monkeypatch: pytest.MonkeyPatch) -> list[Candidate]:
    """The candidates that are found; the last one tells most."""
    found = [*POOL]
    state = SimpleNamespace(
        name="lying", shown=[], relation=None, learned=SimpleNamespace(committee=None),
        rows=lambda holds: None, missing=lambda: ["all surfaces were 0.7 m high"],
    )  # fmt: skip
    monkeypatch.setattr(module._Learned, "of", lambda *_: state)
    monkeypatch.setattr(module, "examples_of", lambda shown: [])
    monkeypatch.setattr(module, "candidates", lambda *_: found)
    monkeypatch.setattr(module, "gather", lambda *_: None)
    monkeypatch.setattr(
        module, "questions",
        lambda evidence, committee, situations, count: np.arange(len(found))[::-1][:count],
    )  # fmt: skip
    monkeypatch.setattr(
        module, "write_picture", lambda path, *_: (path.parent.mkdir(exist_ok=True), path.touch())
    )
    return found


@pytest.fixture
def answered(
    pool: list[Candidate], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Callable[..., dict[float, bool]]:
    """Answers questions; what was written then, by the tables' heights."""

    def made(said: str, **options: Any) -> dict[float, bool]:
        monkeypatch.setattr("sys.stdin", io.StringIO(said))
        ask(Ask("lying", demos=tmp_path, **options))
        found = demonstrations_of("lying", [tmp_path]) if [*tmp_path.glob("*.yaml")] else ()
        return {round(one.scene.surfaces["table"].pose.position[2], 3): one.holds for one in found}

    return made


def test_answers_are_demonstrations_the_most_telling_question_first(
    answered: Callable[..., dict[float, bool]], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert answered("yes\nN\n", count=2) == {0.7: True, 0.6: False}
    said = capsys.readouterr().out
    assert said.startswith("missing: all surfaces were 0.7 m high\n")
    assert "1. does (lying block table) hold here?" in said and "2 answered. Learn again" in said
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        f"lying_asked_00{number}.{kind}" for number in (1, 2) for kind in ("png", "yaml")
    ]


@pytest.mark.parametrize("said", ["s\nskip\n\n", "q\n", "", "quit\ny\n"])
def test_what_is_skipped_leaves_nothing_behind(
    said: str, answered: Callable[..., dict[float, bool]], tmp_path: Path
) -> None:
    assert answered(said) == {} and [*tmp_path.iterdir()] == []


def test_who_quits_keeps_what_was_answered(
    answered: Callable[..., dict[float, bool]], tmp_path: Path
) -> None:
    assert answered("y\nq\n", pictures=False) == {0.7: True}
    assert [path.suffix for path in tmp_path.iterdir()] == [".yaml"]
    answered("n\n", count=1, pictures=False)
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["lying_asked_001.yaml", "lying_asked_002.yaml"]


def test_an_answer_that_is_none_is_refused(answered: Callable[..., dict[float, bool]]) -> None:
    with pytest.raises(InputError, match="'maybe' is no answer"):
        answered("maybe\n")


def test_where_nothing_is_proposed_nothing_is_asked(
    pool: list[Candidate], answered: Callable[..., dict[float, bool]]
) -> None:
    pool.clear()
    with pytest.raises(InputError, match="no scene to ask about was found"):
        answered("yes\n")


def test_without_demonstrations_there_is_nothing_to_ask(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no demonstrations there"):
        ask(Ask("lying", demos=tmp_path / "none"))


def test_exploring_writes_what_the_classifier_takes_each_scene_for(
    pool: list[Candidate], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "found"
    explore_own("lying", tmp_path, out, 3, 0)
    found = list(demonstrations_of("lying", [out]))
    assert [one.holds for one in found] == [True, False, True]  # 0.9, 0.2, and a half
    first = (out / "lying_001.yaml").read_text().splitlines()[0]
    assert first == "# Yes, says the classifier (0.90). Right?"
    assert "No, says the classifier (0.20)" in (out / "lying_002.yaml").read_text()
    said = capsys.readouterr().out
    assert "3 scenes that came to rest" in said
    assert "of 2 proposals 1 stayed where they were put" in said
    assert len([*out.glob("*.png")]) == 3


def test_exploring_overwrites_nothing(pool: list[Candidate], tmp_path: Path) -> None:
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "mine.yaml").write_text("mine")
    (tmp_path / "file").write_text("mine")
    for taken in ("full", "file"):
        with pytest.raises(InputError, match="it is there already"):
            explore_own("lying", tmp_path, tmp_path / taken, 3, 0)
    (tmp_path / "empty").mkdir()
    explore_own("lying", tmp_path, tmp_path / "empty", 3, 0)
    assert (tmp_path / "empty" / "lying_001.yaml").exists()
