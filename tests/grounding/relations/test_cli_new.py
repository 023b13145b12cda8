"""tamp-learn new: what is said of what was learned, and that a refusal or a dry run writes nothing."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from grounding.relations import cli_new as module
from grounding.relations.cli_new import new, said
from grounding.relations.options import New
from grounding.weights import Weights
from tamp.errors import InputError

SHOWN = [
    SimpleNamespace(scene=None, arguments=("cup", "plate"), holds=holds, source=f"{n}.yaml:4")
    for n, holds in enumerate((True, True, False))
]


def learned(
    wrong: tuple[int, ...] = (), held_out: bool = True, cannot_tell: str = "", steady: bool = True
) -> Any:
    shares = SimpleNamespace(positive=0.917, negative=0.5, folds=3, wrong=wrong)
    return SimpleNamespace(
        committee=None, held_out=shares if held_out else None, cannot_tell=cannot_tell,
        generator=SimpleNamespace(steady=steady, level=0), kinds=("movable", "movable"), count=(2, 1),
    )  # fmt: skip


@pytest.fixture(autouse=True)
def parts(monkeypatch: pytest.MonkeyPatch) -> None:
    """What explains, and what looks for what is missing, say the same of everything."""
    monkeypatch.setattr(module, "explanations", lambda *_: ["gap to plate", "left of plate"])
    monkeypatch.setattr(module, "situation_of", lambda *_: None)
    monkeypatch.setattr(module, "joined", lambda parts: parts)
    monkeypatch.setattr(module, "missing", lambda holds: [f"{sum(~holds)} is few"])
    monkeypatch.setattr(module, "unvaried", lambda *_: [("height", "one height")])


def test_what_it_is_how_well_and_what_is_missing() -> None:
    assert said(learned(wrong=(0, 2)), SHOWN) == [
        "what it is:", "  gap to plate", "  or: left of plate",
        "held out, scene by scene (3 parts): right about 92 % of what holds, 50 % of what does not",
        "  it would have been wrong about 0.yaml:4", "  it would have been wrong about 2.yaml:4",
        "missing: 1 is few", "missing: one height",
    ]  # fmt: skip


def test_at_most_three_wrong_ones_are_named() -> None:
    assert sum("wrong about" in line for line in said(learned(wrong=(0, 1, 2, 0)), SHOWN)) == 3


def test_without_parts_to_hold_out_nothing_is_said_of_them() -> None:
    assert not any("held out" in line for line in said(learned(held_out=False), SHOWN))


def test_what_cannot_be_told_or_planned_is_said() -> None:
    lines = said(learned(cannot_tell="too few", steady=False), SHOWN)
    assert "it only proposes, and cannot tell yet where it holds: too few" in lines
    assert any(line.startswith("cup stands on no stable face") for line in lines)
    plain = "\n".join(said(learned(), SHOWN))
    assert "only proposes" not in plain and "stable face" not in plain


@pytest.fixture
def command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Path]:
    """Runs the command on a folder of demonstrations; the folder with all that it writes."""
    (tmp_path / "demos").mkdir()
    (tmp_path / "demos" / "0.yaml").write_text("a demonstration")
    domain = (tmp_path / "mine.pddl", tmp_path / "mine.streams.pddl")
    domain[0].write_text("as it was")
    domain[1].write_text("the same")
    texts = {domain[0]: ("as it was", "with near"), domain[1]: ("the same", "the same")}
    monkeypatch.setattr(module, "demonstrations_of", lambda name, paths: SHOWN)
    monkeypatch.setattr(module, "learn", lambda *_: learned())
    monkeypatch.setattr(module, "added", lambda path, words, note: texts)
    monkeypatch.setattr(module, "examples_of", lambda shown: [])
    monkeypatch.setattr(module, "weights_of", lambda learned, card: Weights({}, dict(card)))
    monkeypatch.setattr(module, "write_weights", lambda path, weights: path.write_text("weights"))

    def run(**options: Any) -> Path:
        given = {"demos": tmp_path / "demos", "out": tmp_path / "near.safetensors", **options}
        new(New("Near", **given))
        return tmp_path

    return run


def test_weights_and_domain_are_written(
    command: Callable[..., Path], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    folder = command(add_to=tmp_path / "mine.pddl")
    assert (folder / "near.safetensors").read_text() == "weights"
    assert (folder / "mine.pddl").read_text() == "with near"
    printed = capsys.readouterr().out
    assert "3 demonstrations of near: it holds in 2, and does not in 1" in printed
    assert "-as it was" in printed and "+with near" in printed
    written = next(line for line in printed.splitlines() if line.startswith("written: "))
    assert "mine.pddl" in written and "mine.streams.pddl" not in written


def test_without_a_domain_it_is_said_how_it_gets_there(
    command: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    folder = command()
    assert (folder / "mine.pddl").read_text() == "as it was"
    assert "--add-to DOMAIN puts it into a domain" in capsys.readouterr().out


def test_a_dry_run_writes_nothing(
    command: Callable[..., Path], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    folder = command(add_to=tmp_path / "mine.pddl", dry_run=True)
    assert not (folder / "near.safetensors").exists()
    assert (folder / "mine.pddl").read_text() == "as it was"
    printed = capsys.readouterr().out
    assert "+with near" in printed and "nothing written" in printed


def test_what_is_read_is_not_written_and_nothing_is_when_one_cannot_be(
    command: Callable[..., Path], tmp_path: Path
) -> None:
    with pytest.raises(InputError, match="no demonstrations there"):
        command(demos=tmp_path / "none")
    with pytest.raises(InputError):
        command(out=tmp_path / "demos" / "0.yaml")
    with pytest.raises(InputError, match="would be written to the same file"):
        command(out=tmp_path / "mine.pddl", add_to=tmp_path / "mine.pddl")
    assert (tmp_path / "mine.pddl").read_text() == "as it was"
    assert (tmp_path / "demos" / "0.yaml").read_text() == "a demonstration"
