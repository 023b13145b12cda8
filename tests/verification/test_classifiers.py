"""What the judge takes for a relation's classifier, and what it says of anything else."""

from __future__ import annotations

from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.verification.classifiers import classifiers_of

GOOD = "class C:\n    def classify(self, scene, arguments):\n        return 1.0\ngrounding = C()\n"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "upright.py"
    path.write_text(GOOD)
    return path


@pytest.mark.parametrize("mode", ["", ":mixed", ":alone"])
def test_a_python_file_with_or_without_the_planners_mode(file: Path, mode: str) -> None:
    found = classifiers_of([f"Upright={file}{mode}"])
    assert list(found) == ["upright"]  # PDDL's names are lower case
    assert found["upright"].classify(None, ()) == 1.0


def test_of_two_for_one_relation_the_last_counts(file: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.py"
    other.write_text(GOOD.replace("1.0", "0.25"))
    assert classifiers_of([f"a={file}", f"a={other}"])["a"].classify(None, ()) == 0.25
    assert classifiers_of([]) == {}


@pytest.mark.parametrize("pair", ["upright", "=x.py", "upright=", ""])
def test_what_is_no_pair_is_refused(pair: str) -> None:
    with pytest.raises(
        InputError, match=f"--sampler wants RELATION=FILE, not '{pair}'. For example"
    ):
        classifiers_of([pair])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (GOOD.replace("classify", "propose"), "'upright' has no classifier here.*classify.scene, arguments. returns"),
        (GOOD.replace("C()", "C"), "'upright' has no classifier here"),
        ("x = 1\n", "'upright' has no classifier here"),
        (GOOD.replace("def classify(self, scene, arguments):\n        return 1.0", "cannot_tell = 'too few labels'"),
         "the classifier of 'upright' cannot tell yet: too few labels"),
        ("raise ValueError('no')\n", "it cannot be run: ValueError: no"),
    ],
)  # fmt: skip
def test_a_file_without_a_classifier_is_refused(file: Path, text: str, words: str) -> None:
    file.write_text(text)
    with pytest.raises(InputError, match=words) as told:
        classifiers_of([f"upright={file}"])
    assert told.value.file == str(file)


def test_a_name_that_only_the_planner_knows_is_refused() -> None:
    with pytest.raises(
        InputError,
        match=r"the judge knows no sampler 'uniform' for 'on'. Give the classifier's file",
    ):
        classifiers_of(["on=uniform:alone"])


def test_a_relation_that_ships_is_named() -> None:
    (classifier,) = classifiers_of(["Stack=learned:alone"]).values()
    assert classifier is not None
    with pytest.raises(InputError, match=r"Choices: learned. Did you mean 'learned'\?"):
        classifiers_of(["stack=lerned"])


def test_weights_that_are_not_there_are_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"gone.safetensors"):
        classifiers_of([f"on={tmp_path / 'gone.safetensors'}"])
