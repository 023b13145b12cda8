"""The folder of demonstrations: written at once, continued, shared with other tools."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from grounding.demonstrate.folder import DemonstrationFolder, check_folder, relation_of_folder
from grounding.demonstrate.relation import parse_relation
from grounding.demonstrate.scene import Stage, sample_stage
from grounding.relations.demonstration_file import Label, demonstrations_of
from tamp.errors import InputError

STACK = parse_relation("stack(a, b)")


@pytest.fixture(scope="module")
def stage() -> Stage:
    return sample_stage(STACK, np.random.default_rng(0))


def add(folder: DemonstrationFolder, stage: Stage, holds: bool) -> str:
    return folder.add(stage.file(Label("stack", stage.arguments, holds)))


def test_each_label_is_a_file_that_others_read(stage: Stage, tmp_path: Path) -> None:
    folder = DemonstrationFolder(tmp_path / "new" / "stack", STACK)
    names = [add(folder, stage, holds) for holds in (True, False, True)]
    assert names == ["stack_001.yaml", "stack_002.yaml", "stack_003.yaml"]
    assert [one.holds for one in demonstrations_of("stack", [folder.path])] == [True, False, True]
    assert sorted(file.name for file in folder.path.iterdir()) == names  # nothing half


def test_an_existing_folder_is_continued(stage: Stage, tmp_path: Path) -> None:
    add(DemonstrationFolder(tmp_path, STACK), stage, True)
    folder = DemonstrationFolder(tmp_path, STACK)
    assert [one.holds for one in folder.demonstrations()] == [True]
    assert add(folder, stage, False) == "stack_002.yaml"
    assert relation_of_folder(tmp_path) == STACK


def test_deleted_and_brought_back(stage: Stage, tmp_path: Path) -> None:
    folder = DemonstrationFolder(tmp_path, STACK)
    first, second = add(folder, stage, True), add(folder, stage, False)
    content = (tmp_path / second).read_bytes()
    folder.cards()
    folder.remove(second)
    assert not (tmp_path / second).exists() and folder.restorable
    folder.cards()
    assert add(folder, stage, True) == "stack_003.yaml"  # not the number of what may come back
    assert folder.restore() == second and (tmp_path / second).read_bytes() == content
    assert folder.restore() is None and not folder.restorable
    assert first in {card.name for card in folder.cards()}


def test_a_label_is_turned(stage: Stage, tmp_path: Path) -> None:
    folder = DemonstrationFolder(tmp_path, STACK)
    name = add(folder, stage, True)
    before = folder.demonstrations()[0]
    folder.flip(name)
    after = folder.demonstrations()[0]
    assert before.holds and not after.holds and after.arguments == before.arguments
    folder.flip(name)
    assert folder.demonstrations()[0].holds


OTHERS = """
bodies:
  board: {furniture: table, size: [1.2, 0.7, 0.7], at: [1.6, 0.0, 0.0]}
  milk:  {box: [0.06, 0.07, 0.19], on: board, at: [-0.4, 0.1]}
  juice: {box: [0.06, 0.06, 0.17], on: milk}
goal: (and (stack juice milk) (not (stack milk juice)))
"""


def test_files_of_others_count(stage: Stage, tmp_path: Path) -> None:
    (tmp_path / "by_hand.yaml").write_text(OTHERS)
    (tmp_path / "broken.yaml").write_text("bodies: [")
    (tmp_path / "of_something_else.yaml").write_text(OTHERS.replace("stack", "near"))
    folder = DemonstrationFolder(tmp_path, STACK)
    cards = {card.name: card for card in folder.cards()}
    assert [label.holds for label in cards["by_hand.yaml"].labels] == [True, False]
    assert "not valid YAML" in cards["broken.yaml"].error
    assert "says nothing of 'stack'" in cards["of_something_else.yaml"].error
    assert len(folder.demonstrations()) == 2
    with pytest.raises(InputError, match="only a file with one label"):
        folder.flip("by_hand.yaml")
    (tmp_path / "by_hand.yaml").write_text(OTHERS.replace("(not (stack milk juice))", ""))
    assert len(folder.demonstrations()) == 1  # read again when it has changed
    with pytest.raises(InputError, match="another hand wrote this file"):
        folder.flip("by_hand.yaml")


@pytest.mark.parametrize(
    "name", ["../other.yaml", "/etc/passwd", "", "stack_009.yaml", "stack_001.yaml/../../x"]
)
def test_only_files_of_the_folder_are_touched(name: str, stage: Stage, tmp_path: Path) -> None:
    outside = tmp_path / "other.yaml"
    outside.write_text(OTHERS)
    folder = DemonstrationFolder(tmp_path / "in", STACK)
    add(folder, stage, True)
    folder.cards()
    for action in (folder.remove, folder.flip):
        with pytest.raises(InputError, match="there is no demonstration"):
            action(name)
    assert outside.read_text() == OTHERS and len(folder.cards()) == 1


def test_another_number_of_arguments_is_refused(stage: Stage, tmp_path: Path) -> None:
    add(DemonstrationFolder(tmp_path, STACK), stage, True)
    with pytest.raises(InputError, match=r"stack_001.yaml:\d+: stack has 2 arguments here.*has 3"):
        DemonstrationFolder(tmp_path, parse_relation("stack(a, b, c)"))


def test_a_file_is_no_folder(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("")
    with pytest.raises(InputError, match="this is none"):
        check_folder(file)
    with pytest.raises(InputError, match="this is none"):
        DemonstrationFolder(file, STACK)


@pytest.mark.parametrize(
    ("goal", "shown"),
    [
        ("(stack juice milk)", "stack(a, b)"),
        ("(and (not (near juice milk)))", "near(a, b)"),
        ("(lying milk board)", "lying(a, b: surface)"),
        ("(not (Upright milk))", "upright(a)"),
    ],
)
def test_the_relation_of_a_folder_is_found(goal: str, shown: str, tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_text("nonsense")
    (tmp_path / "b.yaml").write_text(OTHERS.partition("goal:")[0] + f"goal: {goal}\n")
    assert str(relation_of_folder(tmp_path)) == shown
    assert relation_of_folder(tmp_path / "none") is None
