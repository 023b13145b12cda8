"""The files of tamp-learn: data about the relation, and outputs that take nothing else's place."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace

import pytest

from grounding import cli_files as module
from grounding.cli_files import check_out, commit, encoder_file, mesh_files, read_data, with_card
from tamp.errors import InputError

FORM = "tamp grounding 1"


def test_data_about_another_relation_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[Path] = []

    def read_dataset(path: Path) -> SimpleNamespace:
        read.append(path)
        return SimpleNamespace(relation="on")

    monkeypatch.setattr(module, "read_dataset", read_dataset)
    monkeypatch.setattr(
        module, "data_file", lambda relation, split: Path(f"{relation}_{split}.npz")
    )
    assert read_data(Path("d.npz"), "on", "train").relation == "on"
    assert read_data(None, "on", "test").relation == "on"
    assert read == [Path("d.npz"), Path("on_test.npz")]
    with pytest.raises(InputError, match="about 'on', not 'inside'") as caught:
        read_data(Path("d.npz"), "inside", "train")
    assert caught.value.file == "d.npz"


def test_a_file_is_read_with_its_card() -> None:
    assert with_card(Path("a/d.npz")) == [Path("a/d.npz"), Path("a/d.json")]
    assert with_card(None) == []
    assert encoder_file("on") == Path("weights/on_encoder.safetensors")


def test_own_meshes_are_all_files_of_their_folder(tmp_path: Path) -> None:
    (tmp_path / "cups").mkdir()
    for name in ("box.obj", "cups/mug.stl"):
        (tmp_path / name).write_text("mesh")
    found = mesh_files(SimpleNamespace(meshes=tmp_path))
    assert {file.relative_to(tmp_path) for file in found} >= {Path("box.obj"), Path("cups/mug.stl")}
    assert mesh_files(SimpleNamespace(meshes=None)) == []


@pytest.mark.parametrize("card", [None, {"format": FORM}])
def test_a_new_file_or_one_of_the_same_kind_may_be_written(
    card: dict[str, str] | None, tmp_path: Path
) -> None:
    out = tmp_path / "w.safetensors"
    if card is not None:
        out.with_suffix(".json").write_text(json.dumps(card))
    check_out(out, FORM, [tmp_path / "d.npz"])


@pytest.mark.parametrize(
    "content", ['{"format": "tamp demonstrations 1"}', "{}", "[1]", "", "{", "[" * 100_000]
)
def test_a_card_that_is_another_file_is_not_overwritten(content: str, tmp_path: Path) -> None:
    card = tmp_path / "w.json"
    card.write_text(content)
    with pytest.raises(
        InputError, match=r"the card of w\.safetensors would overwrite it"
    ) as caught:
        check_out(tmp_path / "w.safetensors", FORM, [])
    assert caught.value.file == str(card) and card.read_text() == content


def test_what_is_read_is_not_written(tmp_path: Path) -> None:
    out, card, state = (tmp_path / name for name in ("w.npz", "w.json", "s"))
    for read in (out, card, state):
        with pytest.raises(InputError):
            check_out(out, FORM, [read], state)
    with pytest.raises(InputError):
        check_out(out, FORM, [], out)
    check_out(out, FORM, [tmp_path / "d.npz"], state)


def test_an_output_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    with pytest.raises(InputError):
        check_out(tmp_path / "file" / "w.safetensors", FORM, [])
    (tmp_path / "w.json").mkdir()
    with pytest.raises(InputError):
        check_out(tmp_path / "w.safetensors", FORM, [])


def test_the_commit_is_gits_and_nothing_where_there_is_no_git(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    said = commit()
    assert said == "" or (len(said) >= 7 and int(said, 16) >= 0)
    monkeypatch.setenv("PATH", "/nowhere")
    assert commit() == ""
