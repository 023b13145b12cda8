"""The words of tamp-learn: what each command takes, and mistakes in one line."""

from __future__ import annotations

from pathlib import Path

import pytest

from grounding.arguments import Collect, Evaluate, Generate, Train, data_file, parsed
from tamp.errors import InputError


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_commands_with_their_words() -> None:
    made = parsed(
        [
            "generate",
            "on",
            "--split",
            "test",
            "--count",
            "50",
            "--seed",
            "3",
            "--out",
            "d.npz",
            "--workers",
            "2",
        ]
    )
    assert isinstance(made, Generate)
    assert (made.relation, made.split, made.count, made.seed) == ("on", "test", 50, 3)
    assert (made.out, made.workers, made.mesh_scale) == (Path("d.npz"), 2, 1.0)
    trained = parsed(["train", "inside", "--model", "flow", "--samples", "100", "--data", "d.npz"])
    assert isinstance(trained, Train) and (trained.model, trained.samples, trained.data) == (
        "flow",
        100,
        Path("d.npz"),
    )
    judged = parsed(["evaluate", "on=surface", "--scenes", "10"])
    assert isinstance(judged, Evaluate) and (judged.weights, judged.scenes) == ("on=surface", 10)


def test_a_relation_of_ones_own_is_collected_and_trained_on_its_data(folder: Path) -> None:
    collected = parsed(["collect", "upright", "a.yaml", "b"])
    assert isinstance(collected, Collect) and collected.files == (Path("a.yaml"), Path("b"))
    with pytest.raises(
        InputError,
        match=r"unknown relation 'upright'.*Of one's own: tamp-learn collect upright FILES",
    ):
        parsed(["train", "upright"])
    assert isinstance(parsed(["train", "upright", "--data", "u.npz"]), Train)
    (folder / "data").mkdir()
    data_file("upright", "train").touch()
    assert isinstance(parsed(["train", "upright"]), Train)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("", "no command.*Choices: "),
        ("trian on", "unknown command 'trian'.*Did you mean 'train'"),
        ("generate upright", "unknown relation 'upright'"),
        ("generate un", "unknown relation 'un'"),
        ("generate on --count 0", "--count must be positive, not 0"),
        ("generate on --workers -1", "--workers must be positive, not -1"),
        ("train on --iterations 0", "--iterations must be positive, not 0"),
        ("evaluate w.safetensors --scenes 0", "--scenes must be positive, not 0"),
        ("generate on --mesh-scale 0", "--mesh-scale must be positive, not 0"),
        ("generate on --mesh-scale nan", "--mesh-scale must be positive, not nan"),
        ("generate on --mesh-scale inf", "--mesh-scale must be positive, not inf"),
        ("generate on --seed -1", "--seed must be between 0 and 2.*63, not -1"),
        (f"train on --seed {2**63}", "--seed must be between 0 and"),
        ("generate on --out d.txt", "--out: the file must end in .npz"),
        ("train on --out w.npz", "--out: the file must end in .safetensors"),
        ("train on --data d.csv", "--data: the file must end in .npz"),
        ("evaluate w.safetensors --data d", "--data: the file must end in .npz"),
    ],
)
def test_mistakes_are_said(words: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        parsed(words.split())


def test_data_lie_by_relation_and_split() -> None:
    assert data_file("on", "train") == Path("data/on_train.npz")
    assert data_file("on", "train", "paper", True) == Path("data/on_paper_edges_train.npz")
    assert data_file("on", "test", "paper") == Path("data/on_paper_test.npz")
    assert data_file("inside", "test") == Path("data/inside_test.npz")
