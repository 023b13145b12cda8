"""Evaluations of models that are known to be right, half right, or to propose nothing."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from grounding.dataset import Dataset
from grounding.evaluate import NOTHING_PROPOSED, accuracy, evaluate, wilson
from grounding.oracles import Verdict
from grounding.relation_scene import RelationScene
from tamp.geometric.scene.pose import Array
from tests.grounding.paper.conftest import boxes_on_a_table

HIGH, LOW = 0.1, -0.1
"""Metres by which half of the bodies float, or are sunken."""


def scenes(count: int = 4, off: float = HIGH, feasible: bool | None = None) -> Dataset:
    """Boxes alone on a table; every other one hangs above its place."""
    made = boxes_on_a_table(count)
    arrays = {name: array.copy() for name, array in made.arrays.items()}
    arrays["body"][:, 2:] = -1
    heights = np.array([0.0, 0.04, 0.06])[arrays["body"][:, 1]] * arrays["scale"][:, 1] / 2
    arrays["pose"][:, 1, 2, 3] = arrays["pose"][:, 0, 2, 3] + 0.2005 + heights
    arrays["pose"][1::2, 1, 2, 3] += off
    if feasible is not None:
        arrays["feasible"] = np.full(count, feasible)
    return Dataset(arrays, made.templates, made.kinds, {"relation": "on"})


class Model:
    """Proposes the pose that the body has, moved by z, and judges by a function of that pose."""

    def __init__(
        self, says: Callable[[RelationScene], float] = lambda situation: 1.0, *, none: bool = False
    ) -> None:
        self.says, self.none, self.asked = says, none, 0

    def propose(self, situation: RelationScene, count: int, rng: np.random.Generator) -> Array:
        self.asked += 1
        return np.zeros((0, 4, 4)) if self.none else situation.body.matrix[None]

    def classify(self, situation: RelationScene, poses: Array) -> Array:
        return np.full(len(poses), self.says(situation))


def standing(situation: RelationScene) -> float:
    """Whether the body's lowest point is at the table's top."""
    low = situation.body.form.corners[0][2] + situation.body.matrix[2, 3]
    return float(abs(low - situation.support.matrix[2, 3] - 0.2) < 0.01)


@pytest.mark.parametrize(("off", "verdict"), [(HIGH, Verdict.TOO_HIGH), (LOW, Verdict.TOO_LOW)])
def test_a_model_that_is_right_every_other_time(off: float, verdict: Verdict) -> None:
    found = evaluate(Model(standing), scenes(off=off))
    assert found.scenes == 4 and found.draws == 1
    assert found.mca == found.settled == found.published == found.published_scaled == 0.5
    assert found.mca_failures == {str(verdict): 0.5} and sum(found.failures.values()) == 0.5
    assert found.accuracy == 1.0
    assert found.feasible == 1.0
    assert found.milliseconds > 0.0


def test_a_model_that_knows_of_no_pose() -> None:
    found = evaluate(Model(none=True), scenes())
    assert found.mca == found.settled == found.published == 0.0
    assert found.failures == found.mca_failures == {NOTHING_PROPOSED: 1.0}


def test_where_nobody_found_a_pose_only_what_the_model_finds_is_feasible() -> None:
    assert evaluate(Model(), scenes(feasible=False)).feasible == 0.5
    assert evaluate(Model(none=True), scenes(feasible=False)).feasible == 0.0
    assert evaluate(Model(none=True), scenes(feasible=True)).feasible == 1.0


def test_the_tolerance_of_clouds_is_wider() -> None:
    found = evaluate(Model(), scenes(off=0.05))
    assert (found.published, found.published_scaled) == (0.5, 1.0)


def test_each_draw_counts_by_the_boxes_and_the_first_one_in_physics() -> None:
    model = Model()
    found = evaluate(model, scenes(), draws=3)
    assert model.asked == 12 and found.draws == 3
    assert found.mca == found.settled == found.published == 0.5


def test_so_many_scenes_as_are_wanted_the_same_for_one_seed() -> None:
    told: list[tuple[int, int]] = []
    model = Model(standing, none=True)
    found = evaluate(model, scenes(6), 2, seed=1, progress=lambda *done: told.append(done))
    assert found.scenes == model.asked == 2 and told == []
    assert evaluate(model, scenes(6), 2, seed=1).accuracy == found.accuracy == 1.0
    evaluate(Model(none=True), scenes(52), progress=lambda *done: told.append(done))
    assert told == [(50, 52)]


@pytest.mark.parametrize(
    ("says", "share"),
    [
        (standing, 1.0),
        (lambda situation: 1.0 - standing(situation), 0.0),
        (lambda situation: 0.51, 0.5),
        (lambda situation: 0.5, 0.5),
        (lambda situation: float("nan"), None),
    ],
)
def test_accuracy_is_the_share_of_right_answers(
    says: Callable[[RelationScene], float], share: float | None
) -> None:
    assert accuracy(Model(says), scenes(8)) == share


def test_a_probability_of_a_half_does_not_hold() -> None:
    nothing_holds = scenes(2)
    nothing_holds.arrays["holds"][:] = False
    again = Dataset(
        nothing_holds.arrays, nothing_holds.templates, nothing_holds.kinds, {"relation": "on"}
    )
    assert accuracy(Model(lambda situation: 0.5), again) == 1.0
    assert accuracy(Model(lambda situation: 0.5001), again) == 0.0


@pytest.mark.parametrize(("right", "count"), [(8, 10), (1, 30), (120, 240)])
def test_a_confidence_interval_ends_where_the_share_is_as_far_off_as_is_likely(
    right: int, count: int
) -> None:
    """Wilson's bounds are the p with |share - p| = 1.96 sqrt(p (1 - p) / n)."""
    share = right / count
    low, high = wilson(share, count)
    assert 0.0 < low < share < high < 1.0
    for p in (low, high):
        assert abs(share - p) == pytest.approx(1.96 * np.sqrt(p * (1 - p) / count))


def test_a_confidence_interval_stays_within_all_and_none() -> None:
    assert wilson(0.0, 10)[0] == pytest.approx(0.0, abs=1e-12) and wilson(0.0, 10)[0] >= 0.0
    assert wilson(1.0, 10)[1] <= 1.0 and wilson(1.0, 10)[0] == pytest.approx(10 / (10 + 1.96**2))
