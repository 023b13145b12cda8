"""Bodies that touch at the start may part, and not meet again; those deep in each other may not be."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box
from tamp.simulation.engines import open_world
from tamp.simulation.world import World
from tamp.verification.collision_sweep import Sweeper
from tamp.verification.touching_pairs import forget_parted, note_touching
from tamp.verification.violation_log import ViolationLog
from tests.geometric.making import body, scene

ROBOT = ROBOTS["panda_mobile"]()
CUBE = Box((0.1, 0.1, 0.1))


@pytest.fixture(scope="module")
def world() -> Iterator[World]:
    """A fixed block and three cubes, whose places each test says."""
    far = (body(name, CUBE, (x, 2.0, 0.5)) for name, x in (("a", 0.0), ("b", 1.0), ("z", 2.0)))
    fixed = (
        body(name, CUBE, (x, -2.5, 0.05), movable=False) for name, x in (("p", 2), ("q", 2.05))
    )
    with open_world(scene(*far, *fixed), ROBOT) as made:
        yield made


@pytest.fixture
def sweeper(world: World) -> Sweeper:
    for name, x in (("a", 0.0), ("b", 1.0), ("z", 2.0)):
        world.place(name, Pose((x, 2.0, 0.5)).matrix)
    return Sweeper(world, ROBOT)


def noted(world: World, sweeper: Sweeper, gap: float, body: str = "b") -> ViolationLog:
    """Note what touches when a body is so far from the side of cube a, metres."""
    world.place(body, Pose((0.1 + gap, 2.0, 0.5)).matrix)
    log = ViolationLog()
    note_touching(world, sweeper, log)
    return log


@pytest.mark.parametrize(
    ("gap", "deep"), [(3e-4, 0.0), (7e-4, None), (-8e-4, 8e-4), (-1.2e-3, None)]
)
def test_what_touches_is_noted_with_its_depth(
    world: World, sweeper: Sweeper, gap: float, deep: float | None
) -> None:
    log = noted(world, sweeper, gap)
    if deep is None:
        assert sweeper.together == {}
    else:
        assert sweeper.together == {("a", "b"): pytest.approx(deep, abs=2e-5)}
    assert bool(log.violations) is (gap < -1e-3)


def test_what_penetrates_is_a_collision_at_the_start(world: World, sweeper: Sweeper) -> None:
    (one,) = noted(world, sweeper, -0.003).violations
    assert one.kind == "collision" and set(one.bodies) == {"a", "b"} and one.time == 0.0
    assert one.depth == pytest.approx(0.003, abs=5e-5) and "3.0 mm" in one.message


def test_fixed_bodies_may_be_in_each_other(world: World, sweeper: Sweeper) -> None:
    assert world.body_distance("p", "q") < -0.04
    assert noted(world, sweeper, 0.5).violations == []


def test_only_pairs_that_were_parted_are_forgotten(world: World, sweeper: Sweeper) -> None:
    noted(world, sweeper, 1e-4)
    world.place("z", Pose((-0.1001, 2.0, 0.5)).matrix)
    note_touching(world, sweeper, ViolationLog())
    assert {*sweeper.together} == {("a", "b"), ("a", "z")}

    world.place("b", Pose((0.1 + 7e-4, 2.0, 0.5)).matrix)
    forget_parted(world, sweeper)
    assert {*sweeper.together} == {("a", "z")}

    world.place("b", Pose((0.1001, 2.0, 0.5)).matrix)
    forget_parted(world, sweeper)
    assert {*sweeper.together} == {("a", "z")}  # it met it again, and is not let off again
