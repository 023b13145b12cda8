"""What the page is told of a relation's folder, and tamp-learn's words with its arguments."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from grounding.demonstrate.folder import DemonstrationFolder
from grounding.demonstrate.records import in_arguments, records
from grounding.demonstrate.relation import KINDS, PRESETS, parse_relation
from grounding.demonstrate.scene import Stage, sample_stage
from grounding.demonstrate.use import Uses
from grounding.relations.demonstration_file import Label

STACK = parse_relation("stack(a, b)")


@pytest.fixture(scope="module")
def stage() -> Stage:
    return sample_stage(STACK, np.random.default_rng(0))


def shown(path: Path, stage: Stage, *labels: bool) -> DemonstrationFolder:
    folder = DemonstrationFolder(path, STACK)
    for holds in labels:
        folder.add(stage.file(Label("stack", stage.arguments, holds)))
    return folder


def test_counts_and_cards_are_those_of_the_folder(stage: Stage, tmp_path: Path) -> None:
    folder, uses = shown(tmp_path, stage, True, False, True), Uses("stack", tmp_path)
    (tmp_path / "broken.yaml").write_text("bodies: 3\n")
    said = records(STACK, folder, uses)
    assert (said["holding"], said["other"]) == (2, 1)
    broken, *cards = said["cards"]
    assert broken["name"] == "broken.yaml" and broken["error"] and broken["labels"] == []
    assert [(card["name"], card["labels"], card["error"]) for card in cards] == [
        ("stack_001.yaml", [True], ""),
        ("stack_002.yaml", [False], ""),
        ("stack_003.yaml", [True], ""),
    ]
    assert said["folder"] == str(tmp_path) and said["commands"] == uses.commands


def test_a_card_has_another_stamp_when_its_file_has_changed(stage: Stage, tmp_path: Path) -> None:
    folder, uses = shown(tmp_path, stage, True, True), Uses("stack", tmp_path)
    before = [card["stamp"] for card in records(STACK, folder, uses)["cards"]]
    file = tmp_path / "stack_002.yaml"
    file.write_text(file.read_text() + "# another line\n")
    after = [card["stamp"] for card in records(STACK, folder, uses)["cards"]]
    assert before[0] == after[0] and before[1] != after[1]


def test_what_contradicts_itself_is_hinted_at_with_its_files(stage: Stage, tmp_path: Path) -> None:
    said = records(STACK, shown(tmp_path, stage, True, False), Uses("stack", tmp_path))
    (hint,) = (one for one in said["hints"] if one["kind"] == "contradiction")
    assert "stack_001.yaml" in " ".join(hint["files"]) and "stack_002.yaml" in hint["files"][-1]


def test_the_relation_the_presets_and_the_kinds(tmp_path: Path) -> None:
    relation = parse_relation("stack(a: cup, b)")
    said = records(relation, DemonstrationFolder(tmp_path, relation), Uses("stack", tmp_path))
    assert said["relation"] == {
        "text": "stack(a: cup, b)", "name": "stack", "meaning": "",
        "arguments": [{"name": "a", "kind": "cup"}, {"name": "b", "kind": "object"}],
    }  # fmt: skip
    assert [one["meaning"] for one in said["presets"]] == [*PRESETS.values()]
    assert all(str(parse_relation(one["text"])) == one["text"] for one in said["presets"])
    assert said["kinds"] == [*KINDS]


def test_whether_it_was_learned_and_something_can_be_brought_back(
    stage: Stage, tmp_path: Path
) -> None:
    folder, uses = shown(tmp_path, stage, True), Uses("stack", tmp_path)
    said = records(STACK, folder, uses)
    assert not said["learned"] and not said["restorable"]
    uses.weights.write_text("weights")
    folder.remove("stack_001.yaml")
    said = records(STACK, folder, uses)
    assert said["learned"] and said["restorable"] and said["cards"] == []


def test_bodies_of_the_first_demonstration_are_called_as_the_arguments(
    stage: Stage, tmp_path: Path
) -> None:
    first, second = stage.arguments
    text = "\n".join(
        [
            f"{first} is no explanation",
            f"  the gap of {first} to {second}s {second}",
            f"  {first}_{first} x{first} {first}.",
            f"missing: {second} had one size",
        ]
    )
    assert in_arguments(text, STACK, shown(tmp_path, stage, True)).split("\n") == [
        f"{first} is no explanation",
        f"  the gap of a to {second}s b",
        f"  {first}_{first} x{first} a.",
        "missing: b had one size",
    ]


def test_both_names_are_exchanged_at_once(stage: Stage, tmp_path: Path) -> None:
    """Else a body that is called as the other argument would be renamed twice."""
    folder = shown(tmp_path, stage, True)
    first, second = stage.arguments
    relation = parse_relation(f"stack({second}, {first})")
    assert in_arguments(f"  {first} on {second}", relation, folder) == f"  {second} on {first}"


def test_words_stay_where_no_demonstration_says_what_they_are(stage: Stage, tmp_path: Path) -> None:
    text = f"  {stage.arguments[0]} is high"
    assert in_arguments(text, STACK, DemonstrationFolder(tmp_path / "none", STACK)) == text
    three = parse_relation("stack(a, b, c)")
    assert in_arguments(text, three, shown(tmp_path, stage, True)) == text
