"""The compiled checker against plain FCL, and the guarantees that motions rest on."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import fcl
import numpy as np
import pytest

from benchmarks.collision import compare
from benchmarks.collision_reference import PlainFcl, random_confs, random_pose, random_scene
from tamp.geometric.collision.arrangement import TRANSIT_CLEARANCE_M
from tamp.geometric.collision.collisions import Attachment, Collisions
from tamp.geometric.collision.fcl_bodies import FclBody
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import (
    CONTACT_GAP,
    Body,
    Box,
    Cylinder,
    Part,
    RobotStart,
    Room,
    Scene,
    Sphere,
)


@pytest.fixture(scope="module")
def robot() -> Robot:
    return ROBOTS["panda_mobile"]()


@pytest.fixture(scope="module")
def kinematics(robot: Robot) -> Kinematics:
    return Kinematics(robot)


def body(name: str, shape, x: float, y: float, z: float, movable: bool = True) -> Body:
    return Body(name, (Part(shape),), Pose((x, y, z)), movable)


def scene_of(*bodies: Body, side: float = 3.0) -> Scene:
    room = Room((-side, side), (-side, side))
    return Scene(
        "test", {b.name: b for b in bodies}, RobotStart("panda_mobile", (0.0, 0.0, 0.0)), room
    )


def at(robot: Robot, x: float = 0.0, y: float = 0.0, yaw: float = 0.0) -> np.ndarray:
    return np.array([x, y, yaw, *robot.home])


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
        wall = body("wall", Box((0.1, 2.0, 2.0)), -0.4 - gap - 0.05, 0.0, 1.02, movable=False)
        conf = at(robot)  # the arm is in front: only the base is near the wall
        arrangement = Collisions(scene_of(wall), robot, kinematics).arrangement({})
        assert arrangement.free(conf) is expected
        assert arrangement.hits(conf) is None
        if not expected:
            assert arrangement.hits(conf, TRANSIT_CLEARANCE_M) == ("base", "wall")


@pytest.mark.parametrize("thickness", [0.02, 0.001, 1e-5])
def test_no_edge_passes_through_a_thin_plate(
    robot: Robot, kinematics: Kinematics, thickness: float
) -> None:
    plate = body("plate", Box((thickness, 0.02, 0.02)), 1.2, 0.0, 0.2, movable=False)
    arrangement = Collisions(scene_of(plate), robot, kinematics).arrangement({})
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


def test_the_attached_body_counts_and_leaves_its_place(
    robot: Robot, kinematics: Kinematics
) -> None:
    conf = at(robot)
    T_world_tool = Pose.from_matrix(kinematics.tool(conf))
    cup = replace(body("cup", Cylinder(0.02, 0.1), 0, 0, 0), pose=T_world_tool)
    post = replace(
        body("post", Box((0.03, 0.03, 0.03)), 0, 0, 0), pose=T_world_tool @ Pose((0.0, 0.0, 0.07))
    )
    collisions = Collisions(scene_of(cup, post), robot, kinematics)
    poses = {"cup": cup.pose, "post": post.pose}
    grasp = Attachment("cup", Pose(), 0.04)
    assert collisions.arrangement({}).free(conf)
    assert collisions.arrangement({"post": post.pose}).hits(conf) is None
    assert collisions.arrangement(poses, grasp).hits(conf) is None
    raised = Attachment("cup", Pose((0.0, 0.0, 0.03)), 0.04)
    assert collisions.arrangement(poses, raised).hits(conf) == ("cup", "post")
    assert not collisions.arrangement(poses, raised).free(conf)
    assert (
        collisions.arrangement({}, Attachment("cup", Pose((0.0, 0.0, -0.25)), 0.04)).hits(conf)
        is not None
    )  # link6


def test_fingers_stand_at_half_the_opening(robot: Robot, kinematics: Kinematics) -> None:
    conf = at(robot)
    pea = replace(body("pea", Sphere(0.005), 0, 0, 0), pose=Pose.from_matrix(kinematics.tool(conf)))
    collisions = Collisions(scene_of(pea), robot, kinematics)
    assert collisions.arrangement({"pea": pea.pose}, opening=0.04).free(conf)
    hit = collisions.arrangement({"pea": pea.pose}, opening=0.0).hits(conf)
    assert hit is not None and hit[0].endswith("finger") and hit[1] == "pea"


def test_floor_and_room(robot: Robot, kinematics: Kinematics) -> None:
    arrangement = Collisions(scene_of(side=2.0), robot, kinematics).arrangement({})
    low = at(robot)
    low[3:] = [0.0, 1.7, 0.0, -1.2, 0.0, 2.0, 0.8]
    assert not arrangement.free(low)
    hit = arrangement.hits(low)
    assert hit is not None and hit[1] == "floor"
    assert arrangement.free(at(robot, 1.9)) and not arrangement.free(at(robot, 2.01))
    assert arrangement.hits(at(robot, 2.01)) == ("base", "room")
    assert not arrangement.edge_free(at(robot), at(robot, 2.01))


def test_path_hits_names_what_a_motion_meets(robot: Robot, kinematics: Kinematics) -> None:
    post = body("post", Box((0.02, 0.02, 0.5)), 1.5, 0.0, 0.25)
    arrangement = Collisions(scene_of(post), robot, kinematics).arrangement({"post": post.pose})
    path = np.array([at(robot), at(robot, 0.5), at(robot, 0.9), at(robot, 1.2)])
    assert arrangement.path_hits(path[:2]) is None
    hit = arrangement.path_hits(path)
    assert hit is not None and hit[1] == "post"


def test_bodies_resting_on_each_other_do_not_collide(robot: Robot, kinematics: Kinematics) -> None:
    board = body("board", Box((1.0, 1.0, 0.04)), 0, 0, 0.5, movable=False)
    collisions = Collisions(
        scene_of(
            board, body("a", Box((0.1, 0.1, 0.1)), 0, 0, 1), body("b", Cylinder(0.05, 0.2), 0, 0, 2)
        ),
        robot,
        kinematics,
    )
    resting = Pose((0.0, 0.0, 0.52 + 0.05 + CONTACT_GAP))
    assert collisions.between("a", resting, {}) is None
    assert collisions.between("a", Pose((0.0, 0.0, 0.52 + 0.05 - CONTACT_GAP)), {}) == "board"
    beside = Pose((0.101, 0.0, 0.52 + 0.1 + CONTACT_GAP))
    assert not collisions.pair("a", resting, "b", beside)
    overlapping = Pose((0.099, 0.0, 0.52 + 0.1 + CONTACT_GAP))
    assert collisions.pair("a", resting, "b", overlapping)
    assert collisions.between("a", resting, {"a": resting, "b": overlapping}) == "b"


def test_pairs_agree_with_fcl(robot: Robot, kinematics: Kinematics) -> None:
    rng = np.random.default_rng(7)
    scene = random_scene(rng, 8)
    collisions = Collisions(scene, robot, kinematics)
    names = [name for name in scene.movable if name != "held"]
    found = Counter()
    for _ in range(300):
        a, b = rng.choice(names, 2, replace=False)
        T_a, T_b = (random_pose(rng, np.full(3, -0.15), np.full(3, 0.15)) for _ in range(2))
        objects = [
            [FclBody((part,)).place(0, T.matrix) for part in scene.bodies[name].parts]
            for name, T in ((a, T_a), (b, T_b))
        ]
        expected = any(fcl.collide(p, q) for p in objects[0] for q in objects[1])
        assert collisions.pair(a, T_a, b, T_b) is expected
        found[expected] += 1
    assert found[True] > 30 and found[False] > 30


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
