"""Learning from a few demonstrations: what is learned, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.relations.geometry import situations
from benchmarks.relations.hand import shown
from benchmarks.relations.measure import Case, accuracy, holding, measured
from grounding.relations.demonstration_file import Demonstration, Label, demonstrations_of
from grounding.relations.demonstration_text import BodyEntry, DemonstrationFile, write_demonstration
from grounding.relations.learner import learn, trained
from grounding.relations.situation import joined
from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose
from tests.grounding.relations.shown import write_demos


@pytest.mark.parametrize("name", ["upright", "stack", "left_of_other", "between"])
def test_twenty_labels_are_enough_on_unseen_bodies(name: str) -> None:
    found = measured(Case(name, 10, 10, seed=1))
    assert float(found["classifier"]) > 0.85 and float(found["proposals"]) > 0.85


def test_more_labels_are_no_worse() -> None:
    rng = np.random.default_rng(3)
    good, bad = shown("set_cup", 80, True, rng), shown("set_cup", 80, False, rng)
    every = joined([situations(good), situations(bad)])
    committee, generator = trained(every, np.arange(160) < 80, rng)
    assert accuracy(committee, "set_cup", rng) > 0.93
    assert holding(generator, "set_cup", rng)[0] > 0.9


def test_the_same_seed_learns_the_same(demos: list[Demonstration]) -> None:
    one, other = (learn("left_of", demos, np.random.default_rng(5)) for _ in range(2))
    assert (one.committee.low == other.committee.low).all() and one.held_out == other.held_out
    assert (one.generator.shown.place == other.generator.shown.place).all()


def test_a_situation_with_both_labels_is_refused_with_both_places(tmp_path: Path) -> None:
    folder = write_demos(tmp_path, good=4, bad=4)
    text = (
        (folder / "left_of_000.yaml")
        .read_text()
        .replace("goal: (left_of cup plate)", "goal: (not (left_of cup plate))")
    )
    (folder / "left_of_900.yaml").write_text(text)
    with pytest.raises(
        InputError, match=r"same situation: .*left_of_000.yaml.* and .*left_of_900.yaml"
    ):
        learn("left_of", list(demonstrations_of("left_of", [folder])), np.random.default_rng(0))


def test_labels_at_random_are_refused(demos: list[Demonstration]) -> None:
    refused, told = 0, ""
    for seed in range(4):
        labels = np.random.default_rng(seed).permutation([one.holds for one in demos])
        mixed = [
            Demonstration(one.scene, one.arguments, bool(label), one.source)
            for one, label in zip(demos, labels, strict=True)
        ]
        try:
            assert learn("left_of", mixed, np.random.default_rng(0)).cannot_tell
        except InputError as error:
            refused, told = refused + 1, error.message
    assert refused >= 3
    assert "cannot be learned from these labels" in told


def test_one_label_alone_only_proposes(demos: list[Demonstration]) -> None:
    positive = [one for one in demos if one.holds][:5]
    learned = learn("left_of", positive, np.random.default_rng(0))
    assert "shown only where it holds" in learned.cannot_tell and learned.held_out is None
    with pytest.raises(InputError, match="holds in none of 10 demonstrations"):
        learn("left_of", [one for one in demos if not one.holds], np.random.default_rng(0))


def test_lazy_heights_cost_nothing_and_one_yaw_is_warned_of() -> None:
    found = measured(Case("left_of_other", 10, 10, 0, "height"))
    assert float(found["classifier"]) > 0.85 and "height" in str(found["warned"])
    found = measured(Case("left_of_front", 10, 10, 0, "yaw"))
    assert "yaw" in str(found["warned"]).split()


def test_a_capsule_that_stands_is_no_body_that_leans(tmp_path: Path) -> None:
    """It has no face on which it stands, and a box in its place is put down on one of its own."""
    for number in range(6):
        capsule = {"capsule": {"radius": 0.03, "height": 0.1 + 0.01 * number}}
        bodies = {
            "table": BodyEntry(
                {"furniture": "table", "size": [1.2, 0.8, 0.5]},
                Pose.from_xyz_yaw(0.0, 0.0, 0.0, 0.0),
            ),
            "post": BodyEntry(capsule, Pose.from_xyz_yaw(0.1 * number, 0.0, 0.6, number)),
        }
        label = Label("standing", ("post",), True)
        write_demonstration(tmp_path / f"{number}.yaml", DemonstrationFile(bodies, [label]))
    demos = list(demonstrations_of("standing", [tmp_path]))
    assert learn("standing", demos, np.random.default_rng(0)).generator.steady
