"""A learned relation as the planner calls it: on which place it proposes, and clear of what else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from grounding.relations.files import weights_of
from grounding.relations.grounding import CLEAR, NEAR, LearnedRelation, _any_place, _blocked
from grounding.relations.learner import Learned
from grounding.relations.situation import situation_of
from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Scene
from tests.geometric.making import body, scene, table

CUP = body("cup", Cylinder(0.04, 0.1), (2.0, 2.0, 0.05))
PLATE = body("plate", Cylinder(0.08, 0.02), (0.1, 0.0, 0.511))
BLOCK = body("block", Box((0.1, 0.1, 0.1)), (0.3, 0.0, 0.55))


@pytest.fixture(scope="module")
def relation(learned: Learned) -> LearnedRelation:
    return LearnedRelation(weights_of(learned, {}))


def proposed(relation: LearnedRelation, there: Scene, *names: str) -> list[Pose]:
    return relation.propose(there, names, 8, np.random.default_rng(0))


def test_it_is_put_left_of_the_plate_on_what_that_one_stands_on(relation: LearnedRelation) -> None:
    poses = proposed(relation, scene(table(), CUP, PLATE), "cup", "plate")
    assert 1 <= len(poses) <= 8
    for pose in poses:
        x, _, z = pose.position
        assert x < 0.1 - 0.08 and z == pytest.approx(0.551, abs=2e-3)


def test_a_place_behind_the_arguments_says_how_high(relation: LearnedRelation) -> None:
    high = table("high", height=0.7)
    poses = proposed(relation, scene(table(), high, CUP, PLATE), "cup", "plate", "high")
    assert poses and all(pose.position[2] == pytest.approx(0.751, abs=2e-3) for pose in poses)


def test_a_wrong_number_of_arguments_is_refused(relation: LearnedRelation) -> None:
    there = scene(table(), CUP, PLATE)
    for ask in (
        lambda: relation.classify(there, ("cup",)),
        lambda: proposed(relation, there, "cup"),
    ):
        with pytest.raises(InputError, match="has 2 arguments, not 1"):
            ask()


def test_the_best_place_is_clear_of_what_is_not_named(relation: LearnedRelation) -> None:
    """Where the cup would go stands a post of 2 cm."""
    free, *_ = proposed(relation, scene(table(), CUP, PLATE), "cup", "plate")
    post = body("post", Box((0.02, 0.02, 0.2)), (-0.11, 0.0, 0.6))
    best, *_ = proposed(relation, scene(table(), CUP, PLATE, post), "cup", "plate")
    near, away = (np.hypot(pose.position[0] + 0.11, pose.position[1]) for pose in (free, best))
    assert near < 0.05 < away


def test_of_fixed_surfaces_the_larger_ones_are_taken_more_often() -> None:
    small = table("small", at=(2.0, 0.0), height=0.3)
    small = replace(small, surfaces=(replace(small.surfaces[0], size=(0.3, 0.2)),))
    loose = replace(table("loose", height=0.9), movable=True)
    rng, there = np.random.default_rng(0), scene(table(), small, loose)
    heights = [_any_place(there, rng)[0] for _ in range(400)]
    assert {*heights} == {0.5, 0.3}
    assert heights.count(0.3) == pytest.approx(400 / 11, abs=15)  # one to ten
    assert _any_place(scene(loose), rng) == (0.0, 0.0, 0.0, 0.0, 2.0, 2.0)


def blocked(there: Scene, *at: tuple[float, float]) -> list[float] | None:
    names = ("cup", "plate")
    found = _blocked(there, names, situation_of(there, names))
    if found is None:
        return None
    p = np.array([[x, y, 0.551] for x, y in at])
    return found(np.tile(np.eye(3), (len(at), 1, 1)), p).tolist()


def test_it_is_said_by_how_far_a_place_is_in_something_else() -> None:
    """The cup's wall is 4 cm from its axis, the block's 5 cm from its middle."""
    there = scene(table(), CUP, PLATE, BLOCK)
    found = blocked(there, (0.3 - 0.08, 0.0), (0.3 - 0.092, 0.0), (0.3 - 0.1, 0.0))
    assert found == pytest.approx([0.01 + CLEAR, CLEAR - 0.002, 0.0], abs=5e-4)


def test_the_table_below_and_what_is_far_away_are_in_nobodys_way() -> None:
    assert blocked(scene(table(), CUP, PLATE)) is None
    reach = NEAR + float(np.hypot(0.5, 0.3))
    for x, there in ((reach - 0.01, True), (reach + 0.01, False)):
        far = replace(BLOCK, pose=Pose((x, 0.0, 0.55)))
        assert (blocked(scene(table(), CUP, PLATE, far), (0.0, 0.0)) is not None) is there


def test_fixed_furniture_that_rises_above_the_surface_is_in_the_way() -> None:
    wall = body("wall", Box((0.1, 0.6, 0.6)), (-0.4, 0.0, 0.8), movable=False)
    found = blocked(scene(table(), CUP, PLATE, wall), (-0.4, 0.0), (0.0, 0.0))
    assert found is not None and found[0] > 0.05 and found[1] == 0.0
