"""The compiled checker against plain FCL, and the guarantees that motions rest on."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from benchmarks.collision import compare
from benchmarks.collision_reference import PlainFcl, random_confs, random_pose, random_scene
from tamp.geometric.collision import arrangement as module
from tamp.geometric.collision.arrangement import TRANSIT_CLEARANCE_M
from tamp.geometric.collision.collisions import Attachment, Collisions
from tamp.geometric.collision.edge_check import check_edge
from tamp.geometric.collision.kernels import UNDECIDED
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Box
from tests.geometric.collision.confs import at
from tests.geometric.making import body, scene


@pytest.mark.parametrize("held", [False, True])
def test_states_and_edges_agree_with_plain_fcl(
    robot: Robot, kinematics: Kinematics, held: bool
) -> None:
    total: Counter[str] = Counter()
    for seed in range(2):
        rng = np.random.default_rng((seed, held))
        scene = random_scene(rng, 5)
        poses = {name: scene.bodies[name].pose for name in scene.movable}
        attachment = (
            Attachment("held", random_pose(rng, np.full(3, -0.02), np.full(3, 0.02)), 0.04)
            if held
            else None
        )
        arrangement = Collisions(scene, robot, kinematics).arrangement(poses, attachment)
        plain = PlainFcl(scene, robot, kinematics, poses, attachment)
        total += compare(arrangement, plain, random_confs(rng, robot, 100), 10, rng)
        total["undecided edges"] += arrangement.stats.edges - arrangement.stats.edges_decided
    assert (
        total["free states"] > 30
        and total["free edges"] > 3
        and total["edges"] > total["free edges"]
    )
    for wrong in (
        "false free states",
        "false hit states",
        "false free edges",
        "false hit edges",
        "undecided edges",
    ):
        assert total[wrong] == 0, wrong


def test_free_means_padding_and_no_more(robot: Robot, kinematics: Kinematics) -> None:
    for gap, expected in ((TRANSIT_CLEARANCE_M - 1e-4, False), (TRANSIT_CLEARANCE_M + 1e-4, True)):
        wall = body("wall", Box((0.1, 2.0, 2.0)), (-0.4 - gap - 0.05, 0.0, 1.02), movable=False)
        conf = at(robot)  # the arm is in front: only the base is near the wall
        arrangement = Collisions(scene(wall), robot, kinematics).arrangement({})
        assert arrangement.free(conf) is expected
        assert arrangement.hits(conf) is None
        if not expected:
            assert arrangement.hits(conf, TRANSIT_CLEARANCE_M) == ("base", "wall")


@pytest.mark.parametrize("thickness", [0.02, 0.001, 1e-5])
def test_no_edge_passes_through_a_thin_plate(
    robot: Robot, kinematics: Kinematics, thickness: float
) -> None:
    plate = body("plate", Box((thickness, 0.02, 0.02)), (1.2, 0.0, 0.2), movable=False)
    arrangement = Collisions(scene(plate), robot, kinematics).arrangement({})
    rng = np.random.default_rng(3)
    for _ in range(50):
        start, end = at(robot, 0.0, rng.uniform(-0.2, 0.2)), at(robot, 2.4, rng.uniform(-0.2, 0.2))
        assert arrangement.free(start) and arrangement.free(end)
        assert not arrangement.edge_free(start, end) and not arrangement.edge_free(end, start)
    assert arrangement.stats.edges == arrangement.stats.edges_decided == 100


def test_a_free_edge_has_free_ends_and_half_the_padding_between(
    robot: Robot, kinematics: Kinematics
) -> None:
    rng = np.random.default_rng(5)
    scene = random_scene(rng, 4)
    poses = {name: scene.bodies[name].pose for name in scene.movable}
    arrangement = Collisions(scene, robot, kinematics).arrangement(poses)
    confs = np.array([conf for conf in random_confs(rng, robot, 400) if arrangement.free(conf)])
    free = [(a, b) for a, b in zip(confs, 0.7 * confs + 0.3 * np.roll(confs, 1, axis=0), strict=True)
            if arrangement.edge_free(a, b)]  # fmt: skip
    assert len(free) > 20
    for start, end in free:
        assert arrangement.free(start) and arrangement.free(end)
        for s in np.linspace(0, 1, 50):
            assert (
                arrangement.hits(start + s * (end - start), TRANSIT_CLEARANCE_M / 2 - 1e-6) is None
            )


def test_floor_and_room(robot: Robot, kinematics: Kinematics) -> None:
    arrangement = Collisions(scene(half=2.0), robot, kinematics).arrangement({})
    low = at(robot)
    low[3:] = [0.0, 1.7, 0.0, -1.2, 0.0, 2.0, 0.8]
    assert not arrangement.free(low)
    hit = arrangement.hits(low)
    assert hit is not None and hit[1] == "floor"
    assert arrangement.free(at(robot, 1.9)) and not arrangement.free(at(robot, 2.01))
    assert arrangement.hits(at(robot, 2.01)) == ("base", "room")
    assert not arrangement.edge_free(at(robot), at(robot, 2.01))


def test_path_hits_names_what_a_motion_meets(robot: Robot, kinematics: Kinematics) -> None:
    post = body("post", Box((0.02, 0.02, 0.5)), (1.5, 0.0, 0.25))
    arrangement = Collisions(scene(post), robot, kinematics).arrangement({"post": post.pose})
    path = np.array([at(robot), at(robot, 0.5), at(robot, 0.9), at(robot, 1.2)])
    assert arrangement.path_hits(path[:2]) is None
    hit = arrangement.path_hits(path)
    assert hit is not None and hit[1] == "post"


def test_the_same_question_has_the_same_answer(robot: Robot, kinematics: Kinematics) -> None:
    rng = np.random.default_rng(11)
    scene = random_scene(rng, 6)
    poses = {name: scene.bodies[name].pose for name in scene.movable}
    first, second = (Collisions(scene, robot, kinematics).arrangement(poses) for _ in range(2))
    confs = random_confs(rng, robot, 200)
    for conf in confs:
        conf.flags.writeable = False
    answers = [first.free(conf) for conf in confs]
    assert (
        answers
        == [second.free(conf) for conf in confs[::-1]][::-1]
        == [first.free(conf.copy()) for conf in confs]
    )
    assert True in answers and False in answers


def undecided_from(metres: float):
    """The kernel, but for edges on which the base goes that far or farther: those stay open."""

    def asked(start: Array, end: Array, padding: float, packed: Array) -> int:
        far = float(np.hypot(*(end - start)[:2])) >= metres
        return UNDECIDED if far else check_edge(start, end, padding, packed)

    return asked


def test_what_the_kernel_leaves_open_is_decided_by_fcl_and_by_halves(
    robot: Robot, kinematics: Kinematics, monkeypatch: pytest.MonkeyPatch
) -> None:
    wall = body("wall", Box((0.1, 2.0, 0.2)), (1.2, 0.0, 0.12), movable=False)
    arrangement = Collisions(scene(wall), robot, kinematics).arrangement({})
    # The base is 0.8 m long: its front is at the low wall, which is at 1.15 m, when it has gone 0.75.
    ends = [at(robot, 0.7, 0.0), at(robot, 0.8, 0.0)]
    for metres in (0.3, 0.0):  # edges only; states too, which FCL decides then
        monkeypatch.setattr(module, "check_edge", undecided_from(metres))
        assert [arrangement.free(conf) for conf in ends] == [True, False]
        assert arrangement.hits(ends[0]) is None
        assert arrangement.hits(ends[1]) == ("base", "wall")
    monkeypatch.setattr(module, "check_edge", undecided_from(0.3))
    assert arrangement.edge_free(at(robot), ends[0])
    assert not arrangement.edge_free(at(robot), ends[1])
    assert arrangement.stats.edges_undecided == 2 and arrangement.stats.edges_decided == 0
    assert (arrangement.stats.states_undecided, arrangement.stats.states_decided > 2) == (2, True)
    assert arrangement.stats.exact > 0


def test_an_edge_that_stays_open_however_short_counts_as_blocked(
    robot: Robot, kinematics: Kinematics, monkeypatch: pytest.MonkeyPatch
) -> None:
    arrangement = Collisions(scene(), robot, kinematics).arrangement({})
    assert arrangement.edge_free(at(robot), at(robot, 0.5))
    monkeypatch.setattr(module, "check_edge", undecided_from(1e-9))
    assert not arrangement.edge_free(at(robot), at(robot, 0.5))


def test_a_configuration_may_be_a_row_of_a_strided_array(
    robot: Robot, kinematics: Kinematics
) -> None:
    arrangement = Collisions(scene(half=2.0), robot, kinematics).arrangement({})
    every_other = np.repeat(at(robot, 2.01), 2)[::2]
    assert arrangement.free(np.repeat(at(robot), 2)[::2])
    assert not arrangement.free(every_other) and not arrangement.edge_free(at(robot), every_other)


def test_fcl_finds_the_floor_for_all_but_what_stands_on_it(
    robot: Robot, kinematics: Kinematics, monkeypatch: pytest.MonkeyPatch
) -> None:
    arrangement = Collisions(scene(), robot, kinematics).arrangement({})
    low = at(robot)
    low[3:] = [0.0, 1.7, 0.0, -1.2, 0.0, 2.0, 0.8]
    monkeypatch.setattr(module, "check_edge", undecided_from(0.0))
    hit = arrangement.hits(low)
    assert hit is not None and hit[1] == "floor" and hit[0] not in (robot.base, robot.foot)
    assert arrangement.hits(at(robot), 0.0205) is None  # the base is 0.02 m above it
