"""Random scenes to put a body into: what is around lies free, and what is asked of a scene is of its body."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from grounding.oracles import DROP_NEIGHBOURS_M, ItemOf
from grounding.relation_scene import Placed
from grounding.scenes import (
    GAP,
    OBJECT_SCALES,
    OTHERS,
    SUPPORT_SCALES,
    TRIES,
    SampledScene,
    SceneSampler,
    free,
    resting,
    some_hold_in_physics,
    touchable,
)
from grounding.separation import Obstacles, separations
from grounding.supports import FurnitureSupport
from tamp.geometric.scene.pose import Array, Pose
from tamp.simulation.engines import open_drops
from tests.grounding.forms import TOP, at, box, on_table

SCENES = 6


@pytest.fixture(scope="module", params=["on", "inside"])
def sampler(request: pytest.FixtureRequest) -> SceneSampler:
    return SceneSampler(request.param, "train")


def test_what_is_around_lies_apart(sampler: SceneSampler) -> None:
    rng = np.random.default_rng(0)
    for _ in range(SCENES):
        scene = sampler.draw(rng)
        for row in range(1, len(scene.placed)):
            one, before = scene.placed[row], Obstacles(scene.placed[:row])
            assert (separations(one.form, one.matrix[None], before) > 0.5 * GAP).all()
        assert len(scene.others) <= OTHERS["train"][1] + 1  # and the other support
        assert SUPPORT_SCALES["train"][0] <= scene.scales[0] <= SUPPORT_SCALES["train"][1]
        assert OBJECT_SCALES["train"][0] <= scene.scales[1] <= OBJECT_SCALES["train"][1]
        assert scene.T_world_region == pytest.approx(
            scene.stand.matrix @ scene.support.region.matrix
        )


def over(scene: SampledScene) -> int:
    """How many of the bodies around are on or in the region."""
    half, height = scene.support.region.size[:2] / 2, min(scene.support.region.size[2], 0.5)
    local = [np.linalg.inv(scene.T_world_region) @ item.matrix[:, 3] for item in scene.placed[1:]]
    return sum((np.abs(place[:2]) <= half).all() and 0.0 < place[2] < height for place in local)


def test_only_a_crowded_scene_has_bodies_put_there(sampler: SceneSampler) -> None:
    """What hangs in the air may be above the region, so a few are there by chance."""
    counts = []
    for crowded in (True, False):
        rng = np.random.default_rng(1)
        counts.append(sum(over(sampler.draw(rng, crowded=crowded)) for _ in range(2 * SCENES)))
    assert counts[0] > 2 * SCENES and counts[0] > 5 * counts[1]


def test_the_same_draws_make_the_same_scene(sampler: SceneSampler) -> None:
    first, again = (sampler.draw(np.random.default_rng(4)) for _ in range(2))
    assert (first.names, first.scales) == (again.names, again.scales)
    assert [one[:2] for one in first.others] == [one[:2] for one in again.others]
    assert all(
        (a.matrix == b.matrix).all() for a, b in zip(first.placed, again.placed, strict=True)
    )


def hand_made(*others: Placed, height: float = math.inf, hollow: bool = False) -> SampledScene:
    """A brick to put onto a table of 0.8 x 0.6 m."""
    body = box(0.1, 0.06, 0.04)
    situation = on_table(at(body, 0.0, 0.0, 1.0), height=height)
    region = replace(situation.region, hollow=hollow)
    return SampledScene(
        ("table", "brick"), (1.0, 1.5), situation.support,
        FurnitureSupport(situation.support.form.parts, region), body,
        tuple(("cube", 0.5, one) for one in others), Obstacles(others), situation.T_world_region,
    )  # fmt: skip


def placed(x: float, y: float = 0.0, z: float = TOP + 0.02) -> Array:
    return Pose((x, y, z)).matrix.copy()


def test_a_label_is_of_all_bodies_the_support_first() -> None:
    cube = at(box(0.1, 0.1, 0.1), 0.3, 0.2, TOP + 0.05)
    made = hand_made(cube).made(placed(0.1), "alone", True, False, {"draw": 3})
    assert made.names == ["table", "brick", "cube"] and made.scales == [1.0, 1.5, 0.5]
    assert (made.poses[1] == placed(0.1)).all() and (made.poses[2] == cube.matrix).all()
    assert (made.kind, made.holds, made.feasible, made.columns) == (
        "alone",
        True,
        False,
        {"draw": 3},
    )


def test_poses_are_free_where_the_gap_is_kept() -> None:
    """The brick reaches 0.05 m to each side, the cube from 0.25 to 0.35 m."""
    scene = hand_made(at(box(0.1, 0.1, 0.1), 0.3, 0.0, TOP + 0.05))
    poses = np.stack([placed(0.0), placed(0.25 - 0.05 - 0.5 * GAP), placed(0.3), placed(0.19)])
    assert free(poses, scene)[:, 0, 3] == pytest.approx([0.0, 0.19])
    assert len(free(poses, hand_made())) == 4
    assert len(free(poses[:0], scene)) == 0


def test_what_can_be_touched_is_the_support_and_what_is_near() -> None:
    """The cube reaches to 0.15 m; the brick, which reaches 0.05 m to each side, is so far from it."""
    items, scene = ItemOf(), hand_made(at(box(0.1, 0.1, 0.1), 0.1, 0.0, TOP + 0.05))
    near, far = (
        touchable(scene, placed(0.2 + DROP_NEIGHBOURS_M + off), items) for off in (-0.01, 0.01)
    )
    assert [item for item, _ in near] == [items(scene.stand.form), items(scene.placed[0].form)]
    assert (near[1][1] == scene.placed[0].matrix).all()
    assert [item for item, _ in far] == [items(scene.stand.form)]


def test_poses_at_rest_are_on_the_table_and_in_a_container_wholly() -> None:
    rng = np.random.default_rng(0)
    for hollow in (False, True):
        scene = hand_made(hollow=hollow, height=0.2)
        poses = resting(scene, rng)
        assert poses.shape == (TRIES, 4, 4)
        for pose in poses:
            low, high = Placed(scene.body, pose).box
            assert low[2] == pytest.approx(TOP, abs=0.002)
            if hollow:
                assert (np.abs([low, high])[:, :2] <= [0.4, 0.3]).all()
            else:
                assert (np.abs(pose[:2, 3]) <= [0.4, 0.3]).all()


def test_under_too_low_a_ceiling_nothing_rests() -> None:
    assert resting(hand_made(height=0.03), np.random.default_rng(0)).shape == (0, 4, 4)


def test_the_situation_of_a_pose_has_what_is_near_it() -> None:
    """The support's box ends at 0.4 m; surroundings are within a metre of it or of the body."""
    cubes = [at(box(0.1, 0.1, 0.1), x, 0.0, TOP + 0.05) for x in (0.3, 1.6)]
    scene = hand_made(*cubes)
    assert scene.placed == cubes
    assert scene.situation(placed(0.0)).others == (cubes[0],)
    assert scene.situation(placed(0.8)).others == tuple(cubes)
    assert (scene.situation(placed(0.1)).body.matrix == placed(0.1)).all()


def test_whether_something_holds_is_asked_of_physics_where_it_is_free() -> None:
    scene = hand_made(at(box(0.1, 0.1, 0.1), 0.3, 0.0, TOP + 0.05))
    rests, hangs, collides = placed(0.0), placed(0.0, z=TOP + 0.3), placed(0.3)
    rests[2, 3] += 0.001
    with open_drops() as drops:
        items = ItemOf()
        assert some_hold_in_physics(scene, np.stack([hangs, rests]), drops, items)
        assert not some_hold_in_physics(scene, np.stack([hangs, collides]), drops, items)
