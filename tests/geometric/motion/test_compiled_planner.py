"""RRT-Connect over the compiled kernel: what it finds is free by the exact check, and beside OMPL's."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.collision.arrangement import Arrangement
from tamp.geometric.collision.collisions import Collisions
from tamp.geometric.loading.load import load_scene
from tamp.geometric.loading.robots import ROBOTS, SHIPPED
from tamp.geometric.motion.arm import plan_arm
from tamp.geometric.motion.base import plan_base
from tamp.geometric.motion.compiled_planner import Moving, Shortening, connect_compiled
from tamp.geometric.motion.path import length
from tamp.geometric.motion.planners import COMPILED, OMPL
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array
from tamp.system.deadline import Deadline

SCENE = """
name: posts
robot: {{model: {robot}, base: [0.0, 0.0, 0.0]}}
room: {{x: [-3.0, 3.0], y: [-3.0, 3.0]}}
bodies:
  post:  {{box: [0.08, 0.08, 1.2], at: [0.5, 0.15, 0.6], fixed: true}}
  wall:  {{box: [0.1, 2.4, 1.0], at: [1.2, 0.8, 0.5], fixed: true}}
  can:   {{cylinder: {{radius: 0.03, height: 0.1}}, at: [-1.5, -1.5, 0.052]}}
goal: (and)
"""


@pytest.fixture(scope="module", params=SHIPPED)
def world(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Arrangement, Robot]:
    file = tmp_path_factory.mktemp("posts") / "posts.yaml"
    file.write_text(SCENE.format(robot=request.param), encoding="utf-8")
    robot = ROBOTS[request.param]()
    return Collisions(load_scene(file).scene, robot, Kinematics(robot)).arrangement({}), robot


def _free_arms(arrangement: Arrangement, robot: Robot, rng: np.random.Generator) -> list[Array]:
    lower, upper = np.array(robot.lower), np.array(robot.upper)
    arms: list[Array] = []
    while len(arms) < 2:
        arm = np.array(robot.home) + rng.normal(0.0, 0.9, len(lower))
        if np.all((lower <= arm) & (arm <= upper)) and arrangement.free(
            np.append(np.zeros(3), arm)
        ):
            arms.append(arm)
    return arms


def _moving(robot: Robot) -> Moving:
    return Moving(3, np.array(robot.lower), np.array(robot.upper), np.ones(len(robot.lower)))


def test_any_robot_s_path_is_free_joins_the_ends_and_is_the_same_again(
    world: tuple[Arrangement, Robot], rng: np.random.Generator
) -> None:
    arrangement, robot = world
    found = 0
    for seed in range(6):
        start, goal = (np.append(np.zeros(3), arm) for arm in _free_arms(arrangement, robot, rng))
        paths = [
            connect_compiled(
                arrangement, _moving(robot), start, goal[None], seed=seed, checks=4000,
                deadline=Deadline(60), reach=0.6, domain=4.0, shortening=Shortening(30, 5),
            )[0]
            for _ in range(2)
        ]  # fmt: skip
        if paths[0] is None:
            continue
        found += 1
        assert paths[1] is not None and np.array_equal(paths[0], paths[1])
        assert np.array_equal(paths[0][0], start) and np.array_equal(paths[0][-1], goal)
        assert all(arrangement.edge_free(a, b) for a, b in pairwise(paths[0]))
        assert arrangement.path_hits(paths[0]) is None
        assert (paths[0][:, 3:] >= robot.lower).all() and (paths[0][:, 3:] <= robot.upper).all()
    assert found >= 3


def test_a_path_without_shortening_has_edges_of_the_reach_at_most(
    world: tuple[Arrangement, Robot], rng: np.random.Generator
) -> None:
    arrangement, robot = world
    start, goal = (np.append(np.zeros(3), arm) for arm in _free_arms(arrangement, robot, rng))
    path, asked = connect_compiled(
        arrangement, _moving(robot), start, goal[None], seed=1, checks=16000,
        deadline=Deadline(60), reach=0.5, domain=4.0,
    )  # fmt: skip
    assert path is not None and asked >= len(path) - 1
    assert np.linalg.norm(np.diff(path, axis=0), axis=1).max() <= 0.5 + 1e-9


def test_one_of_several_goals_is_reached(
    world: tuple[Arrangement, Robot], rng: np.random.Generator
) -> None:
    arrangement, robot = world
    start, *goals = [
        np.append(np.zeros(3), arm) for _ in range(2) for arm in _free_arms(arrangement, robot, rng)
    ]
    path, _ = connect_compiled(
        arrangement, _moving(robot), start, np.array(goals), seed=1, checks=16000,
        deadline=Deadline(60), reach=0.6, domain=4.0,
    )  # fmt: skip
    assert path is not None and any(np.array_equal(path[-1], goal) for goal in goals)


def test_where_there_is_no_way_the_edges_asked_for_are_bounded(
    world: tuple[Arrangement, Robot], rng: np.random.Generator
) -> None:
    arrangement, robot = world
    start, _ = (np.append(np.zeros(3), arm) for arm in _free_arms(arrangement, robot, rng))
    moving = _moving(robot)
    shut = Moving(3, start[3:] - 1e-3, start[3:] + 1e-3, moving.weights)
    goal = start.copy()
    goal[3] += 1.0  # outside of where samples are drawn, so that the trees meet by luck alone
    path, asked = connect_compiled(
        arrangement, shut, start, goal[None], seed=1, checks=300, deadline=Deadline(60),
        reach=1e-4, domain=4.0,
    )  # fmt: skip
    assert path is None and 300 <= asked <= 300 + 10**4


def test_a_deadline_ends_the_search_before_it_begins(
    world: tuple[Arrangement, Robot], rng: np.random.Generator
) -> None:
    arrangement, robot = world
    start, goal = (np.append(np.zeros(3), arm) for arm in _free_arms(arrangement, robot, rng))
    assert connect_compiled(
        arrangement, _moving(robot), start, goal[None], seed=1, checks=300,
        deadline=Deadline(0.0), reach=0.6, domain=4.0,
    ) == (None, 0)  # fmt: skip


def test_both_planners_find_the_arm_s_ways_and_neither_is_much_longer(
    world: tuple[Arrangement, Robot], rng: np.random.Generator
) -> None:
    arrangement, robot = world
    lengths: dict[str, list[float]] = {COMPILED: [], OMPL: []}
    for seed in range(8):
        start, goal = _free_arms(arrangement, robot, rng)
        planned = {
            name: plan_arm(
                arrangement, np.zeros(3), start, goal, robot, np.random.default_rng(seed),
                Deadline(60), effort=3, planner=name,
            )
            for name in lengths
        }  # fmt: skip
        if all(one.path is not None for one in planned.values()):
            for name, one in planned.items():
                assert one.path is not None
                lengths[name].append(length(one.path))
    assert len(lengths[OMPL]) >= 4
    assert np.mean(lengths[COMPILED]) <= 1.3 * np.mean(lengths[OMPL])


def test_the_base_s_way_turns_no_longer_way_round(tmp_path: Path) -> None:
    file = tmp_path / "posts.yaml"
    file.write_text(SCENE.format(robot="panda_mobile"), encoding="utf-8")
    robot, scene = ROBOTS["panda_mobile"](), load_scene(file).scene
    arrangement = Collisions(scene, robot, Kinematics(robot)).arrangement({})
    home = np.array(robot.home)
    trees = 0
    for seed in range(4):
        start, goal = np.array([-0.6, 1.5, 3.0]), np.array([2.2, 1.5 - 0.1 * seed, -3.0])
        planned = plan_base(
            arrangement, home, start, goal, scene.room, np.random.default_rng(seed), Deadline(60),
            effort=3,
        )  # fmt: skip
        assert planned.path is not None
        trees += len(planned.path) > 2
        assert np.abs(np.diff(planned.path[:, 2])).max() <= np.pi + 1e-9
        confs = [np.concatenate([base, home]) for base in planned.path]
        assert all(arrangement.edge_free(a, b) for a, b in pairwise(confs))
    assert trees == 4
