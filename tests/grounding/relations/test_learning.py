"""Learning from a few demonstrations: what is learned, what is refused, what is warned of."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.relations.geometry import local, pick, situations, trouble
from benchmarks.relations.hand import put, scenes, shown
from benchmarks.relations.measure import Case, accuracy, holding, measured, steady
from benchmarks.relations.relations import RELATIONS
from grounding.relations.asking import questions
from grounding.relations.charts import MODES
from grounding.relations.committee import fit
from grounding.relations.demonstration_file import Demonstration, Label, demonstrations_of
from grounding.relations.demonstration_text import BodyEntry, DemonstrationFile, write_demonstration
from grounding.relations.evidence import gather
from grounding.relations.generator import learned
from grounding.relations.learner import learn, trained
from grounding.relations.situation import Situations, joined, situation_of
from grounding.relations.variety import missing, unvaried
from grounding.relations.words import explanations
from tamp.errors import InputError
from tamp.geometric.scene.pose import Array, Pose
from tests.grounding.relations.shown import write_demos


@pytest.fixture(scope="module")
def demos(tmp_path_factory: pytest.TempPathFactory) -> list[Demonstration]:
    return list(demonstrations_of("left_of", [write_demos(tmp_path_factory.mktemp("demos"))]))


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


def test_several_proposals_differ_and_hold() -> None:
    rng = np.random.default_rng(0)
    good, bad = shown("next_to", 10, True, rng), shown("next_to", 10, False, rng)
    _, generator = trained(joined([situations(good), situations(bad)]), np.arange(20) < 10, rng)
    s = put("next_to", scenes("next_to", 6, rng, test=True), rng)
    faces: set[int] = set()
    for row in range(6):
        one = pick(s, [row])
        R, p = generator.propose(situations(one), 16, rng, steady(one, 0))
        many = pick(s, [row] * len(R))
        many["R"][:, 0], many["p"][:, 0] = R, p
        assert (
            len(R) == 16
            and (RELATIONS["next_to"].holds(many) & (trouble(many) < 0.002)).mean() > 0.8
        )
        apart = np.abs(p[:, None] - p).max(axis=2) + 10 * np.abs(R[:, None] - R).max(axis=(2, 3))
        assert (apart + np.eye(16)).min() > 1e-3
        faces |= {*np.abs(R[:, 2]).argmax(axis=1).tolist()}
    assert len(faces) > 1  # turned as you like: on other sides, too


def test_the_same_seed_learns_the_same(demos: list[Demonstration]) -> None:
    one, other = (learn("left_of", demos, np.random.default_rng(5)) for _ in range(2))
    assert (one.committee.low == other.committee.low).all() and one.held_out == other.held_out
    assert (one.generator.shown.place == other.generator.shown.place).all()


def test_what_was_learned_is_said_in_words(demos: list[Demonstration]) -> None:
    learned = learn("left_of", demos, np.random.default_rng(0))
    said = explanations(learned.committee, ("cup", "plate"))
    assert any("gap left of plate seen from the front" in one for one in said)
    assert all(one.endswith("turned as you like") for one in said) and 1 <= len(said) <= 3
    assert learned.held_out is not None and learned.held_out.mean > 0.85 and not learned.cannot_tell


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


@pytest.mark.parametrize(
    ("fixed", "key", "words"),
    [
        ({"height": 0.7}, "height", "all surfaces were 0.7 m high"),
        ({"yaw": 0.4}, "yaw", "all furniture was turned the same way"),
        ({"cup": 0.04}, "size of 0", "cup was always 8 x 8 x 8 cm large"),
    ],
)
def test_what_is_not_varied_is_warned_of(
    fixed: dict[str, float], key: str, words: str, tmp_path: Path
) -> None:
    found = list(demonstrations_of("left_of", [write_demos(tmp_path, good=6, bad=6, **fixed)]))
    every = joined([situation_of(one.scene, one.arguments) for one in found])
    holds = np.array([one.holds for one in found])
    warned = dict(unvaried(every, holds, ("cup", "plate")))
    assert words in warned[key] and "size of 1" not in warned
    assert not missing(holds)


def test_varied_demonstrations_are_not_warned_of(demos: list[Demonstration]) -> None:
    every = joined([situation_of(one.scene, one.arguments) for one in demos])
    assert unvaried(every, np.array([one.holds for one in demos]), ("cup", "plate")) == []


def test_lazy_heights_cost_nothing_and_one_yaw_is_warned_of() -> None:
    found = measured(Case("left_of_other", 10, 10, 0, "height"))
    assert float(found["classifier"]) > 0.85 and "height" in str(found["warned"])
    found = measured(Case("left_of_front", 10, 10, 0, "yaw"))
    assert "yaw" in str(found["warned"]).split()


def test_questions_are_about_what_is_disputed() -> None:
    rng = np.random.default_rng(0)
    good, bad = (
        situations(shown("left_of_front", count, holds, rng))
        for count, holds in ((4, True), (3, False))
    )
    evidence = gather(good, bad, rng)
    committee = fit(evidence)
    sure = situations(shown("left_of_front", 30, False, rng, test=True))
    pool = joined([sure, situations(shown("left_of_front", 30, True, rng, test=True))])
    rows = questions(evidence, committee, pool, 5)
    assert len({*rows.tolist()}) == 5
    doubt = 1 - np.abs(2 * committee.predict(pool) - 1)
    assert doubt[rows].mean() > doubt.mean()


def test_a_relation_of_distances_among_three_is_told_as_one() -> None:
    """Farther from one than another is: no distance by itself says so."""
    rng = np.random.default_rng(2)
    every = joined([situations(scenes("between", 200, rng)) for _ in range(2)])
    apart = np.linalg.norm(np.diff(every.p[:, [0, 1, 2], :2], axis=1), axis=2)
    holds = apart[:, 0] > apart[:, 1]
    rows = np.concatenate([np.flatnonzero(holds)[:15], np.flatnonzero(~holds)[:15]])
    committee, _ = trained(every.rows(rows), holds[rows], rng)
    rest = np.setdiff1d(np.arange(len(every)), rows)
    said = committee.predict(every.rows(rest)) >= 0.5
    assert len(rest) > 100 and (said == holds[rest]).mean() > 0.9
    assert any("farther from" in text for text in explanations(committee, ("a", "b", "c")))


class Pleased:
    """A committee to which everything holds."""

    def predict(self, situations: Situations) -> Array:
        return np.ones(len(situations))


def test_a_chart_that_carries_bodies_into_each_other_is_not_chosen() -> None:
    """Beside another one there is no room in it: shares of that agree, and are of no use."""
    s = situations(shown("next_to", 12, True, np.random.default_rng(0)))
    s.p[:, 0, :2] = s.p[:, 1, :2] + [0.3, 0.0]
    chosen = learned(Pleased(), s, np.random.default_rng(0))  # type: ignore[arg-type]
    modes = [MODES[code] for code in chosen.shown.codes[:, 2]]
    assert len(modes) == 5 and "room" not in modes


def test_what_was_always_in_one_place_of_the_furniture_is_warned_of() -> None:
    rng = np.random.default_rng(1)
    s = situations(shown("next_to", 10, True, rng))
    keys = [key for key, _ in unvaried(s, np.ones(10, dtype=bool), ("a", "b"))]
    assert "place of 1" not in keys
    s.p[:, 1, :2] = s.support[:, 2:4]
    found = dict(unvaried(s, np.ones(10, dtype=bool), ("a", "b")))
    assert found["place of 1"].startswith("b was always in the same place of the furniture")


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


@pytest.mark.parametrize(
    ("what", "said"),
    [("middle", "distance from the furniture's middle"), ("corner", "corner of the furniture")],
)
def test_a_place_on_the_furniture_is_told_by_its_middle_and_its_corners(
    what: str, said: str
) -> None:
    """In the middle of a table, or at any corner of it: neither side's edge by itself says so."""
    rng = np.random.default_rng(4)
    batch = scenes("upright", 3000, rng)
    at, half = np.abs(local(batch, 0)), batch["half"]
    holds = np.hypot(*at.T) < 0.2 if what == "middle" else (half - at).max(axis=1) < 0.2
    every = situations(batch)
    rows = np.concatenate([np.flatnonzero(holds)[:12], np.flatnonzero(~holds)[:12]])
    committee, _ = trained(every.rows(rows), holds[rows], rng)

    rest = np.setdiff1d(np.arange(len(every)), rows)
    yes, truth = committee.predict(every.rows(rest)) >= 0.5, holds[rest]
    assert truth.sum() > 20
    assert (yes[truth].mean() + 1 - yes[~truth].mean()) / 2 > 0.85
    assert any(said in text for text in explanations(committee, ("a",)))
